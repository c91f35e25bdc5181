//! The bounce ladder: what each further scattering costs, and the light that is missing
//! without it.

use super::estimators::by_name;
use super::interval::{CONFIDENCE, Measured, student};
use super::stopwatch::{Slot, Timed, shortest, take_turns};
use super::{CostError, MakeTracer, Watch};
use crate::bound;
use crate::estimate::summarize;
use crate::scene::{Estimator, Invalid, Scene};
use serde::Serialize;

/// Bounces that are measured, besides the scene's own.
pub const RUNGS: [u32; 6] = [0, 1, 2, 3, 4, 8];

/// One count of bounces.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Rung {
    /// Most scatterings of one path.
    pub bounces: u32,
    /// The estimator.
    #[serde(serialize_with = "by_name")]
    pub estimator: Estimator,
    /// Seconds for one sample.
    pub seconds_per_sample: Measured,
    /// Share of the deepest rung's mean luminance that is missing; `None` for that rung
    /// itself, and on every rung where that one's light is not certainly above zero.
    pub missing: Option<Measured>,
    /// Seconds to a relative RMS error of 1 %, at least those of the two samples that an error
    /// bar needs; `None` where no light was found.
    pub seconds_to_one_percent: Option<f64>,
}

/// The ladder, and the counts of bounces that the film refuses.
pub(super) struct Ladder {
    pub rungs: Vec<Rung>,
    pub refused: Vec<(u32, Invalid)>,
}

/// A rung while it is measured.
struct Climb {
    bounces: u32,
    timed: Timed,
}

/// The counts of bounces for a scene that has `own`.
pub(super) fn rungs(own: u32) -> Vec<u32> {
    let mut rungs = RUNGS.to_vec();
    rungs.push(own);
    rungs.sort_unstable();
    rungs.dedup();
    rungs
}

/// Runs the ladder with the scene's estimator.
pub(super) fn ladder(
    scene: &Scene,
    device: MakeTracer,
    slot: &Slot,
    watch: &mut Watch,
) -> Result<Ladder, CostError> {
    let (mut climbs, mut refused) = (Vec::new(), Vec::new());
    let rungs = rungs(scene.settings().bounces());
    for (seed, &bounces) in (0..).zip(&rungs) {
        let settings = match scene.settings().with_bounces(bounces) {
            // Independent samples on every rung, so that their errors are independent.
            Ok(settings) => settings.with_seed(scene.settings().seed().wrapping_add(seed)),
            Err(error) => {
                refused.push((bounces, error));
                continue;
            }
        };
        let scene = scene.clone().with_settings(settings);
        if let Err(error) = bound::check(&scene) {
            refused.push((bounces, error));
            continue;
        }
        let mut timed = Timed::new(device(&scene)?, &scene);
        timed.trace_to(1)?;
        climbs.push(Climb { bounces, timed });
        slot.report(watch)?;
    }
    let slot = &slot.restarted();
    for climb in &mut climbs {
        climb.timed.warm_up(slot.turn(rungs.len()))?;
        slot.report(watch)?;
    }
    slot.check(shortest(climbs.iter().map(|climb| climb.timed.pace())))?;
    take_turns(&mut climbs, slot, watch, |climb, turn| climb.timed.round(turn))?;
    Ok(Ladder { rungs: judge(climbs, scene)?, refused })
}

/// Compares every rung with the deepest one.
fn judge(climbs: Vec<Climb>, scene: &Scene) -> Result<Vec<Rung>, CostError> {
    let mut rungs = Vec::new();
    let mut means = Vec::new();
    for mut climb in climbs {
        let summary = summarize(&climb.timed.tracer().film()?);
        let per_sample = climb.timed.per_sample_interval();
        let frame = per_sample.value * f64::from(scene.size().pixels());
        // The error squared times the time that it took: what the error of 1 costs.
        #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
        let price = |error: f64| error * error * frame * summary.samples as f64;
        let to_one_percent = |error: f64| (price(error) * 1e4).max(2.0 * frame);
        means.push(summary.luminance_error.map(|error| (summary.luminance, error)));
        rungs.push(Rung {
            bounces: climb.bounces,
            estimator: scene.settings().estimator(),
            seconds_per_sample: per_sample,
            missing: None,
            seconds_to_one_percent: summary.relative_error.map(to_one_percent),
        });
    }
    let measure = means.split_last().and_then(|(deepest, shallower)| {
        let certain = |(mean, error): &(f64, f64)| *mean > deviations() * error;
        Some((deepest.filter(certain)?, shallower))
    });
    if let Some((deepest, shallower)) = measure {
        for (rung, mean) in rungs.iter_mut().zip(shallower) {
            // A rung that found nothing has no error bar of its own; it may be all black.
            let mean = mean.unwrap_or((0.0, 0.0));
            rung.missing = Some(missing(mean, deepest));
        }
    }
    Ok(rungs)
}

/// 1 - a/b for two independent means with standard errors, with the interval of a ratio to
/// first order.
fn missing((a, error_a): (f64, f64), (b, error_b): (f64, f64)) -> Measured {
    let ratio = a / b;
    let error = error_a.hypot(ratio * error_b) / b;
    Measured::around(1.0 - ratio, deviations() * error)
}

/// Half the width of an interval, in standard errors.
fn deviations() -> f64 {
    student(f64::INFINITY, CONFIDENCE)
}

#[cfg(test)]
mod tests {
    use super::{missing, rungs};

    #[test]
    fn the_scenes_own_bounces_are_a_rung() {
        assert_eq!(rungs(2), [0, 1, 2, 3, 4, 8]);
        assert_eq!(rungs(5), [0, 1, 2, 3, 4, 5, 8]);
        assert_eq!(rungs(64), [0, 1, 2, 3, 4, 8, 64]);
    }

    /// 3 ± 0.3 of 4 ± 0.4: a quarter is missing, ± 1.96·√(0.3² + (0.75·0.4)²)/4 by hand.
    #[test]
    fn missing_light_has_the_error_of_both_means() {
        let share = missing((3.0, 0.3), (4.0, 0.4));
        assert!((share.value - 0.25).abs() < 1e-12);
        assert!((share.high - share.value - 0.207_89).abs() < 1e-4, "{share:?}");
    }
}
