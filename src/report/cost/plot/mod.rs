//! The plots of a study, as SVG and as pixels: error against time, and the bounce ladder.

mod convergence;
mod ladder;

use super::MARK;
use crate::cost::Study;
use crate::scene::Estimator;
use plotters::backend::{RGBPixel, SVGBackend};
use plotters::chart::{ChartBuilder, ChartContext};
use plotters::coord::Shift;
use plotters::coord::ranged1d::{KeyPointHint, NoDefaultFormatting, Ranged, ValueFormatter};
use plotters::prelude::{
    BitMapBackend, Cartesian2d, Color, DrawingArea, DrawingAreaErrorKind, DrawingBackend,
    FontStyle, IntoDrawingArea, IntoFont, RGBColor, TextStyle,
};
use plotters::style::register_font;
use std::ops::Range;
use std::sync::OnceLock;

/// Size of the SVG in its own units.
const SIZE: (u32, u32) = (1200, 540);

/// Size of the PNG in pixels: two for each of the SVG's units.
pub(super) const SIZE_PNG: (u32, u32) = (2 * SIZE.0, 2 * SIZE.1);

/// The PNG is drawn so many times larger and averaged, which smooths its edges.
const OVERSAMPLING: u32 = 2;

/// In pixels, plotters sets text this much too high, in the SVG's units.
const DROP: i32 = 3;

/// Width of the convergence plot where the ladder stands beside it.
const SPLIT: u32 = 730;

const INK: RGBColor = RGBColor(0x24, 0x29, 0x2f);
const FAINT: RGBColor = RGBColor(0xd8, 0xde, 0xe4);
const PAPER: RGBColor = RGBColor(0xff, 0xff, 0xff);

/// The family that browsers and the embedded font share.
const FAMILY: &str = "sans-serif";

/// Why nothing could be drawn.
type Failure<DB> = DrawingAreaErrorKind<<DB as DrawingBackend>::ErrorType>;

/// A chart whose axes have ticks at places of our choice.
type Chart<'a, DB> = ChartContext<'a, DB, Cartesian2d<Axis, Axis>>;

/// Draws into an SVG file's text.
pub(super) fn svg(study: &Study) -> Result<String, String> {
    load_font()?;
    let mut text = String::new();
    {
        let root = SVGBackend::with_string(&mut text, SIZE).into_drawing_area();
        draw(&root, study, Pen { scale: 1, drop: 0 }).map_err(|error| error.to_string())?;
    }
    // What the file is, for those who find it later, and for the check before replacing it.
    let described = format!("<desc>{MARK} {}</desc>\n", env!("CARGO_PKG_VERSION"));
    let start = text.find(">\n").ok_or("the SVG has no first line")? + 2;
    text.insert_str(start, &described);
    Ok(text)
}

/// Draws into [`SIZE_PNG`] pixels of eight-bit RGB.
pub(super) fn pixels(study: &Study) -> Result<Vec<u8>, String> {
    load_font()?;
    let (width, height) = (SIZE_PNG.0 * OVERSAMPLING, SIZE_PNG.1 * OVERSAMPLING);
    let mut large = vec![0; 3 * width as usize * height as usize];
    {
        let backend =
            BitMapBackend::<RGBPixel>::with_buffer_and_format(&mut large, (width, height))
                .map_err(|error| error.to_string())?;
        let pen = Pen { scale: SIZE_PNG.0 / SIZE.0 * OVERSAMPLING, drop: DROP };
        draw(&backend.into_drawing_area(), study, pen).map_err(|error| error.to_string())?;
    }
    let large = image::RgbImage::from_raw(width, height, large)
        .ok_or("the drawing has another size than its buffer")?;
    Ok(image::imageops::thumbnail(&large, SIZE_PNG.0, SIZE_PNG.1).into_raw())
}

/// A font that is always there, also on servers that have none.
fn load_font() -> Result<(), String> {
    static LOADED: OnceLock<bool> = OnceLock::new();
    let load =
        || register_font(FAMILY, FontStyle::Normal, epaint_default_fonts::UBUNTU_LIGHT).is_ok();
    if *LOADED.get_or_init(load) { Ok(()) } else { Err("the font cannot be read".to_owned()) }
}

