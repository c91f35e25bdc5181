//! Which estimator is the cheapest for a scene on a device: a short trial of each measures
//! variance × time.

use crate::estimate::{Summary, summarize};
use crate::scene::{Estimator, ImageSize};
use crate::tracer::{TraceError, Tracer};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// A trial renders no more pixels than this; variance and time per sample hardly depend on
/// the picture's size.
const PIXELS: f64 = 65_536.0;

/// Tracing time of each trial, after a first sample per pixel that compiles the kernel.
const TIME: Duration = Duration::from_millis(250);

/// Fewest samples per pixel of a trial.
const FEWEST: u64 = 8;

/// Most samples per pixel of a trial; a picture of a few pixels has enough then.
const MOST: u64 = 1 << 20;

/// A trial whose mean is below the others' by more than so many standard errors of both has
/// not found their light.
const APART: f64 = 3.0;

/// What a trial of one estimator found.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    /// The estimator.
    pub estimator: Estimator,
    /// Seconds per sample.
    pub seconds_per_sample: f64,
    /// Variance of one sample's luminance, averaged over pixels; `None` if no sample has found
    /// light.
    pub variance: Option<f64>,
    /// Mean luminance of the picture.
    pub luminance: f64,
    /// Its standard error; 0 where it is not known.
    pub luminance_error: f64,
}

impl Trial {
    /// Seconds until a picture of `pixels` pixels has the relative RMS error `error`.
    #[must_use]
    pub fn seconds_to(&self, error: f64, pixels: u32) -> Option<f64> {
        let relative = self.variance? / (self.luminance * self.luminance);
        Some(relative / (error * error) * f64::from(pixels) * self.seconds_per_sample)
    }

    /// Variance × time: what a given error costs.
    fn price(&self) -> Option<f64> {
        Some(self.variance? * self.seconds_per_sample)
    }

    /// Whether this trial's picture is darker than another's beyond both errors: it looks
    /// quiet because it has not found the light.
    fn misses_light_of(&self, other: &Self) -> bool {
        let error = self.luminance_error.hypot(other.luminance_error);
        self.luminance + APART * error < other.luminance
    }
}

/// The estimators that have not found light that another has: all have the same mean.
#[must_use]
pub fn darker(trials: &[Trial]) -> Vec<Estimator> {
    let misses = |trial: &&Trial| trials.iter().any(|other| trial.misses_light_of(other));
    trials.iter().filter(misses).map(|trial| trial.estimator).collect()
}

/// The cheapest estimator of those that have found the light; `None` if none has.
#[must_use]
pub fn cheapest(trials: &[Trial]) -> Option<Estimator> {
    let darker = darker(trials);
    let seeing = trials.iter().filter(|trial| !darker.contains(&trial.estimator));
    let priced = seeing.filter_map(|trial| Some((trial.price()?, trial.estimator)));
    priced.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, estimator)| estimator)
}

/// The size at which a picture is tried out: its own, or smaller with the same sides.
#[must_use]
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "sides that shrink stay in range"
)]
pub fn trial_size(size: ImageSize) -> ImageSize {
    let factor = (PIXELS / f64::from(size.pixels())).sqrt().min(1.0);
    let shrunk = |side: u32| ((f64::from(side) * factor).round() as u32).max(1);
    ImageSize::new(shrunk(size.width()), shrunk(size.height())).unwrap_or(size)
}

/// Tries the tracers in turns, so that a machine that gets faster or slower does so for all;
/// fewer samples where `interrupt` is raised.
///
/// # Errors
/// If a tracer fails.
pub fn try_out(
    tracers: &mut [(Estimator, Box<dyn Tracer>)],
    interrupt: &AtomicBool,
) -> Result<Vec<Trial>, TraceError> {
    for (_, tracer) in tracers.iter_mut() {
        tracer.add_samples(0..1)?;
    }
    let mut done = vec![1; tracers.len()];
    let mut spent = vec![Duration::ZERO; tracers.len()];
    let wants = |done: u64, spent: Duration| done < FEWEST || (spent < TIME && done < MOST);
    while (0..tracers.len()).any(|i| wants(done[i], spent[i])) {
        for (i, (_, tracer)) in tracers.iter_mut().enumerate() {
            if !wants(done[i], spent[i]) {
                continue;
            }
            let started = Instant::now();
            tracer.add_samples(done[i]..2 * done[i])?;
            spent[i] += started.elapsed();
            done[i] *= 2;
        }
        if interrupt.load(Ordering::Relaxed) {
            break;
        }
    }
    tracers
        .iter_mut()
        .zip(done.iter().zip(&spent))
        .map(|((estimator, tracer), (&done, &spent))| {
            let film = tracer.film()?;
            let timed = (done - 1) * u64::from(film.size().pixels());
            #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
            let seconds_per_sample = spent.as_secs_f64() / timed as f64;
            let summary = summarize(&film);
            Ok(Trial {
                estimator: *estimator,
                seconds_per_sample,
                variance: variance(&summary, film.size().pixels()),
                luminance: summary.luminance,
                luminance_error: summary.luminance_error.unwrap_or(0.0),
            })
        })
        .collect()
}

/// Mean variance of a sample, from the standard error of the image mean.
#[expect(clippy::cast_precision_loss, reason = "a count of samples")]
fn variance(summary: &Summary, pixels: u32) -> Option<f64> {
    let error = summary.luminance_error?;
    Some(error * error * summary.samples as f64 * f64::from(pixels))
}
