//! `--estimator auto`: tries every estimator out and says what it found.

use super::choose::Chosen;
use super::progress::Reporter;
use super::{Refusal, refuse, units};
use crate::bound;
use crate::pilot::{Trial, cheapest, darker, trial_size, try_out};
use crate::scene::{Estimator, Scene};
use std::sync::atomic::AtomicBool;

/// Flips bits of the picture's seed.
const TRIAL_SEED: u32 = 0x9e37_79b9;

/// The error to which the trials' predictions are given.
const TO_ERROR: f64 = 0.01;

/// The scene with the estimator that is cheapest for it on this device. No sample of a
/// trial enters the picture, which has the bits that naming the estimator gives.
pub(super) fn choose_estimator(
    scene: Scene,
    device: &Chosen,
    interrupt: &AtomicBool,
    reporter: &Reporter,
) -> Result<Scene, Refusal> {
    let mut tracers = Vec::new();
    for estimator in Estimator::ALL {
        // Other random numbers than the picture's: what is lucky in the trial must not be so
        // in the picture.
        let seed = scene.settings().seed() ^ TRIAL_SEED;
        let settings = scene.settings().with_estimator(estimator).with_seed(seed);
        let trial = scene.clone().with_size(trial_size(scene.size())).with_settings(settings);
        match bound::check(&trial) {
            Ok(()) => tracers.push((estimator, device.tracer(&trial)?)),
            Err(why) => reporter.message(&format!("{}: left out; {why}", estimator.name())),
        }
    }
    let trials = try_out(&mut tracers, interrupt)?;
    let darker = darker(&trials);
    for trial in &trials {
        let missing = if darker.contains(&trial.estimator) { ", but misses light" } else { "" };
        reporter.message(&format!("{}{missing}", line(trial, scene.size().pixels())));
    }
    // Where no trial has found light, the one that looks for it wherever it goes.
    let Some(estimator) = cheapest(&trials).or(trials.last().map(|trial| trial.estimator)) else {
        return refuse("the scene has more bounces than any estimator takes");
    };
    reporter.message(&format!("taken: {}", estimator.name()));
    let settings = scene.settings().with_estimator(estimator);
    Ok(scene.with_settings(settings))
}

/// What one trial found, for a picture of `pixels` pixels.
fn line(trial: &Trial, pixels: u32) -> String {
    let rate = units::rate(1.0 / trial.seconds_per_sample);
    let found = match (trial.variance, trial.seconds_to(TO_ERROR, pixels)) {
        (Some(variance), Some(seconds)) => format!(
            "variance {:.3} of the squared mean, {} to {}",
            variance / (trial.luminance * trial.luminance),
            units::time(seconds),
            units::percent(TO_ERROR)
        ),
        _ => "no light found yet".to_owned(),
    };
    format!("{:<9} {rate}, {found}", trial.estimator.name())
}
