//! `candor diff`: do two pictures differ by more than their error bars, and where?

use super::args::DiffArgs;
use super::{DONE, FAILED, REFUSED, Refusal, memory, refuse, streams};
use crate::estimate::{
    Comparison, Difference, MapUnit, Measured, RELATIVE_MSE_EPSILON, compare_pictures, difference,
    difference_map,
};
use crate::report::{self, FULL_COLOUR, PictureHeader, StoredPicture};
use crate::scene::ImageSize;
use serde::Serialize;
use std::borrow::Cow;
use std::path::{Path, PathBuf};

/// Family-wise probability of a false alarm: a person who compares pictures by hand meets one
/// in a thousand comparisons. The image's mean must be 3.6 standard errors off to differ.
const ALPHA: f64 = 1e-3;

pub(super) fn run(args: &DiffArgs) -> Result<u8, Refusal> {
    let output = output(args)?;
    let (a, b) = (PictureHeader::read(&args.a)?, PictureHeader::read(&args.b)?);
    if a.size != b.size {
        return refuse(format_args!(
            "{} has {} pixels, {} has {}; only pictures of one size can be compared",
            args.a.display(),
            a.size,
            args.b.display(),
            b.size
        ));
    }
    memory::check_comparison(a.size)?;
    let (a, b) = (a.read_pixels()?, b.read_pixels()?);
    let findings = Findings::of(&a, &b);
    if !args.quiet {
        findings.warnings.iter().for_each(|text| streams::message(&format!("warning: {text}")));
    }
    let map = difference_map(&a.measured(), &b.measured());
    report::write_difference(&output, &map)?;
    let report = if args.json {
        findings.json(args, &output)
    } else {
        let legend = legend(&output, map.unit, map.block);
        [describe("a", &a), describe("b", &b), findings.lines(), legend, findings.verdict_line()]
            .join("\n")
    };
    streams::results(&report)?;
    Ok(findings.verdict.code())
}

/// Where the picture of the differences goes.
fn output(args: &DiffArgs) -> Result<PathBuf, Refusal> {
    let path = args.output.clone().unwrap_or_else(|| {
        let mut name = args.a.file_stem().unwrap_or_default().to_owned();
        name.push(".diff.png");
        PathBuf::from(name)
    });
    if !path.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("png")) {
        return refuse(format_args!("{}: the ending must be .png", path.display()));
    }
    report::check_writable(&path)?;
    Ok(path)
}

/// What can be said of two pictures.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "kebab-case")]
enum Verdict {
    Identical,
    WithinErrorBars,
    Differ,
    TooFewHits,
    NoErrorBars,
}

impl Verdict {
    fn of(a: &StoredPicture, b: &StoredPicture, comparison: Option<&Comparison>) -> Self {
        match comparison {
            _ if a.rgb == b.rgb => Self::Identical,
            None => Self::NoErrorBars,
            Some(found) if !found.conclusive => Self::TooFewHits,
            Some(found) if found.disagrees(ALPHA) => Self::Differ,
            Some(_) => Self::WithinErrorBars,
        }
    }

    fn code(self) -> u8 {
        match self {
            Self::Identical | Self::WithinErrorBars => DONE,
            Self::Differ => FAILED,
            Self::TooFewHits | Self::NoErrorBars => REFUSED,
        }
    }
}

/// All that is said.
struct Findings {
    size: ImageSize,
    difference: Difference,
    /// `None` where neither picture has error bars.
    comparison: Option<Comparison>,
    /// Pixels of each whose error is unproven; `None` where it has no bars.
    unproven: [Option<usize>; 2],
    /// Whether both were traced from the same random numbers, at least in part.
    shares_samples: bool,
    warnings: Vec<String>,
    verdict: Verdict,
}

impl Findings {
    fn of(a: &StoredPicture, b: &StoredPicture) -> Self {
        let (ours, theirs) = (a.measured(), b.measured());
        let has_bars = ours.bars.is_some() || theirs.bars.is_some();
        let comparison = has_bars.then(|| compare_pictures(&ours, &theirs));
        let verdict = Verdict::of(a, b, comparison.as_ref());
        let unproven = |side: Measured<'_>| side.bars.map(|bars| bars.unproven_pixels());
        let mut warnings = unlike(&a.header, &b.header);
        let shared = shared_samples(&a.header, &b.header);
        let shares_samples = shared.is_some();
        if verdict != Verdict::Identical {
            warnings.extend(shared);
        }
        Self {
            size: ours.size,
            difference: difference(&ours, &theirs),
            comparison,
            unproven: [unproven(ours), unproven(theirs)],
            shares_samples,
            warnings,
            verdict,
        }
    }

