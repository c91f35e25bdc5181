//! The pilot: all estimators in turns, and what each of them costs.

use super::fit::{Agreement, Point, Slope, agreement, fit};
use super::halves::{Batch, Growth, Snapshot};
use super::interval::{LogError, Measured};
use super::stopwatch::{Slot, Timed, shortest, take_turns};
use super::{CostError, MakeTracer, Watch};
use crate::scene::{Estimator, MAX_SPP, Scene};
use serde::Serialize;

/// Relative RMS errors to which the time is predicted.
pub const TARGETS: [f64; 5] = [0.1, 0.03, 0.01, 0.003, 0.001];

/// A variance is stated from so many effective hits on; with fewer, what was not found yet
/// may be most of it.
const MIN_HITS: f64 = 100.0;

/// Realised errors are judged from so many effective pixels that vary on: a point's logarithm
/// is then known to 1/√(2·100) = 7 %, close enough to normal for odds of one in a thousand.
pub const MIN_VARYING: f64 = 100.0;

/// What one estimator costs.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct EstimatorCost {
    /// Which one.
    #[serde(serialize_with = "by_name")]
    pub estimator: Estimator,
    /// Samples of every pixel in the pilot.
    pub samples: u64,
    /// Seconds for one sample.
    pub seconds_per_sample: Measured,
    /// Pixels to which no sample has contributed.
    pub unproven_pixels: u64,
    /// Effective number of pixels that hold the noise; slope and agreement are never suspect
    /// below [`MIN_VARYING`].
    pub varying_pixels: f64,
    /// What is known of the noise; `None` where too few samples have met light.
    pub noise: Option<Noise>,
    /// Realised errors of the halves, at doubling counts.
    pub convergence: Vec<Point>,
    /// Slope of those errors against samples.
    pub slope: Option<Slope>,
    /// Those errors over the stated ones.
    pub agreement: Option<Agreement>,
    /// Time for an error over that of the cheapest estimator, from the same rounds; `None`
    /// where either is unknown or without variance.
    pub beside_cheapest: Option<Measured>,
    /// Predicted times to [`TARGETS`]; empty where the noise is not known, and where there is
    /// none.
    pub predictions: Vec<Prediction>,
}

/// How noisy one estimator's samples are.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Noise {
    /// Variance of one sample's luminance, averaged over the pixels, over the squared mean
    /// luminance of the picture: the squared relative RMS error at one sample per pixel.
    pub variance: Measured,
    /// 1/(variance × seconds per sample), in 1/s; `None` where there is no variance.
    pub efficiency: Option<Measured>,
    /// Error of the variance, on a log scale.
    #[serde(skip)]
    error: LogError,
}

/// The time to an error.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Prediction {
    /// Relative RMS error to be reached.
    pub target: f64,
    /// Samples of every pixel that it takes; at least two, which an error bar needs.
    pub samples: f64,
    /// Seconds that they take.
    pub seconds: Measured,
    /// Seconds that a run with another seed took until its own stated error was there;
    /// `None` where that did not fit into the budget.
    pub measured: Option<f64>,
}

impl EstimatorCost {
    /// Whether all samples of a pixel were alike: there is no error to bring down.
    #[must_use]
    pub fn is_noiseless(&self) -> bool {
        self.price() == Some(0.0)
    }

    /// Variance times seconds per sample, what an error costs; `None` where it is unknown.
    #[must_use]
    pub fn price(&self) -> Option<f64> {
        self.noise.map(|noise| noise.variance.value * self.seconds_per_sample.value)
    }
}

#[expect(clippy::trivially_copy_pass_by_ref, reason = "what serde calls")]
pub(super) fn by_name<S: serde::Serializer>(
    estimator: &Estimator,
    serializer: S,
) -> Result<S::Ok, S::Error> {
    serializer.serialize_str(estimator.name())
}

/// One estimator in the pilot.
struct Contestant {
    estimator: Estimator,
    timed: Timed,
    growth: Growth,
}

impl Contestant {
    /// Compiles the kernel, with the first sample.
    fn start(estimator: Estimator, scene: &Scene, device: MakeTracer) -> Result<Self, CostError> {
        let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
        let mut timed = Timed::new(device(&scene)?, &scene);
        timed.trace_to(1)?;
        let growth = Growth::new(&timed.tracer().film()?);
        Ok(Self { estimator, timed, growth })
    }

    /// Traces on until the device has found its pace.
    fn warm_up(&mut self, turn: f64) -> Result<(), CostError> {
        loop {
            let took = self.step(u64::MAX)?;
            if self.growth.is_doubled() && self.timed.is_warm(took, turn) {
                return Ok(());
            }
        }
    }

    /// Traces to the next look at the film, at most to `end`; returns the seconds.
    fn step(&mut self, end: u64) -> Result<f64, CostError> {
        let look = self.growth.next_look();
        let seconds = self.timed.trace_to(end.min(look))?;
        if self.timed.done() == look {
            self.growth.look(&self.timed.tracer().film()?);
        }
        Ok(seconds)
    }

    /// One timed round; films are read in between, at doubling counts.
    fn round(&mut self, turn: f64) -> Result<(), CostError> {
        let before = self.timed.done();
        let end = (before + self.timed.fitting(turn)).min(MAX_SPP);
        let mut seconds = 0.0;
        while self.timed.done() < end {
            seconds += self.step(end)?;
        }
        self.timed.record(self.timed.done() - before, seconds);
        Ok(())
    }

