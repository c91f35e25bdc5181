//! The race: predictions put to the test by fresh runs with another seed, each until its
//! own stated error is there.

use super::estimators::EstimatorCost;
use super::stopwatch::{Slot, Timed};
use super::{CostError, MakeTracer, Watch};
use crate::estimate::summarize;
use crate::scene::Scene;

/// The part of the time left that is planned for tracing; films have to be read as well,
/// and predictions have errors.
const PLANNED: f64 = 0.85;

/// The first look at a run's error comes at this part of the samples that were predicted.
const FIRST_LOOK: f64 = 0.95;

/// How many targets each run may try within `seconds`, if `times` holds the predicted times
/// to them, ascending, for each run: the cheapest next step is taken while it fits.
#[must_use]
pub fn affordable(times: &[Vec<f64>], seconds: f64) -> Vec<usize> {
    let mut counts = vec![0; times.len()];
    let mut left = seconds;
    loop {
        let steps = times.iter().zip(&counts).enumerate().filter_map(|(run, (times, &count))| {
            let before = if count == 0 { 0.0 } else { times[count - 1] };
            times.get(count).map(|time| (run, time - before))
        });
        match steps.min_by(|a, b| a.1.total_cmp(&b.1)) {
            Some((run, step)) if step <= left => {
                counts[run] += 1;
                left -= step;
            }
            _ => return counts,
        }
    }
}

/// One run of the race.
struct Runner<'a> {
    cost: &'a mut EstimatorCost,
    timed: Timed,
    /// Seconds of the first sample, which compiles the kernel.
    first: f64,
    /// Which prediction it runs for, and how many it may try.
    current: usize,
    tries: usize,
    next_look: u64,
}

impl Runner<'_> {
    fn is_done(&self) -> bool {
        self.current >= self.tries
    }

    /// Time spent tracing, with the first sample charged at the rate of the others.
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    fn seconds(&self) -> f64 {
        let done = self.timed.done() as f64;
        (self.timed.seconds() - self.first) * done / (done - 1.0)
    }

    fn turn(&mut self, seconds: f64) -> Result<(), CostError> {
        let end = self.timed.done() + self.timed.fitting(seconds);
        self.timed.trace_to(end.min(self.next_look))?;
        if self.timed.done() < self.next_look {
            return Ok(());
        }
        let error = summarize(&self.timed.tracer().film()?).relative_error;
        let error = error.unwrap_or(f64::INFINITY);
        while !self.is_done() && error <= self.cost.predictions[self.current].target {
            self.cost.predictions[self.current].measured = Some(self.seconds());
            self.current += 1;
        }
        self.next_look = self.next_look(error);
        Ok(())
    }

    /// Where the error is expected to be small enough: by the prediction, and where that was
    /// too early, by the error at the last look.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "a guess at a count"
    )]
    fn next_look(&self, error: f64) -> u64 {
        let Some(prediction) = self.cost.predictions.get(self.current) else {
            return u64::MAX;
        };
        let done = self.timed.done();
        let planned = ((prediction.samples * FIRST_LOOK) as u64).max(2);
        if planned > done {
            return planned;
        }
        let growth = (error / prediction.target).powi(2).min(2.0);
        ((done as f64 * growth).ceil() as u64).max(done + 1)
    }
}

/// Lets all estimators race for what was predicted to fit, and notes the times beside the
/// predictions.
pub(super) fn race(
    scene: &Scene,
    costs: &mut [EstimatorCost],
    device: MakeTracer,
    slot: &Slot,
    watch: &mut Watch,
) -> Result<(), CostError> {
    let predicted: Vec<Vec<f64>> = costs
        .iter()
        .map(|cost| cost.predictions.iter().map(|p| p.seconds.value).collect())
        .collect();
    let tries = affordable(&predicted, PLANNED * slot.left());
    let settings = scene.settings().with_seed(scene.settings().seed().wrapping_add(1));
    let mut runners = Vec::new();
    for (cost, tries) in costs.iter_mut().zip(tries).filter(|(_, tries)| *tries > 0) {
        let settings = settings.with_estimator(cost.estimator);
        let scene = scene.clone().with_settings(settings);
        let mut timed = Timed::new(device(&scene)?, &scene);
        let first = timed.trace_to(1)?;
        timed.trace_to(2)?;
        let mut runner = Runner { cost, timed, first, current: 0, tries, next_look: 2 };
        runner.next_look = runner.next_look(f64::INFINITY).max(2);
        runners.push(runner);
        slot.report(watch)?;
    }
    let turn = slot.turn(runners.len().max(1));
    while slot.left() > 0.0 && !runners.iter().all(Runner::is_done) {
        for runner in runners.iter_mut().filter(|runner| !runner.is_done()) {
            runner.turn(turn)?;
            slot.report(watch)?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::affordable;

    /// By hand: steps of 1 and 2 come first, then 8 of the first run; 90 and 198 do not fit.
    #[test]
    fn the_cheapest_steps_are_taken_while_they_fit() {
        let times = [vec![1.0, 9.0, 99.0], vec![2.0, 200.0], vec![]];
        assert_eq!(affordable(&times, 11.0), [2, 1, 0]);
        assert_eq!(affordable(&times, 10.9), [1, 1, 0]);
        assert_eq!(affordable(&times, 0.5), [0, 0, 0]);
        assert_eq!(affordable(&times, 1e9), [3, 2, 0]);
    }
}
