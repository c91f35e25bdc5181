//! Arguments, as typed.

use crate::cost::Plan;
use crate::film::{MAX_SAMPLE_INDEX, SampleRanges};
use crate::scene::{Estimator, ImageSize, Invalid, MAX_SPP};
use clap::{Args, Parser, Subcommand};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;
use std::str::FromStr;
use std::time::Duration;

/// More threads than this are a typing mistake, and would take the machine down.
const MAX_THREADS: NonZeroUsize = NonZeroUsize::new(1024).unwrap();

/// A headless path tracer for scenes of spheres that states its own error.
///
/// Exit codes: 0 done; 1 a check failed or a target was not reached; 2 the input or the machine
/// does not allow it; 130 interrupted, with what was rendered so far written.
#[derive(Debug, Parser)]
#[command(version, max_term_width = 100)]
pub(super) struct Cli {
    #[command(subcommand)]
    pub command: Command,
}

#[derive(Debug, Subcommand)]
pub(super) enum Command {
    /// Renders a scene to EXR and PNG.
    #[command(allow_negative_numbers = true)]
    Render(RenderArgs),
    /// Checks this machine's device against the f64 reference; exits 1 unless it agrees.
    #[command(allow_negative_numbers = true)]
    Verify(VerifyArgs),
    /// Adds films of the same picture, each of other samples, such as `render --samples` makes.
    #[command(allow_negative_numbers = true)]
    Merge(MergeArgs),
    /// Compares two EXR pictures with their error bars; exits 1 if they differ by more.
    Diff(DiffArgs),
    /// Measures what accuracy costs in time on this device: a table, cost.csv, plots
    /// (cost.svg, cost.png) and a report to read (cost.html).
    #[command(allow_negative_numbers = true)]
    Cost(CostArgs),
    /// Traces one sample of one pixel again, on the device and on the CPU twin, and shows both
    /// paths vertex by vertex; exits 0 whatever it finds.
    #[command(allow_negative_numbers = true)]
    Replay(ReplayArgs),
    /// Shows which effects the scene calls for and why, what is left out of its kernel, and what
    /// that saves on this device; exits 1 if the general kernel makes another film.
    #[command(allow_negative_numbers = true)]
    Explain(ExplainArgs),
    /// Lists what can render here.
    Devices,
}

impl Command {
    pub fn threads(&self) -> Option<NonZeroUsize> {
        match self {
            Self::Render(args) => args.common.threads,
            Self::Verify(args) => args.common.threads,
            Self::Cost(args) => args.common.threads,
            Self::Replay(args) => args.common.threads,
            Self::Explain(args) => args.common.threads,
            Self::Merge(_) | Self::Diff(_) | Self::Devices => None,
        }
    }

    /// Whether no kernel may come out of a driver's cache of earlier runs.
    pub fn compiles_afresh(&self) -> bool {
        matches!(self, Self::Explain(args) if !args.wgsl && !args.spirv)
    }
}

/// What every command on a scene takes.
#[derive(Debug, Args)]
pub(super) struct CommonArgs {
    /// Seed of the random numbers; default: the scene's, or 0.
    #[arg(long, value_name = "S")]
    pub seed: Option<u32>,
    /// Most scatterings of one path; default: the scene's, or 2.
    #[arg(long, value_name = "K")]
    pub bounces: Option<u32>,
    /// Picture size in pixels; default: the scene's.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pub size: Option<ImageSize>,
    /// What renders: auto (a hardware GPU, else software Vulkan, else the CPU twin), gpu
    /// (any adapter), cpu (the f64 twin), or part of an adapter's name.
    #[arg(long, value_name = "WHAT", default_value = "auto")]
    pub device: DeviceChoice,
    /// Threads of the CPU twin and of software Vulkan; default: all cores.
    #[arg(long, value_name = "N", value_parser = parse_threads)]
    pub threads: Option<NonZeroUsize>,
    /// Neither progress nor messages on stderr, errors excepted.
    #[arg(long)]
    pub quiet: bool,
    /// Results on stdout as one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// What every command takes that renders with one estimator.
#[derive(Debug, Default, Args)]
pub(super) struct SamplingArgs {
    /// Samples per pixel; default: the scene's [render] spp, or 256.
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u64).range(1..=MAX_SPP))]
    pub spp: Option<u64>,
    /// Estimator: implicit, cosine, explicit or mis; default: the scene's, or implicit.
    /// `render` also takes auto, which tries all of them first and takes the cheapest.
    #[arg(long, value_name = "E", value_parser = parse_estimator)]
    pub estimator: Option<EstimatorChoice>,
}

