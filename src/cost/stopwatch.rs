//! Tracers under the stopwatch: timed rounds in turns, so that a machine's drift hits all
//! alike.

use super::interval::{LogError, Measured, mean_and_deviation};
use super::{CostError, Phase, Plan, Watch};
use crate::scene::{MAX_SPP, Scene};
use crate::tracer::Tracer;
use crate::watch::Interrupted;
use std::time::{Duration, Instant};

/// Fewest rounds that are timed; their spread is the interval of the rate.
const MIN_ROUNDS: usize = 3;

/// Rounds that a phase is divided into at least, where samples are short enough.
const ROUNDS: f64 = 16.0;

/// Longest turn in seconds: what disturbs a machine for longer hits all in turns alike.
const LONGEST_TURN: f64 = 0.1;

/// Warm-up ends when a call takes this share of a turn: what came before has compiled the
/// kernel and found the device's pace.
const WARM: f64 = 0.25;

/// A tracer and the time that it takes.
pub(super) struct Timed {
    tracer: Box<dyn Tracer>,
    pixels: f64,
    done: u64,
    seconds: f64,
    /// Seconds for one sample of every pixel, in the latest call.
    pace: f64,
    /// Seconds per sample, one for each timed round.
    rounds: Vec<f64>,
}

impl Timed {
    pub fn new(tracer: Box<dyn Tracer>, scene: &Scene) -> Self {
        let pixels = f64::from(scene.size().pixels());
        Self { tracer, pixels, done: 0, seconds: 0.0, pace: 0.0, rounds: Vec::new() }
    }

    /// The tracer itself.
    pub fn tracer(&mut self) -> &mut dyn Tracer {
        self.tracer.as_mut()
    }

    /// Samples of every pixel so far.
    pub fn done(&self) -> u64 {
        self.done
    }

    /// Seconds spent tracing so far.
    pub fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Seconds for one sample of every pixel, as the latest call had it.
    pub fn pace(&self) -> f64 {
        self.pace
    }

    /// Traces on until `end` samples of every pixel; returns the seconds that it took.
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    pub fn trace_to(&mut self, end: u64) -> Result<f64, CostError> {
        let end = end.min(MAX_SPP);
        if end <= self.done {
            return Ok(0.0);
        }
        let started = Instant::now();
        self.tracer.add_samples(self.done..end)?;
        let took = started.elapsed().as_secs_f64();
        self.pace = took / (end - self.done) as f64;
        self.seconds += took;
        self.done = end;
        Ok(took)
    }

    /// Doubles the samples until the tracer is warm.
    pub fn warm_up(&mut self, turn: f64) -> Result<(), CostError> {
        loop {
            let took = self.trace_to((2 * self.done).max(1))?;
            if self.is_warm(took, turn) {
                return Ok(());
            }
        }
    }

    /// Whether a call that took so long, a good part of a `turn`, tells the pace. The first
    /// call compiles the kernel and tells nothing.
    pub fn is_warm(&self, took: f64, turn: f64) -> bool {
        self.done > 1 && (took >= WARM * turn || self.done >= MAX_SPP)
    }

    /// Samples of every pixel that fit into a `turn` of so many seconds; at least one, and
    /// not many times what was traced before.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a guess at a count"
    )]
    pub fn fitting(&self, turn: f64) -> u64 {
        ((turn / self.pace.max(1e-9)) as u64).clamp(1, 4 * self.done.max(1))
    }

    /// Records a round of `samples` that took `seconds`.
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    pub fn record(&mut self, samples: u64, seconds: f64) {
        if samples > 0 {
            self.rounds.push(seconds / samples as f64 / self.pixels);
        }
    }

    /// One timed round of about `turn` seconds.
    pub fn round(&mut self, turn: f64) -> Result<(), CostError> {
        let before = self.done;
        let seconds = self.trace_to(before + self.fitting(turn))?;
        self.record(self.done - before, seconds);
        Ok(())
    }

    /// Seconds per sample: the median of the rounds, with their spread.
    pub fn per_sample(&self) -> (f64, LogError) {
        per_sample(&self.rounds)
    }

    /// Seconds per sample over those of another, which took turns with it: a ratio in each round, so
    /// that what slowed both does not count.
    pub fn beside(&self, other: &Self) -> (f64, LogError) {
        ratio(&self.rounds, &other.rounds)
    }

    /// Seconds per sample with their interval.
    pub fn per_sample_interval(&self) -> Measured {
        let (value, error) = self.per_sample();
        error.interval(value)
    }
}

