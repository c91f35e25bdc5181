//! Relative RMS error against seconds: what the halves realised, what is predicted, and what
//! the race measured.

use super::{Axis, Chart, Failure, INK, Pen, colour};
use crate::cost::{EstimatorCost, Study, TARGETS};
use crate::scene::Estimator;
use crate::units::{rounded_percent, significant};
use plotters::coord::{CoordTranslate, Shift};
use plotters::prelude::{
    Circle, Color, DashedLineSeries, DrawingArea, DrawingBackend, EmptyElement, LineSeries,
    PathElement, Polygon, Rectangle, Text, TriangleMarker,
};

/// The slowest line is shown down to this error.
const SHOWN: f64 = 0.01;

pub(super) fn draw<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    study: &Study,
    pen: Pen,
) -> Result<(), Failure<DB>> {
    let curves: Vec<Curve> = study.estimators.iter().filter_map(|c| Curve::of(c, study)).collect();
    let Some((x, y)) = axes(&curves) else {
        let place = (pen.offset(30), pen.offset(40));
        let text = if study.cheapest().is_some_and(EstimatorCost::is_noiseless) {
            "no noise: all samples of a pixel are alike"
        } else {
            "unproven: too few samples met light for any error"
        };
        return area.draw(&Text::new(text, place, pen.text(18)));
    };
    let mut chart = pen.chart(area, "What the next digit costs", [&x, &y])?;
    for curve in &curves {
        curve.draw_lines(&mut chart, [&x, &y], pen)?;
    }
    for curve in &curves {
        curve.draw_points(&mut chart, [&x, &y], pen)?;
    }
    legend(&chart.plotting_area().strip_coord_spec(), &curves, pen)
}

/// One estimator's curve in decimal logarithms.
struct Curve<'a> {
    cost: &'a EstimatorCost,
    /// Seconds for one sample of every pixel.
    frame: f64,
    /// Logarithm of error² × seconds.
    price: f64,
    /// Logarithm of the seconds of the pilot.
    measured: f64,
}

impl<'a> Curve<'a> {
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    fn of(cost: &'a EstimatorCost, study: &Study) -> Option<Self> {
        let pixels = f64::from(study.width) * f64::from(study.height);
        let price = cost.price().filter(|price| *price > 0.0)? * pixels;
        let frame = cost.seconds_per_sample.value * pixels;
        let measured = (frame * cost.samples as f64).log10();
        Some(Self { cost, frame, price: price.log10(), measured })
    }

    /// The predicted error after 10^x seconds, and its inverse.
    fn error(&self, x: f64) -> f64 {
        (self.price - x) / 2.0
    }

    fn seconds(&self, y: f64) -> f64 {
        self.price - 2.0 * y
    }

    /// Where the first realised error is.
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    fn start(&self) -> f64 {
        let first = self.cost.convergence.first().map_or(2, |point| point.samples);
        (first as f64 * self.frame).log10()
    }

    fn draw_lines<DB: DrawingBackend>(
        &self,
        chart: &mut Chart<DB>,
        [x, y]: [&Axis; 2],
        pen: Pen,
    ) -> Result<(), Failure<DB>> {
        let style = colour(self.cost.estimator).stroke_width(pen.length(2));
        let from = self.start().max(self.seconds(y.ends.1)).max(x.ends.0);
        let to = x.ends.1.min(self.seconds(y.ends.0));
        let middle = self.measured.clamp(from, to.max(from));
        let line = [from, middle].map(|x| (x, self.error(x)));
        chart.draw_series(LineSeries::new(line, style))?;
        let steps: Vec<_> = (0..=100)
            .map(|step| middle + (to - middle) * f64::from(step) / 100.0)
            .map(|x| (x, self.error(x)))
            .collect();
        let dash = pen.length(6);
        chart.draw_series(DashedLineSeries::new(steps, dash, dash, style))?;
        Ok(())
    }

    #[expect(clippy::cast_precision_loss, reason = "counts of samples")]
    fn draw_points<DB: DrawingBackend>(
        &self,
        chart: &mut Chart<DB>,
        [x, y]: [&Axis; 2],
        pen: Pen,
    ) -> Result<(), Failure<DB>> {
        let colour = colour(self.cost.estimator);
        for point in &self.cost.convergence {
            let at = ((point.samples as f64 * self.frame).log10(), point.error.log10());
            if !x.holds(at.0) || !y.holds(at.1) {
                continue;
            }
            let bar = point.interval();
            let bar = [bar.low, bar.high].map(|end| (at.0, end.log10().clamp(y.ends.0, y.ends.1)));
            let thin = colour.stroke_width(pen.scale);
            chart.draw_series([PathElement::new(bar.to_vec(), thin)])?;
            mark(chart.plotting_area(), at, self.cost.estimator, pen)?;
        }
        let ring = colour.stroke_width(pen.length(2));
        for prediction in &self.cost.predictions {
            let Some(seconds) = prediction.measured else { continue };
            let at = (seconds.log10(), prediction.target.log10());
            if x.holds(at.0) && y.holds(at.1) {
                chart.draw_series([Circle::new(at, pen.length(8), ring)])?;
            }
        }
        Ok(())
    }
}