/// How files are written.
#[derive(Debug, Args)]
pub(super) struct WriteArgs {
    /// Brightens the PNG by this many stops.
    #[arg(long, value_name = "STOPS", default_value_t = 0.0,
          value_parser = parse_exposure)]
    pub exposure: f64,
    /// Leave the exact sums out of the EXR, and write no checkpoints: a smaller file, which
    /// nothing can be added to.
    #[arg(long)]
    pub no_state: bool,
    /// Replace a film even if it holds other samples, and an EXR of another program.
    #[arg(long)]
    pub force: bool,
}

#[derive(Debug, Args)]
pub(super) struct RenderArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    #[command(flatten)]
    pub common: CommonArgs,
    #[command(flatten)]
    pub sampling: SamplingArgs,
    /// Output file, .exr or .png; may be given more than once. Default: SCENE.exr and
    /// SCENE.png in the current folder.
    #[arg(short, long, value_name = "FILE")]
    pub output: Vec<PathBuf>,
    /// Only the sample indices A..B (half-open, below 2^56) of the picture.
    #[arg(long, value_name = "A..B", value_parser = parse_samples, conflicts_with = "spp")]
    pub samples: Option<Range<u64>>,
    /// Stop after this long, such as 30s or 5m.
    #[arg(long, value_name = "TIME", value_parser = parse_time)]
    pub time: Option<Duration>,
    /// Stop when the picture's relative RMS error is this small with 99 % confidence, such as
    /// 1% or 0.01; --spp and --time are then limits, and exit code 1 says that one came first.
    #[arg(long, value_name = "E", value_parser = parse_target, conflicts_with = "samples")]
    pub target_error: Option<f64>,
    /// Log samples, seconds and error to this CSV file as the render goes.
    #[arg(long, value_name = "FILE")]
    pub log: Option<PathBuf>,
    /// Exit with code 1 if any sample was invalid; the pictures are written all the same.
    #[arg(long)]
    pub strict: bool,
    #[command(flatten)]
    pub write: WriteArgs,
    /// Go on from the EXR named by -o (or SCENE.exr): trace those of the samples that it does not
    /// hold, gaps first. --spp and --time count what is there. Where nothing is there, start.
    #[arg(long, conflicts_with = "no_state")]
    pub resume: bool,
    /// Write the film so far into that EXR this often, such as 60s or 5m.
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = parse_time,
          conflicts_with = "no_state")]
    pub checkpoint_every: Duration,
}

#[derive(Debug, Args)]
pub(super) struct VerifyArgs {
    /// Scene file (TOML); or give --hard.
    #[arg(required_unless_present = "hard")]
    pub scene: Option<PathBuf>,
    /// Check the hard cases in place of a scene: the classic scene with huge walls, far away,
    /// scaled, with a tiny lamp and near mirrors; a table of the bias of each.
    #[arg(long, conflicts_with_all = ["scene", "spp", "size", "bounces", "seed"])]
    pub hard: bool,
    #[command(flatten)]
    pub common: CommonArgs,
    #[command(flatten)]
    pub sampling: SamplingArgs,
}

