//! What is said of a render that is over.

use super::args::RenderArgs;
use super::render::Finished;
use super::{ledger, units};
use crate::render::Stop;
use serde::Serialize;
use std::path::PathBuf;

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    device: &'a str,
    driver: &'a str,
    estimator: &'a str,
    width: u32,
    height: u32,
    spp: u64,
    seconds: f64,
    samples_per_second: Option<f64>,
    relative_error: Option<f64>,
    error_bound: Option<f64>,
    target_error: Option<f64>,
    target_reached: Option<bool>,
    unproven_pixels: u64,
    coarse_pixels: u64,
    invalid_samples: u64,
    invalid_records: Vec<ledger::Record>,
    outputs: &'a [PathBuf],
}

impl Finished {
    /// Whether the error is certainly at or below the target, if there is one.
    pub(super) fn target_reached(&self, target: Option<f64>) -> Option<bool> {
        target.map(|target| self.summary.error_bound.is_some_and(|bound| bound <= target))
    }

    pub(super) fn seconds(&self) -> f64 {
        self.outcome.elapsed.as_secs_f64()
    }

    #[expect(clippy::cast_precision_loss, reason = "for show")]
    fn rate(&self) -> Option<f64> {
        let samples = self.summary.samples as f64 * f64::from(self.film.size().pixels());
        (self.seconds() > 0.0).then(|| samples / self.seconds())
    }

    pub(super) fn report(&self, args: &RenderArgs, files: &[PathBuf]) -> String {
        if args.common.json {
            return self.json(args, files);
        }
        let written = files.iter().map(|file| format!("wrote {}", file.display()));
        let invalid = ledger::lines(args, &self.scene, &self.ledger);
        written.chain(invalid).chain([self.line(args.target_error)]).collect::<Vec<_>>().join("\n")
    }

    fn json(&self, args: &RenderArgs, outputs: &[PathBuf]) -> String {
        let json = Json {
            device: &self.tracer.device,
            driver: &self.tracer.driver,
            estimator: self.scene.settings().estimator().name(),
            width: self.film.size().width(),
            height: self.film.size().height(),
            spp: self.summary.samples,
            seconds: self.seconds(),
            samples_per_second: self.rate(),
            relative_error: self.summary.relative_error,
            error_bound: self.summary.error_bound,
            target_error: args.target_error,
            target_reached: self.target_reached(args.target_error),
            unproven_pixels: self.summary.unproven_pixels,
            coarse_pixels: self.summary.coarse_pixels,
            invalid_samples: self.ledger.count,
            invalid_records: ledger::records(args, &self.scene, &self.ledger),
            outputs,
        };
        serde_json::to_string(&json).expect("plain values serialize")
    }

    /// How it ended.
    fn ending(&self, target: Option<f64>) -> String {
        let stopped = match self.outcome.stop {
            Stop::Done | Stop::Target => "done",
            Stop::Time => "time is up",
            Stop::Interrupted => "interrupted",
            Stop::Failed => "failed",
        };
        match (target, self.target_reached(target)) {
            (Some(target), Some(true)) => format!("{} reached", units::percent(target)),
            (Some(target), _) => format!("{stopped}, {} not reached", units::percent(target)),
            _ => stopped.to_owned(),
        }
    }

    /// The error, and with a target also what it is at most.
    fn error(&self, target: Option<f64>) -> String {
        let Some(error) = self.summary.relative_error else { return "error unknown".to_owned() };
        let bound = match (target, self.summary.error_bound) {
            (None, _) => String::new(),
            (_, Some(b)) => format!(", at most {:.3} % with 99 % confidence", 100.0 * b),
            (_, None) => format!(", without a bound ({})", self.why_unbounded()),
        };
        format!("error {:.3} %{bound}", 100.0 * error)
    }

    /// Why nothing can be said of how large the error is at most.
    fn why_unbounded(&self) -> String {
        if self.ledger.count > 0 {
            return "samples were invalid".to_owned();
        }
        match self.outcome.stop {
            Stop::Interrupted => return "the render was interrupted".to_owned(),
            Stop::Failed => return "the render failed".to_owned(),
            Stop::Done | Stop::Target | Stop::Time => {}
        }
        let largest = f64::from(self.film.scale().bound()) / self.summary.luminance;
        format!("one sample may be {largest:.0e} times the mean, so much may not be found yet")
    }

    /// What a target that was not reached would cost, where that can be told.
    #[expect(clippy::cast_precision_loss, reason = "for show")]
    fn more(&self, target: f64) -> Option<String> {
        let more = self.summary.spread.samples_to(target)?.saturating_sub(self.summary.samples);
        let seconds = self.seconds() * more as f64 / self.summary.samples as f64;
        Some(format!("{} takes {} more", units::percent(target), units::time(seconds)))
    }

    /// The last line: what was reached, and what the next halving of the error would cost.
    fn line(&self, target: Option<f64>) -> String {
        let mut facts = vec![
            self.error(target),
            format!("{} spp", self.summary.samples),
            format!("{:.2} s on {}", self.seconds(), self.tracer.device),
            format!("{} invalid samples", self.ledger.count),
            format!("{} unproven pixels", self.summary.unproven_pixels),
        ];
        if self.summary.coarse_pixels > 0 {
            facts.push(format!("{} pixels near the film's step", self.summary.coarse_pixels));
        }
        if let Some(target) = target.filter(|_| self.target_reached(target) == Some(false)) {
            facts.extend(self.more(target));
        }
        if self.summary.relative_error.is_some_and(|error| error > 0.0) {
            // The error falls with the square root of the samples: half of it takes four times.
            facts.push(format!("half the error takes {} more", units::time(3.0 * self.seconds())));
        }
        format!("{}: {}", self.ending(target), facts.join(", "))
    }
}