/// An estimator's mark, in its colour and shape.
fn mark<DB: DrawingBackend, CT: CoordTranslate>(
    area: &DrawingArea<DB, CT>,
    at: CT::From,
    estimator: Estimator,
    pen: Pen,
) -> Result<(), Failure<DB>>
where
    CT::From: Clone,
{
    let (fill, size) = (colour(estimator).filled(), pen.length(4));
    let at = EmptyElement::at(at);
    match estimator {
        Estimator::Implicit => area.draw(&(at + Circle::new((0, 0), size, fill))),
        Estimator::Cosine => area.draw(&(at + TriangleMarker::new((0, 0), size + pen.scale, fill))),
        Estimator::Explicit => area.draw(&(at + Rectangle::new(square(pen), fill))),
        Estimator::Mis => area.draw(&(at + Polygon::new(diamond(pen), fill))),
    }
}

/// What the colours and marks mean, in the lower left corner, where no line comes.
fn legend<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    curves: &[Curve],
    pen: Pen,
) -> Result<(), Failure<DB>> {
    let bottom = area.dim_in_pixel().1.cast_signed();
    let step = pen.offset(23);
    let (left, text) = (pen.offset(30), pen.offset(52));
    let mut y = bottom - step;
    let label = |y: i32, words: &'static str| {
        area.draw(&Text::new(words, (text, y - pen.offset(9 - pen.drop)), pen.text(17)))
    };
    if curves.iter().flat_map(|curve| &curve.cost.predictions).any(|p| p.measured.is_some()) {
        let ring = INK.stroke_width(pen.length(2));
        area.draw(&Circle::new((left, y), pen.length(8), ring))?;
        label(y, "measured in the race")?;
        y -= step;
    }
    for curve in curves.iter().rev() {
        let line = [-14, 14].map(|offset| (left + pen.offset(offset), y)).to_vec();
        let estimator = curve.cost.estimator;
        area.draw(&PathElement::new(line, colour(estimator).stroke_width(pen.length(2))))?;
        mark(area, (left, y), estimator, pen)?;
        label(y, estimator.name())?;
        y -= step;
    }
    Ok(())
}

fn square(pen: Pen) -> [(i32, i32); 2] {
    [-4, 4].map(|offset| (pen.offset(offset), pen.offset(offset)))
}

fn diamond(pen: Pen) -> Vec<(i32, i32)> {
    [(0, -6), (6, 0), (0, 6), (-6, 0)].map(|(x, y)| (pen.offset(x), pen.offset(y))).to_vec()
}

/// Axes that hold the realised errors, the smallest target of the cheapest estimator, and an
/// error of 1 % for the dearest.
fn axes(curves: &[Curve]) -> Option<(Axis, Axis)> {
    let smallest = TARGETS.into_iter().fold(f64::INFINITY, f64::min).log10();
    let cheapest = curves.iter().map(|curve| curve.seconds(smallest)).reduce(f64::min)?;
    let dearest = curves.iter().map(|curve| curve.seconds(SHOWN.log10())).reduce(f64::max)?;
    let first = curves.iter().map(Curve::start).reduce(f64::min)?;
    let largest = curves
        .iter()
        .map(|curve| curve.cost.convergence.first().map_or(-1.0, |point| point.error.log10()))
        .fold(-1.0, f64::max);
    let seconds = (first - 0.15, cheapest.max(dearest).max(first + 1.0) + 0.15);
    let errors = (smallest - 0.12, largest.max(smallest + 1.0) + 0.12);
    let x = Axis::of_logs("seconds of tracing", seconds, false, seconds_label);
    let y =
        Axis::of_logs("relative RMS error", errors, true, |y| rounded_percent(10_f64.powf(y), 1));
    Some((x, y))
}

/// A power of ten of seconds in the unit that people use.
fn seconds_label(x: f64) -> String {
    let seconds = 10_f64.powf(x);
    match seconds {
        s if s < 0.005 => format!("{} ms", significant(1e3 * s, 1)),
        s if s < 5e3 => format!("{} s", significant(s, 1)),
        s if s < 2e5 => format!("{} h", significant(s / 3600.0, 2)),
        s if s < 3e7 => format!("{} d", significant(s / 86_400.0, 2)),
        s => format!("{} y", significant(s / 31_557_600.0, 2)),
    }
}