#[derive(Debug, Args)]
pub(super) struct ReplayArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    #[command(flatten)]
    pub common: CommonArgs,
    /// Estimator: implicit, cosine, explicit or mis; default: the scene's, or implicit.
    #[arg(long, value_name = "E", value_parser = parse_estimator)]
    pub estimator: Option<EstimatorChoice>,
    /// Pixel: its column and row, counted from 0 at the top left.
    #[arg(long, value_name = "X,Y", value_parser = parse_pixel)]
    pub pixel: (u32, u32),
    /// Index of the sample, below 2^56.
    #[arg(long, value_name = "K", value_parser = clap::value_parser!(u64).range(..MAX_SAMPLE_INDEX))]
    pub sample: u64,
}

#[derive(Debug, Args)]
pub(super) struct ExplainArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    #[command(flatten)]
    pub common: CommonArgs,
    /// Estimator: implicit, cosine, explicit or mis; default: the scene's, or implicit.
    #[arg(long, value_name = "E", value_parser = parse_estimator)]
    pub estimator: Option<EstimatorChoice>,
    /// Print the kernel's WGSL and nothing else; takes no device.
    #[arg(long, conflicts_with_all = ["spirv", "json"])]
    pub wgsl: bool,
    /// Write the kernel's SPIR-V, as for Vulkan 1.3, to stdout and nothing else; takes no device.
    #[arg(long, conflicts_with = "json")]
    pub spirv: bool,
}

#[derive(Debug, Args)]
pub(super) struct CostArgs {
    /// Scene file (TOML).
    pub scene: PathBuf,
    #[command(flatten)]
    pub common: CommonArgs,
    /// Time for all measurements, such as 60s or 5m; at least 5s. More time means narrower
    /// intervals and more predictions that are put to the test.
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = parse_budget)]
    pub budget: Plan,
    /// Folder for cost.csv, cost.html, cost.svg and cost.png; default: the current one.
    #[arg(short, long, value_name = "FOLDER", default_value = ".", hide_default_value = true)]
    pub output: PathBuf,
}

#[derive(Debug, Args)]
pub(super) struct MergeArgs {
    /// Films (EXR), in any order; a film may be merged itself.
    #[arg(required = true, value_name = "FILM")]
    pub films: Vec<PathBuf>,
    /// Output file, .exr or .png; may be given more than once, and may be one of the films.
    #[arg(short, long, value_name = "FILE", required = true)]
    pub output: Vec<PathBuf>,
    #[command(flatten)]
    pub write: WriteArgs,
    /// Neither progress nor warnings on stderr.
    #[arg(long)]
    pub quiet: bool,
    /// Results on stdout as one JSON object.
    #[arg(long)]
    pub json: bool,
}

#[derive(Debug, Args)]
#[command(after_help = "Exit codes: 0 they differ by no more than their error bars; \
                         1 by more; 2 no verdict (unreadable files, no error bars, too few hits)")]
pub(super) struct DiffArgs {
    /// Picture (EXR), from candor or another renderer.
    pub a: PathBuf,
    /// Picture that it is compared with, the reference. One without error bars is taken as
    /// exact.
    pub b: PathBuf,
    /// Picture of where they differ, .png. Default: A.diff.png in the current folder.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// No warnings on stderr.
    #[arg(long)]
    pub quiet: bool,
    /// Results on stdout as one JSON object.
    #[arg(long)]
    pub json: bool,
}

/// How paths should be built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EstimatorChoice {
    /// The cheapest for this scene on this device.
    Auto,
    Named(Estimator),
}

/// What should render.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum DeviceChoice {
    Auto,
    Gpu,
    Cpu,
    Named(String),
}

impl FromStr for DeviceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.to_lowercase().as_str() {
            "auto" => Ok(Self::Auto),
            "gpu" => Ok(Self::Gpu),
            "cpu" => Ok(Self::Cpu),
            "" => Err("expected auto, gpu, cpu or part of an adapter's name".to_owned()),
            _ => Ok(Self::Named(text.to_owned())),
        }
    }
}

