//! The two kernels on a device: compiled and run in turns, so that a machine that slows down
//! slows both alike.

use super::facts::Version;
use super::saving::{Agreement, Saving};
use crate::cost::Measured as Interval;
use crate::gpu::{Adapter, Gpu, GpuTracer};
use crate::kernel::Kernel;
use crate::scene::{ImageSize, MAX_SPP, Scene};
use crate::tracer::{TraceError, Tracer};
use crate::watch::{Interrupted, Watch};
use serde::Serialize;
use std::time::{Duration, Instant};

/// Longest side of the picture that is traced.
const SIDE: u32 = 256;

/// Compilations of each kernel, unless they take longer than [`COMPILING`].
const COMPILATIONS: u32 = 7;

/// Time for compiling; the first compilation of each kernel may take longer.
const COMPILING: Duration = Duration::from_secs(3);

/// Samples of each pixel that are traced to see what compiling takes: with it and without.
const COMPILED_SAMPLES: u64 = 2;

/// Rounds in which both kernels are timed: the median of fewer than six has no 95 % interval.
const FEWEST_ROUNDS: usize = 6;

/// Time for tracing.
const TRACING: Duration = Duration::from_secs(6);

/// Length of a turn, in seconds: what disturbs a machine for longer hits both alike.
const TURN: f64 = 0.1;

/// Most samples of each pixel in a turn.
const MOST: u64 = MAX_SPP >> 10;

/// A call that takes this long tells the pace; the first one compiles and tells nothing.
const WARM: f64 = TURN / 4.0;

/// What is being measured.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Step {
    /// The kernels are compiled.
    Compiling,
    /// The kernels trace in turns.
    Tracing,
}

impl Step {
    /// What is done, in a few words.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Compiling => "compiling both kernels",
            Self::Tracing => "tracing with both kernels in turns",
        }
    }
}

/// Why there is no measurement.
#[derive(Debug, thiserror::Error)]
pub enum ExplainError {
    /// The device gave up, or refuses scene or kernel.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The user stopped it.
    #[error("interrupted")]
    Interrupted,
}

impl From<Interrupted> for ExplainError {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// What was measured of the two kernels; pairs are (specialised, general).
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Measured {
    /// Width of the picture that was traced, in pixels.
    pub width: u32,
    /// Height.
    pub height: u32,
    /// Samples of each pixel that each kernel traced.
    pub spp: u64,
    /// How often each kernel was compiled.
    pub compilations: usize,
    /// Seconds from a kernel's text to the end of its first dispatch, less what the same
    /// dispatch takes afterwards: the median, and the shortest and the longest time.
    pub compile_seconds: [Interval; 2],
    /// Rounds in which both were timed.
    pub rounds: usize,
    /// Seconds per sample: the median of the rounds with its 95 % interval.
    pub seconds_per_sample: [Interval; 2],
    /// Specialised over general, round by round: the median with its 95 % interval.
    pub ratio: Interval,
    /// What that says.
    pub saving: Saving,
    /// How the films of the two compare.
    pub films: Agreement,
    /// Samples that were invalid.
    pub invalid_samples: [u64; 2],
}

/// Compiles and runs both kernels on a device.
///
/// # Errors
/// If the device refuses the scene or fails, or the user interrupts.
pub fn measure(
    scene: &Scene,
    versions: [&Version; 2],
    adapter: &Adapter,
    watch: &mut Watch<'_, Step>,
) -> Result<Measured, ExplainError> {
    let bench = Bench { scene, versions, adapter };
    let size = reduced(scene.size());
    let (mut tracers, compiled) = bench.compile(size, watch)?;
    let (rounds, spp) = trace(&mut tracers, size, watch)?;
    let [ours, general] = &mut tracers;
    let (films, software) = ([ours.film()?, general.film()?], adapter.is_software());
    let ratios: Vec<f64> = rounds.iter().map(|[ours, general]| ours / general).collect();
    let ratio = median(&ratios);
    Ok(Measured {
        width: size.width(),
        height: size.height(),
        spp,
        compilations: compiled.len(),
        compile_seconds: [0, 1].map(|which| spread(compiled.iter().map(|pair| pair[which]))),
        rounds: rounds.len(),
        seconds_per_sample: [0, 1].map(|which| {
            let own: Vec<f64> = rounds.iter().map(|pair| pair[which]).collect();
            median(&own)
        }),
        ratio,
        saving: Saving::of(ratio),
        films: Agreement::of(&films[0], &films[1], software),
        invalid_samples: [ours.ledger()?.count, general.ledger()?.count],
    })
}

fn median(values: &[f64]) -> Interval {
    Interval::median(values).expect("there are at least six rounds")
}

/// The median between the extremes.
fn spread(values: impl Iterator<Item = f64>) -> Interval {
    let mut sorted: Vec<f64> = values.collect();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    Interval {
        value: f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2]),
        low: sorted[0],
        high: sorted[count - 1],
    }
}

/// The same shape with sides of at most [`SIDE`] pixels.
fn reduced(size: ImageSize) -> ImageSize {
    let largest = size.width().max(size.height());
    if largest <= SIDE {
        return size;
    }
    let shorter = |side: u32| (side * SIDE / largest).max(1);
    ImageSize::new(shorter(size.width()), shorter(size.height()))
        .expect("both sides are from 1 to SIDE")
}