    fn finish(&mut self, pixels: f64) -> Result<EstimatorCost, CostError> {
        let invalid = self.timed.tracer().ledger()?.count;
        if invalid > 0 {
            let estimator = self.estimator.name();
            return Err(CostError::Invalid { count: invalid, estimator });
        }
        let end = Snapshot::of(&self.timed.tracer().film()?);
        let (seconds, time_error) = self.timed.per_sample();
        let variance = variance(&end, &self.growth.batches(&end), pixels);
        let noise = variance.map(|(value, error)| {
            let combined = LogError::of_product(&[error, time_error]);
            let efficiency = (value > 0.0).then(|| combined.interval(1.0 / value / seconds));
            (Noise { variance: error.interval(value), efficiency, error }, combined)
        });
        let present = noise.filter(|(noise, _)| noise.variance.value > 0.0);
        let predictions = present.map_or(Vec::new(), |(noise, error)| {
            let frame = seconds * pixels;
            TARGETS.map(|target| predict(target, noise.variance.value, frame, error)).to_vec()
        });
        let convergence = present.map_or(Vec::new(), |_| self.growth.points(&end));
        let varying_pixels = end.varying_pixels();
        let mut slope = fit(&convergence);
        let mut agreement =
            noise.and_then(|(noise, _)| agreement(&convergence, noise.variance.value));
        if varying_pixels < MIN_VARYING {
            slope = slope.map(|slope| Slope { suspect: false, ..slope });
            agreement = agreement.map(|found| Agreement { suspect: false, ..found });
        }
        Ok(EstimatorCost {
            estimator: self.estimator,
            samples: end.samples,
            seconds_per_sample: time_error.interval(seconds),
            unproven_pixels: end.unproven,
            noise: noise.map(|(noise, _)| noise),
            varying_pixels,
            slope,
            agreement,
            convergence,
            beside_cheapest: None,
            predictions,
        })
    }
}

/// The relative variance of one sample, and its error: from the spread of the batches'
/// variances, weighted by their samples, and from the error of the mean, which enters twice.
#[expect(clippy::cast_precision_loss, reason = "counts of samples and batches")]
fn variance(end: &Snapshot, batches: &[Batch], pixels: f64) -> Option<(f64, LogError)> {
    let mean = end.luminance();
    let variance = end.variance();
    if variance == 0.0 && end.unproven == 0 {
        return Some((0.0, LogError::known(0.0)));
    }
    if mean == 0.0 || variance == 0.0 || end.hits < MIN_HITS || batches.len() < 2 {
        return None;
    }
    let weight: f64 = batches.iter().map(|batch| batch.samples as f64).sum();
    let centre = batches.iter().map(|b| b.samples as f64 * b.variance).sum::<f64>() / weight;
    let spread: f64 =
        batches.iter().map(|b| b.samples as f64 * (b.variance - centre).powi(2)).sum();
    let freedom = batches.len() as f64 - 1.0;
    let of_batches = LogError { error: (spread / freedom / weight).sqrt() / variance, freedom };
    let of_mean = (variance / end.samples as f64 / pixels).sqrt() / mean;
    let error = LogError::of_product(&[of_batches, LogError::known(2.0 * of_mean)]);
    Some((variance / (mean * mean), error))
}

fn predict(target: f64, variance: f64, frame: f64, error: LogError) -> Prediction {
    let samples = (variance / (target * target)).ceil().max(2.0);
    Prediction { target, samples, seconds: error.interval(samples * frame), measured: None }
}

/// Runs the pilot.
pub(super) fn pilot(
    scene: &Scene,
    estimators: &[Estimator],
    device: MakeTracer,
    slot: &Slot,
    watch: &mut Watch,
) -> Result<Vec<EstimatorCost>, CostError> {
    let turn = slot.turn(estimators.len());
    let mut contestants = Vec::new();
    for &estimator in estimators {
        contestants.push(Contestant::start(estimator, scene, device)?);
        slot.report(watch)?;
    }
    let slot = &slot.restarted();
    for contestant in &mut contestants {
        contestant.warm_up(turn)?;
        slot.report(watch)?;
    }
    slot.check(shortest(contestants.iter().map(|contestant| contestant.timed.pace())))?;
    take_turns(&mut contestants, slot, watch, Contestant::round)?;
    let pixels = f64::from(scene.size().pixels());
    let costs = contestants.iter_mut().map(|contestant| contestant.finish(pixels));
    let mut costs = costs.collect::<Result<Vec<_>, _>>()?;
    compare(&mut costs, &contestants);
    Ok(costs)
}

/// Sets the prices beside the cheapest one. Their ratio is known better than each of them, as
/// the machine's drift cancels within a round.
fn compare(costs: &mut [EstimatorCost], contestants: &[Contestant]) {
    let Some(best) = cheapest(costs) else { return };
    let noise = |cost: &EstimatorCost| Some((cost.noise?.variance, cost.noise?.error));
    let Some((unit, unit_error)) = noise(&costs[best]).filter(|(v, _)| v.value > 0.0) else {
        return;
    };
    for place in (0..costs.len()).filter(|&place| place != best) {
        let Some((variance, error)) = noise(&costs[place]) else { continue };
        let (ratio, spread) = contestants[place].timed.beside(&contestants[best].timed);
        let error = LogError::of_product(&[error, unit_error, spread]);
        let price = error.interval(ratio * variance.value / unit.value);
        costs[place].beside_cheapest = Some(price);
    }
}

/// The place of the estimator that is cheapest for its error, where any error is known; of
/// several without variance, the fastest.
pub(super) fn cheapest(costs: &[EstimatorCost]) -> Option<usize> {
    let known = costs
        .iter()
        .enumerate()
        .filter_map(|(place, cost)| Some((place, cost.price()?, cost.seconds_per_sample.value)));
    known.min_by(|a, b| a.1.total_cmp(&b.1).then(a.2.total_cmp(&b.2))).map(|(place, ..)| place)
}