    fn lines(&self) -> String {
        let found = &self.difference;
        let [a, b] = found.luminance;
        let share = |x: f64| if b > 0.0 { percent(x / b) } else { "-".to_owned() };
        let mut lines = vec![
            format!("mean      a {a:.6}, b {b:.6}; a - b is {} of b", relative(a, b)),
            format!("rmse      {:.3e} in luminance, {} of b's mean", found.rmse, share(found.rmse)),
        ];
        if let Some(expected) = found.expected_rmse {
            let share = share(expected);
            lines.push(format!("          {expected:.3e} expected from the error bars, {share}"));
        }
        lines.push(format!("          {:.3e} over r, g and b", found.channel_rmse));
        lines.push(match found.relative_mse {
            Some(mse) => format!(
                "rel. mse  {mse:.3e}, mean of (a - b)²/(b² + ε), ε = {RELATIVE_MSE_EPSILON} of b's \
                 squared mean"
            ),
            None => "rel. mse  none, b has no light".to_owned(),
        });
        if let Some(found) = &self.comparison {
            lines.push(format!("image     z {:+.2}, p {}", found.image.z, p_text(found.image.p)));
            lines.push(format!(
                "tiles     largest z {:+.2}, p {} as the largest of {}",
                found.worst.z,
                p_text(found.worst_tile_p()),
                found.tiles
            ));
            let p = p_text(found.all_tiles_p());
            lines.push(format!("          rms z {:.3}, p {p} of all together", found.rms_z));
            lines.push(format!("unproven  {}", self.unproven_line()));
        }
        lines.join("\n")
    }

    fn unproven_line(&self) -> String {
        let pixels = self.size.pixels();
        let side = |name: &str, count: Option<usize>| {
            count.map(|count| format!("{count} of {pixels} pixels in {name}"))
        };
        let [a, b] = self.unproven;
        let sides: Vec<String> = side("a", a).into_iter().chain(side("b", b)).collect();
        sides.join(", ")
    }

    fn verdict_line(&self) -> String {
        let p = p_text(self.comparison.as_ref().map_or(1.0, Comparison::p));
        let text = match self.verdict {
            Verdict::Identical => "identical: every r, g and b is the same".to_owned(),
            Verdict::Differ => {
                format!("THEY DIFFER by more than their error bars (p {p}; the limit is {ALPHA:e})")
            }
            Verdict::WithinErrorBars if self.shares_samples => {
                "they differ by no more than their error bars, which says little where samples are \
                 shared"
                    .to_owned()
            }
            Verdict::WithinErrorBars => {
                format!(
                    "they differ by no more than their error bars (p {p}; the limit is {ALPHA:e})"
                )
            }
            Verdict::TooFewHits => "none: too few hits to tell; render more --spp".to_owned(),
            Verdict::NoErrorBars => "none: neither picture has error bars".to_owned(),
        };
        format!("verdict   {text}")
    }

    fn json(&self, args: &DiffArgs, output: &Path) -> String {
        let found = self.comparison.as_ref();
        let json = Json {
            a: args.a.to_string_lossy(),
            b: args.b.to_string_lossy(),
            width: self.size.width(),
            height: self.size.height(),
            verdict: self.verdict,
            alpha: ALPHA,
            p: found.map(Comparison::p),
            luminance: self.difference.luminance,
            rmse: self.difference.rmse,
            expected_rmse: self.difference.expected_rmse,
            channel_rmse: self.difference.channel_rmse,
            relative_mse: self.difference.relative_mse,
            image_z: found.map(|found| found.image.z),
            image_p: found.map(|found| found.image.p),
            tiles: found.map(|found| found.tiles),
            worst_tile_z: found.map(|found| found.worst.z),
            worst_tile_p: found.map(Comparison::worst_tile_p),
            rms_tile_z: found.map(|found| found.rms_z),
            all_tiles_p: found.map(Comparison::all_tiles_p),
            unproven_pixels: self.unproven,
            shares_samples: self.shares_samples,
            warnings: &self.warnings,
            outputs: [output.to_string_lossy()],
        };
        serde_json::to_string(&json).expect("plain values serialize")
    }
}

