//! The device beside the f64 twin: the same samples on both, in turns.

use super::estimators::by_name;
use super::interval::{LogError, Measured};
use super::stopwatch::{Slot, Timed, shortest, take_turns};
use super::{CostError, MakeTracer, Watch};
use crate::estimate::{pair, summarize};
use crate::scene::{Estimator, Scene};
use serde::Serialize;

/// What the f64 answer costs, and how far the device's is from it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct TwinCost {
    /// The estimator.
    #[serde(serialize_with = "by_name")]
    pub estimator: Estimator,
    /// Samples of every pixel, the same on both.
    pub samples: u64,
    /// Seconds for one sample on the device.
    pub device_seconds_per_sample: Measured,
    /// Seconds for one sample in the twin.
    pub twin_seconds_per_sample: Measured,
    /// How many times longer the twin takes.
    pub slowdown: Measured,
    /// Device minus twin over the twin's image mean, for each channel; `None` where one of
    /// them found no light, so that there is nothing to compare.
    pub bias: Option<[f64; 3]>,
    /// Its standard error, from paths that rounding sent elsewhere; `None` with the bias.
    pub bias_error: Option<[f64; 3]>,
}

impl TwinCost {
    /// The largest deviation that the samples allow, over all channels: |bias| and twice
    /// its error; `None` without light.
    #[must_use]
    pub fn largest_bias(&self) -> Option<f64> {
        let channels = self.bias?.into_iter().zip(self.bias_error?);
        Some(channels.map(|(bias, error)| bias.abs() + 2.0 * error).fold(0.0, f64::max))
    }
}

/// Runs both, the same samples on each.
pub(super) fn compare(
    scene: &Scene,
    device: MakeTracer,
    twin: MakeTracer,
    slot: &Slot,
    watch: &mut Watch,
) -> Result<TwinCost, CostError> {
    let mut both = [Timed::new(device(scene)?, scene), Timed::new(twin(scene)?, scene)];
    for timed in &mut both {
        timed.trace_to(1)?;
    }
    let slot = &slot.restarted();
    both[1].warm_up(slot.turn(2))?;
    while both[0].done() < both[1].done() {
        both[0].trace_to(2 * both[0].done())?;
    }
    slot.check(shortest(both.iter().map(Timed::pace)))?;
    take_turns(&mut [&mut both], slot, watch, |both, turn| {
        // The turn is for both: the rest of what the device leaves is the twin's.
        let share = both[1].pace() / (both[0].pace() + both[1].pace());
        let end = both[1].done() + both[1].fitting(turn * share);
        for timed in both.iter_mut() {
            let before = timed.done();
            let seconds = timed.trace_to(end)?;
            timed.record(timed.done() - before, seconds);
        }
        Ok(())
    })?;
    let [mut device, mut twin] = both;
    let films = [device.tracer().film()?, twin.tracer().film()?];
    let lit = films.iter().all(|film| summarize(film).luminance > 0.0);
    let paired = lit.then(|| pair(&films[0], &films[1]));
    let (ours, our_error) = device.per_sample();
    let (theirs, their_error) = twin.per_sample();
    Ok(TwinCost {
        estimator: scene.settings().estimator(),
        samples: twin.done(),
        device_seconds_per_sample: our_error.interval(ours),
        twin_seconds_per_sample: their_error.interval(theirs),
        slowdown: LogError::of_product(&[our_error, their_error]).interval(theirs / ours),
        bias: paired.map(|paired| paired.bias),
        bias_error: paired.map(|paired| paired.error),
    })
}
