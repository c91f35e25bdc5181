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

/// A variance is judged by what it may be at most with this probability of being more.
const DOUBT: f64 = 1e-3;

/// What a trial of one estimator found.
#[derive(Debug, Clone, Copy)]
pub struct Trial {
    /// The estimator.
    pub estimator: Estimator,
    /// Seconds per sample.
    pub seconds_per_sample: f64,
    /// Variance of one sample over the squared mean luminance, averaged over pixels; `None` if
    /// no sample has found light.
    pub variance: Option<f64>,
    /// What that variance may be at most, light that was not found yet included.
    pub variance_bound: Option<f64>,
}

impl Trial {
    /// Seconds until a picture of `pixels` pixels has the relative RMS error `error`.
    #[must_use]
    pub fn seconds_to(&self, error: f64, pixels: u32) -> Option<f64> {
        let samples = self.variance? / (error * error) * f64::from(pixels);
        Some(samples * self.seconds_per_sample)
    }

    /// Variance × time, by which trials are ranked: the variance at its bound, so that an
    /// estimator that has hardly found the light does not look as if it had no noise.
    fn price(&self) -> Option<f64> {
        Some(self.variance_bound? * self.seconds_per_sample)
    }
}

/// The cheapest estimator; `None` if no trial has found light.
#[must_use]
pub fn cheapest(trials: &[Trial]) -> Option<Estimator> {
    let priced = trials.iter().filter_map(|trial| Some((trial.price()?, trial.estimator)));
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
                variance: relative_variance(&summary),
                variance_bound: summary.spread.relative_variance_bound(done, DOUBT),
            })
        })
        .collect()
}

/// Variance per sample over the squared mean luminance.
#[expect(clippy::cast_precision_loss, reason = "a count of samples")]
fn relative_variance(summary: &Summary) -> Option<f64> {
    let error = summary.relative_error?;
    Some(error * error * summary.samples as f64)
}
