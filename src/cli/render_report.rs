//! What is said of a render that is over.

use super::args::RenderArgs;
use super::{DONE, FAILED, INTERRUPTED, REFUSED, ledger, units};
use crate::estimate::{Summary, is_look, next_look};
use crate::film::Film;
use crate::render::{Outcome, Stop};
use crate::report::{FileError, NextLook, Origin, Picture, Provenance, Spent};
use crate::scene::Scene;
use crate::tracer::Ledger;
use serde::Serialize;
use std::path::PathBuf;

/// A render that is over.
pub(super) struct Finished {
    /// What was rendered, with the estimator that was used.
    pub scene: Scene,
    pub origin: Origin,
    pub film: Film,
    pub ledger: Ledger,
    pub summary: Summary,
    pub outcome: Outcome,
    /// The error that was aimed at.
    pub target: Option<f64>,
    /// Where checkpoints went, if not to the film that keeps the state.
    pub aside: Option<PathBuf>,
    /// Why the log is not whole.
    pub log_error: Option<FileError>,
}

/// What `--json` says of a film, whether rendered or merged.
#[derive(Serialize)]
pub(super) struct FilmJson<'a> {
    device: &'a str,
    driver: &'a str,
    estimator: &'a str,
    width: u32,
    height: u32,
    spp: u64,
    samples: String,
    seconds: f64,
    relative_error: Option<f64>,
    error_bound: Option<f64>,
    unproven_pixels: u64,
    coarse_pixels: u64,
    invalid_samples: u64,
    outputs: &'a [PathBuf],
}

impl<'a> FilmJson<'a> {
    pub fn of(film: &'a Provenance, outputs: &'a [PathBuf]) -> Self {
        let Origin { identity, tracer, .. } = &film.origin;
        Self {
            device: &tracer.device,
            driver: &tracer.driver,
            estimator: identity.estimator.name(),
            width: identity.size.width(),
            height: identity.size.height(),
            spp: film.samples.count(),
            samples: film.samples.to_string(),
            seconds: film.spent.seconds,
            relative_error: film.relative_error,
            error_bound: film.error_bound,
            unproven_pixels: film.unproven_pixels,
            coarse_pixels: film.coarse_pixels,
            invalid_samples: film.spent.ledger.count,
            outputs,
        }
    }
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    #[serde(flatten)]
    film: FilmJson<'a>,
    samples_per_second: Option<f64>,
    target_error: Option<f64>,
    target_reached: Option<bool>,
    invalid_records: Vec<ledger::Record>,
}

impl Finished {
    /// The exit code.
    pub(super) fn code(&self, args: &RenderArgs) -> u8 {
        let missed = self.target_reached() == Some(false);
        match self.outcome.stop {
            Stop::Interrupted => INTERRUPTED,
            Stop::Failed => REFUSED,
            _ if missed || (args.strict && self.ledger.count > 0) => FAILED,
            _ => DONE,
        }
    }

    pub(super) fn picture(&self) -> Picture {
        Picture::develop(&self.film, self.origin.dark)
    }

    pub(super) fn provenance(&self) -> Provenance {
        let planned = NextLook::planned(self.target, self.outcome.next_look);
        let spent = Spent {
            ledger: self.ledger.clone(),
            seconds: self.seconds(),
            next_look: planned.filter(|_| self.outcome.stop != Stop::Target),
        };
        Provenance::new(self.origin.clone(), spent, &self.film, &self.summary)
    }

    /// Whether the error is certainly at or below the target, if there is one.
    pub(super) fn target_reached(&self) -> Option<bool> {
        self.target.map(|target| self.summary.error_bound.is_some_and(|bound| bound <= target))
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
        written.chain(invalid).chain([self.line()]).collect::<Vec<_>>().join("\n")
    }

    fn json(&self, args: &RenderArgs, outputs: &[PathBuf]) -> String {
        let film = self.provenance();
        let json = Json {
            film: FilmJson::of(&film, outputs),
            samples_per_second: self.rate(),
            target_error: self.target,
            target_reached: self.target_reached(),
            invalid_records: ledger::records(args, &self.scene, &self.ledger),
        };
        serde_json::to_string(&json).expect("plain values serialize")
    }

    /// How it ended.
    fn ending(&self) -> String {
        let stopped = match self.outcome.stop {
            Stop::Done | Stop::Target => "done",
            Stop::Time => "time is up",
            Stop::Interrupted => "interrupted",
            Stop::Failed => "failed",
        };
        match (self.target, self.target_reached()) {
            (Some(target), Some(true)) => format!("{} reached", units::percent(target)),
            (Some(target), _) => format!("{stopped}, {} not reached", units::percent(target)),
            _ => stopped.to_owned(),
        }
    }

    /// The error, and with a target also what it is at most.
    fn error(&self) -> String {
        let error = error_text(self.summary.relative_error);
        if self.summary.relative_error.is_none() {
            return error;
        }
        let bound = match (self.target, self.summary.error_bound) {
            (None, _) => String::new(),
            (_, Some(b)) => format!(", at most {:.3} % with 99 % confidence", 100.0 * b),
            (_, None) => format!(", without a bound ({})", self.why_unbounded()),
        };
        format!("{error}{bound}")
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
        let samples = self.summary.samples;
        if !is_look(samples) && self.summary.spread.ceiling(samples).is_finite() {
            let look = next_look(samples, Some(samples + 1));
            return format!(
                "after --resume it is known at certain counts only, such as {look} spp"
            );
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
    fn line(&self) -> String {
        let provable = self.ledger.count == 0;
        let missed = self.target.filter(|_| provable && self.target_reached() == Some(false));
        let more = missed.and_then(|target| self.more(target));
        let facts = facts(&self.provenance(), self.error(), more);
        format!("{}: {}", self.ending(), facts.join(", "))
    }
}

/// What a film came to, beginning with its error; `more` is what something else would cost.
pub(super) fn facts(film: &Provenance, error: String, more: Option<String>) -> Vec<String> {
    let Spent { ledger, seconds, .. } = &film.spent;
    let mut facts = vec![
        error,
        format!("{} spp", film.samples.count()),
        format!("{seconds:.2} s on {}", film.origin.tracer.device),
        format!("{} invalid samples", ledger.count),
        format!("{} unproven pixels", film.unproven_pixels),
    ];
    if film.coarse_pixels > 0 {
        facts.push(format!("{} pixels near the film's step", film.coarse_pixels));
    }
    facts.extend(more);
    if film.relative_error.is_some_and(|error| error > 0.0) {
        // The error falls with the square root of the samples: half of it takes four times.
        facts.push(format!("half the error takes {} more", units::time(3.0 * seconds)));
    }
    facts
}

/// An error as people read it.
pub(super) fn error_text(error: Option<f64>) -> String {
    error.map_or("error unknown".to_owned(), |error| format!("error {:.3} %", 100.0 * error))
}