fn draw<DB: DrawingBackend>(
    root: &DrawingArea<DB, Shift>,
    study: &Study,
    pen: Pen,
) -> Result<(), Failure<DB>> {
    root.fill(&PAPER)?;
    if study.ladder.iter().any(|rung| rung.missing.is_some_and(|missing| missing.low > 0.0)) {
        let (left, right) = root.split_horizontally(pen.length(SPLIT));
        convergence::draw(&left, study, pen)?;
        ladder::draw(&right, study, pen)?;
    } else {
        convergence::draw(root, study, pen)?;
    }
    root.present()
}

/// Lengths and texts at the drawing's scale.
#[derive(Debug, Clone, Copy)]
struct Pen {
    scale: u32,
    /// How much lower text must be set to stand where it should.
    drop: i32,
}

impl Pen {
    fn length(self, length: u32) -> u32 {
        length * self.scale
    }

    fn offset(self, offset: i32) -> i32 {
        offset * self.scale.cast_signed()
    }

    fn text(self, size: u32) -> TextStyle<'static> {
        (FAMILY, self.length(size)).into_font().color(&INK)
    }

    /// A chart with a title and axes.
    fn chart<'a, DB: DrawingBackend>(
        self,
        area: &'a DrawingArea<DB, Shift>,
        title: &str,
        [x, y]: [&Axis; 2],
    ) -> Result<Chart<'a, DB>, Failure<DB>> {
        let mut chart = ChartBuilder::on(area)
            .margin(self.length(14))
            .margin_right(self.length(26))
            .caption(title, self.text(21))
            .x_label_area_size(self.length(52))
            .y_label_area_size(self.length(66))
            .build_cartesian_2d(x.clone(), y.clone())?;
        chart
            .configure_mesh()
            .bold_line_style(FAINT.stroke_width(self.scale))
            .light_line_style(PAPER.mix(0.0))
            .axis_style(INK.stroke_width(self.scale))
            .label_style(self.text(16))
            .axis_desc_style(self.text(17))
            .y_label_offset(self.offset(self.drop))
            .set_all_tick_mark_size(self.length(5))
            .x_desc(x.name.as_str())
            .y_desc(y.name.as_str())
            .draw()?;
        Ok(chart)
    }
}

/// One axis: its ends, its ticks and what they are called.
#[derive(Debug, Clone)]
struct Axis {
    name: String,
    ends: (f64, f64),
    ticks: Vec<f64>,
    label: fn(f64) -> String,
}

impl Axis {
    /// An axis of decimal logarithms with ticks at 1 and perhaps 3 times the powers of ten.
    fn of_logs(name: &str, ends: (f64, f64), with_threes: bool, label: fn(f64) -> String) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "decimal exponents")]
        let decades = ends.0.floor() as i32..=ends.1.ceil() as i32;
        let steps: &[f64] = if with_threes { &[1.0, 3.0] } else { &[1.0] };
        let ticks = decades
            .flat_map(|decade| steps.iter().map(move |step| f64::from(decade) + step.log10()))
            .filter(|tick| (ends.0..=ends.1).contains(tick))
            .collect();
        Self { name: name.to_owned(), ends, ticks, label }
    }

    fn holds(&self, at: f64) -> bool {
        (self.ends.0..=self.ends.1).contains(&at)
    }
}

impl Ranged for Axis {
    type FormatOption = NoDefaultFormatting;
    type ValueType = f64;

    #[expect(clippy::cast_possible_truncation, reason = "a place in pixels")]
    fn map(&self, value: &f64, (start, end): (i32, i32)) -> i32 {
        let share = (value - self.ends.0) / (self.ends.1 - self.ends.0);
        start + (share * f64::from(end - start)).round() as i32
    }

    fn key_points<Hint: KeyPointHint>(&self, hint: Hint) -> Vec<f64> {
        if hint.weight().allow_light_points() { Vec::new() } else { self.ticks.clone() }
    }

    fn range(&self) -> Range<f64> {
        self.ends.0..self.ends.1
    }
}

impl ValueFormatter<f64> for Axis {
    fn format_ext(&self, value: &f64) -> String {
        (self.label)(*value)
    }
}

/// Colours of Okabe and Ito (2008), which people with any colour vision tell apart.
fn colour(estimator: Estimator) -> RGBColor {
    match estimator {
        Estimator::Implicit => RGBColor(0xd5, 0x5e, 0x00),
        Estimator::Cosine => RGBColor(0xe6, 0x9f, 0x00),
        Estimator::Explicit => RGBColor(0x00, 0x72, 0xb2),
        Estimator::Mis => RGBColor(0x00, 0x9e, 0x73),
    }
}