/// The median of some rounds. Its standard error is √(π/2) = 1.2533 times that of the mean,
/// which is what the median of normal values has (Kendall & Stuart, vol. 1, 14.6); rounds
/// that something else disturbed widen it.
#[expect(clippy::cast_precision_loss, reason = "a handful of rounds")]
fn per_sample(rounds: &[f64]) -> (f64, LogError) {
    let mut sorted = rounds.to_vec();
    sorted.sort_by(f64::total_cmp);
    let count = sorted.len();
    let median = f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2]);
    let (_, deviation) = mean_and_deviation(sorted.iter().map(|seconds| seconds.ln()));
    let error = (std::f64::consts::PI / 2.0).sqrt() * deviation / (count as f64).sqrt();
    (median, LogError { error, freedom: count as f64 - 1.0 })
}

/// The median ratio of rounds that were taken in turns.
fn ratio(ours: &[f64], theirs: &[f64]) -> (f64, LogError) {
    let ratios: Vec<f64> = ours.iter().zip(theirs).map(|(ours, theirs)| ours / theirs).collect();
    per_sample(&ratios)
}

/// A share of the budget: when it began and how long it may take.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slot {
    pub phase: Phase,
    started: Instant,
    length: Duration,
}

impl Slot {
    pub fn new(phase: Phase, length: Duration) -> Self {
        Self { phase, started: Instant::now(), length }
    }

    /// The same, beginning now: kernels are compiled outside of the budget.
    pub fn restarted(&self) -> Self {
        Self::new(self.phase, self.length)
    }

    /// Seconds left.
    pub fn left(&self) -> f64 {
        self.length.saturating_sub(self.started.elapsed()).as_secs_f64()
    }

    /// All of its seconds.
    pub fn seconds(&self) -> f64 {
        self.length.as_secs_f64()
    }

    /// Refuses what takes more than `shortest` seconds if that is not left.
    pub fn check(&self, shortest: f64) -> Result<(), CostError> {
        if shortest <= self.left() {
            return Ok(());
        }
        let length = Duration::from_secs_f64(self.seconds() + shortest - self.left());
        Err(CostError::Short { needed: Plan::budget_for(self.phase, length) })
    }

    /// Tells of the part that has passed.
    pub fn report(&self, watch: &mut Watch) -> Result<(), Interrupted> {
        watch.report(self.phase, self.started.elapsed().as_secs_f64() / self.length.as_secs_f64())
    }

    /// Seconds that each of `items` may take in one turn.
    #[expect(clippy::cast_precision_loss, reason = "a handful of items")]
    pub fn turn(&self, items: usize) -> f64 {
        (self.length.as_secs_f64() / ROUNDS / items as f64).min(LONGEST_TURN)
    }
}

/// Lets the items take turns until the slot is over, and at least three rounds; each round
/// begins with another one, so that none is always the first.
pub(super) fn take_turns<T>(
    items: &mut [T],
    slot: &Slot,
    watch: &mut Watch,
    mut turn: impl FnMut(&mut T, f64) -> Result<(), CostError>,
) -> Result<(), CostError> {
    let seconds = slot.turn(items.len());
    let mut round = 0;
    while round < MIN_ROUNDS || slot.left() > 0.0 {
        for place in 0..items.len() {
            let item = (place + round) % items.len();
            turn(&mut items[item], seconds)?;
            slot.report(watch)?;
        }
        round += 1;
    }
    Ok(())
}

/// Seconds that [`take_turns`] takes at least, for items with these paces.
#[expect(clippy::cast_precision_loss, reason = "three")]
pub(super) fn shortest(paces: impl Iterator<Item = f64>) -> f64 {
    paces.sum::<f64>() * MIN_ROUNDS as f64
}

#[cfg(test)]
mod tests {
    use super::{per_sample, ratio};

    /// One round of twice the time moves the mean by 10 %, and the median hardly.
    #[test]
    fn the_median_does_not_mind_a_disturbed_round() {
        let mut rounds = [1.0, 1.01, 0.99, 1.0, 1.02, 0.98, 1.01, 0.99, 1.0, 2.0];
        let (median, error) = per_sample(&rounds);
        assert!((median - 1.0).abs() < 0.01 && error.error > 0.05, "{median} {error:?}");
        rounds[9] = 1.0;
        assert!(per_sample(&rounds).1.error < 0.01);
    }

    /// A machine that becomes three times slower: neither rate is known well, their ratio is.
    #[test]
    fn drift_cancels_in_a_ratio() {
        let drift = |round: u32| 1.0 + f64::from(round) / 5.0;
        let ours: Vec<f64> = (0..11).map(|round| 1.3 * drift(round)).collect();
        let theirs: Vec<f64> = (0..11).map(drift).collect();
        let (value, error) = ratio(&ours, &theirs);
        assert!((value - 1.3).abs() < 1e-12 && error.error < 1e-12, "{value} {error:?}");
        assert!(per_sample(&ours).1.error > 0.1);
    }
}