fn parse_size(text: &str) -> Result<ImageSize, String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) =
        sides.ok_or("expected WIDTHxHEIGHT in pixels, such as 640x480".to_owned())?;
    ImageSize::new(width, height).map_err(|error| format!("each side must be {error}"))
}

fn parse_pixel(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(',').and_then(|(x, y)| Some((x.parse().ok()?, y.parse().ok()?)));
    sides.ok_or("expected COLUMN,ROW in whole numbers, such as 12,34".to_owned())
}

fn parse_samples(text: &str) -> Result<Range<u64>, String> {
    let ends = text.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
    match ends {
        Some(range) if range.start < range.end => {
            // Refused here, before the work: more than a film can hold.
            let fits = SampleRanges::default().insert(range.clone());
            fits.map(|()| range).map_err(|error| error.to_string())
        }
        Some(_) => Err("the range is empty; the end must be larger than the start".to_owned()),
        None => Err("expected A..B with whole numbers, such as 0..256".to_owned()),
    }
}

fn parse_estimator(text: &str) -> Result<EstimatorChoice, String> {
    if text == "auto" {
        return Ok(EstimatorChoice::Auto);
    }
    let named = text.parse().map(EstimatorChoice::Named);
    named.map_err(|allowed: Invalid| format!("expected {allowed}, or \"auto\""))
}

fn parse_threads(text: &str) -> Result<NonZeroUsize, String> {
    match text.parse() {
        Ok(threads) if threads <= MAX_THREADS => Ok(threads),
        _ => Err(format!("expected a whole number from 1 to {MAX_THREADS}")),
    }
}

fn parse_time(text: &str) -> Result<Duration, String> {
    match humantime::parse_duration(text) {
        Ok(time) if !time.is_zero() => Ok(time),
        Ok(_) => Err("expected a time longer than zero".to_owned()),
        Err(_) => Err("expected a time with its unit, such as 30s, 5m or 1h 30m".to_owned()),
    }
}

/// A fraction, or a percentage with its sign. More than the picture's whole mean is no error to
/// aim at, and a bare 5 would be one.
fn parse_target(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 100.0));
    match number.trim().parse::<f64>().map(|number| number / unit) {
        Ok(error) if error > 0.0 && error <= 1.0 => Ok(error),
        _ => {
            Err("expected a percentage such as 1%, or a fraction above 0 and up to 1 such as 0.01"
                .to_owned())
        }
    }
}

fn parse_budget(text: &str) -> Result<Plan, String> {
    Plan::new(parse_time(text)?).map_err(|allowed| format!("expected {allowed}"))
}

fn parse_exposure(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(stops) if stops.abs() <= 100.0 => Ok(stops),
        _ => Err("expected a number of stops from -100 to 100".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::{Cli, parse_samples, parse_size, parse_target, parse_time};
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn sizes() {
        let size = parse_size("640x480").expect("a size");
        assert_eq!((size.width(), size.height()), (640, 480));
        for bad in ["640", "640x", "x480", "0x480", "640x65536", "-1x5", "6 x 5", "1x2x3"] {
            assert!(parse_size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sample_ranges() {
        assert_eq!(parse_samples("3..17"), Ok(3..17));
        for bad in ["3", "..17", "3..", "5..5", "7..5", "a..b", "-1..5", "3..=5", "0..4294967297"] {
            assert!(parse_samples(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn times() {
        assert_eq!(parse_time("90s").map(|t| t.as_secs()), Ok(90));
        for bad in ["30", "0s", "s", "-3s", "soon"] {
            assert!(parse_time(bad).is_err(), "{bad}");
        }
    }
    #[test]
    fn targets() {
        for (text, error) in [("1%", 0.01), ("0.5 %", 0.005), ("0.01", 0.01), ("1", 1.0)] {
            assert_eq!(parse_target(text), Ok(error), "{text}");
        }
        for bad in ["5", "0", "0%", "101%", "-1%", "nan", "NaN%", "inf%", "%", "", "1 percent"] {
            assert!(parse_target(bad).is_err(), "{bad}");
        }
    }
}