/// The two kernels and where they run.
struct Bench<'a> {
    scene: &'a Scene,
    versions: [&'a Version; 2],
    adapter: &'a Adapter,
}

impl Bench<'_> {
    /// A tracer with the kernel for pictures of another size. It sees the same view: how wide it
    /// is stays as it was packed.
    fn tracer(&self, which: usize, size: ImageSize) -> Result<GpuTracer, TraceError> {
        let Version { packed, kernel } = self.versions[which];
        let wgsl = Kernel { size, ..kernel.clone() }.wgsl();
        let scene = self.scene.clone().with_size(size);
        GpuTracer::with_kernel(&scene, Gpu::open(self.adapter)?, packed, &wgsl)
    }

    /// Tracers of the picture, and seconds for compiling each kernel, in turns. Each time the
    /// kernel is for a picture of another width, a constant of it, so that no cache of the driver
    /// has it.
    fn compile(
        &self,
        size: ImageSize,
        watch: &mut Watch<'_, Step>,
    ) -> Result<([GpuTracer; 2], Vec<[f64; 2]>), ExplainError> {
        let started = Instant::now();
        watch.report(Step::Compiling, 0.0)?;
        let (ours, first) = self.compiled(0, size)?;
        watch.report(Step::Compiling, 0.5 / f64::from(COMPILATIONS))?;
        let (general, second) = self.compiled(1, size)?;
        let mut seconds = vec![[first, second]];
        for round in 1..COMPILATIONS {
            if started.elapsed() > COMPILING {
                break;
            }
            watch.report(Step::Compiling, f64::from(round) / f64::from(COMPILATIONS))?;
            let other = ImageSize::new(size.width() + round, size.height())
                .expect("hardly larger than what is traced");
            let mut pair = [0.0; 2];
            for which in order(round as usize) {
                pair[which] = self.compiled(which, other)?.1;
            }
            seconds.push(pair);
        }
        Ok(([ours, general], seconds))
    }

    /// A tracer that has traced two samples of each pixel, and the seconds from the kernel's text
    /// to the end of the first, less those of the second: drivers compile as late as that.
    fn compiled(&self, which: usize, size: ImageSize) -> Result<(GpuTracer, f64), TraceError> {
        let mut tracer = self.tracer(which, size)?;
        let first = timed(|| tracer.add_samples(0..1))?;
        let second = timed(|| tracer.add_samples(1..COMPILED_SAMPLES))?;
        let seconds = tracer.compiling().as_secs_f64() + (first - second).max(0.0);
        Ok((tracer, seconds))
    }
}

/// Which of two comes first in a round.
fn order(round: usize) -> [usize; 2] {
    if round.is_multiple_of(2) { [0, 1] } else { [1, 0] }
}

fn timed(work: impl FnOnce() -> Result<(), TraceError>) -> Result<f64, TraceError> {
    let started = Instant::now();
    work()?;
    Ok(started.elapsed().as_secs_f64())
}

/// Seconds per sample of each tracer, round by round, and how many samples of each pixel both
/// traced in all, those while compiling included; always the same ones.
#[expect(clippy::cast_precision_loss, reason = "counts of samples")]
fn trace(
    tracers: &mut [GpuTracer; 2],
    size: ImageSize,
    watch: &mut Watch<'_, Step>,
) -> Result<(Vec<[f64; 2]>, u64), ExplainError> {
    let mut done = COMPILED_SAMPLES;
    let mut round = 0;
    let mut turn = |count: u64| -> Result<[f64; 2], TraceError> {
        let mut seconds = [0.0; 2];
        for which in order(round) {
            seconds[which] = timed(|| tracers[which].add_samples(done..done + count))?;
        }
        (done, round) = (done + count, round + 1);
        Ok(seconds)
    };
    let mut count = 1;
    loop {
        watch.report(Step::Tracing, 0.0)?;
        let [ours, general] = turn(count)?;
        let slower = ours.max(general);
        if count > 1 && (slower >= WARM || count >= MOST) {
            count = fitting(count, slower);
            break;
        }
        count *= 2;
    }
    let samples = f64::from(size.pixels()) * count as f64;
    let started = Instant::now();
    let mut rounds = Vec::new();
    while rounds.len() < FEWEST_ROUNDS
        || started.elapsed() < TRACING && (rounds.len() as u64) < MAX_SPP / MOST - 3
    {
        rounds.push(turn(count)?.map(|seconds| seconds / samples));
        let time = started.elapsed().as_secs_f64() / TRACING.as_secs_f64();
        watch.report(Step::Tracing, time.min(rounds.len() as f64 / FEWEST_ROUNDS as f64))?;
    }
    Ok((rounds, done))
}

/// Samples of each pixel that fit into a turn, where `count` took so many seconds.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a guess at a count"
)]
fn fitting(count: u64, seconds: f64) -> u64 {
    ((count as f64 * TURN / seconds) as u64).clamp(1, 4 * count).min(MOST)
}