/// Where the two headers say that other pictures are compared than the user may think, or
/// pictures that their error bars do not cover.
fn unlike(a: &PictureHeader, b: &PictureHeader) -> Vec<String> {
    let mut warnings = Vec::new();
    if let (Some(ours), Some(theirs)) = (&a.scene_hash, &b.scene_hash)
        && ours != theirs
    {
        warnings.push("the pictures are of different scenes".to_owned());
    }
    if let (Some(ours), Some(theirs)) = (&a.bounces, &b.bounces)
        && ours != theirs
    {
        warnings.push(format!("the pictures are of {ours} and {theirs} bounces"));
    }
    for header in [a, b] {
        if let Some(count) = header.invalid_samples.filter(|&count| count > 0) {
            let path = header.path().display();
            warnings.push(format!(
                "{path} has {count} invalid samples, which count as zeros: its error bars say \
                 nothing of what they would have brought"
            ));
        }
    }
    for header in [a, b].into_iter().filter(|header| header.other_primaries) {
        let path = header.path().display();
        warnings.push(format!("{path} has other primaries; its values are taken as Rec. 709"));
    }
    warnings
}

/// That two pictures have random numbers in common, which the tests do not allow for.
fn shared_samples(a: &PictureHeader, b: &PictureHeader) -> Option<String> {
    let (ours, theirs) = (a.samples.as_ref()?, b.samples.as_ref()?);
    let seed = a.seed.filter(|seed| b.seed == Some(*seed))?;
    let shared = ours.shared(theirs)?;
    Some(format!(
        "both pictures hold samples {}..{} of seed {seed}: their errors are alike, and \
         equal pictures look more equal than they are; render one with another --seed",
        shared.start, shared.end
    ))
}

fn describe(name: &str, picture: &StoredPicture) -> String {
    let header = &picture.header;
    let path = header.path().display();
    let Some(samples) = &header.samples else {
        let half = if header.half { "; in half floats" } else { "" };
        let meaning = "no error bars; taken as exact, so that its noise counts as difference";
        return format!("{name}         {path}: {meaning}{half}");
    };
    let mut facts = vec![format!("{} spp", samples.count())];
    facts.extend(header.seed.map(|seed| format!("seed {seed}")));
    facts.extend([&header.estimator, &header.device].into_iter().flatten().cloned());
    format!("{name}         {path}: {}", facts.join(", "))
}

/// What the colours of the picture mean.
fn legend(output: &Path, unit: MapUnit, block: usize) -> String {
    let full = match unit {
        MapUnit::StandardErrors => format!("{FULL_COLOUR} standard errors"),
        MapUnit::Tenths => format!("{} % of b", 10 * FULL_COLOUR),
    };
    let place = if block == 1 { String::new() } else { format!(", of {block}x{block} pixels") };
    let path = output.display();
    format!(
        "wrote     {path}: red where a is brighter, blue where darker, grey where \
         unproven; full colour at {full}{place}"
    )
}

/// A p-value as people read it; far out in the tail its size means nothing.
fn p_text(p: f64) -> String {
    match p {
        p if p >= 1e-3 => format!("{p:.3}"),
        p if p >= 1e-99 => format!("{p:.1e}"),
        _ => "below 1e-99".to_owned(),
    }
}

fn percent(share: f64) -> String {
    format!("{:.2} %", 100.0 * share)
}

/// (a - b)/b, where b has light.
fn relative(a: f64, b: f64) -> String {
    if b > 0.0 { format!("{:+.3} %", 100.0 * (a / b - 1.0)) } else { "-".to_owned() }
}

/// The `--json` object; pairs are of a and b.
#[derive(Serialize)]
struct Json<'a> {
    a: Cow<'a, str>,
    b: Cow<'a, str>,
    width: u32,
    height: u32,
    verdict: Verdict,
    alpha: f64,
    p: Option<f64>,
    luminance: [f64; 2],
    rmse: f64,
    expected_rmse: Option<f64>,
    channel_rmse: f64,
    relative_mse: Option<f64>,
    image_z: Option<f64>,
    image_p: Option<f64>,
    tiles: Option<usize>,
    worst_tile_z: Option<f64>,
    worst_tile_p: Option<f64>,
    rms_tile_z: Option<f64>,
    all_tiles_p: Option<f64>,
    unproven_pixels: [Option<usize>; 2],
    shares_samples: bool,
    warnings: &'a [String],
    outputs: [Cow<'a, str>; 1],
}
