//! Arguments, as typed.

use super::values;
pub(super) use super::values::{DeviceChoice, EstimatorChoice};
use crate::cost::Plan;
use crate::film::MAX_SAMPLE_INDEX;
use crate::scene::{ImageSize, MAX_SPP};
use clap::{Args, Parser, Subcommand};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::PathBuf;
use std::time::Duration;

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
    #[arg(long, value_name = "WxH", value_parser = values::size)]
    pub size: Option<ImageSize>,
    /// What renders: auto (a hardware GPU, else software Vulkan, else the CPU twin), gpu
    /// (any adapter), cpu (the f64 twin), or part of an adapter's name.
    #[arg(long, value_name = "WHAT", default_value = "auto")]
    pub device: DeviceChoice,
    /// Threads of the CPU twin and of software Vulkan; default: all cores.
    #[arg(long, value_name = "N", value_parser = values::threads)]
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
    #[arg(long, value_name = "E", value_parser = values::estimator)]
    pub estimator: Option<EstimatorChoice>,
}

/// How files are written.
#[derive(Debug, Args)]
pub(super) struct WriteArgs {
    /// Brightens the PNG by this many stops.
    #[arg(long, value_name = "STOPS", default_value_t = 0.0,
          value_parser = values::exposure)]
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
    #[arg(long, value_name = "A..B", value_parser = values::samples, conflicts_with = "spp")]
    pub samples: Option<Range<u64>>,
    /// Stop after this long, such as 30s or 5m.
    #[arg(long, value_name = "TIME", value_parser = values::time)]
    pub time: Option<Duration>,
    /// Stop when the picture's relative RMS error is this small with 99 % confidence, such as
    /// 1% or 0.01; --spp and --time are then limits, and exit code 1 says that one came first.
    #[arg(long, value_name = "E", value_parser = values::target, conflicts_with = "samples")]
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
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = values::time,
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
    #[arg(long, value_name = "E", value_parser = values::estimator)]
    pub estimator: Option<EstimatorChoice>,
    /// Pixel: its column and row, counted from 0 at the top left.
    #[arg(long, value_name = "X,Y", value_parser = values::pixel)]
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
    #[arg(long, value_name = "E", value_parser = values::estimator)]
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
    #[arg(long, value_name = "TIME", default_value = "60s", value_parser = values::budget)]
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

#[cfg(test)]
mod tests {
    use super::Cli;
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }
}
