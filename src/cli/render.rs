//! `candor render`: from a scene file to pictures.

use super::args::{DeviceChoice, EstimatorChoice, RenderArgs};
use super::output::Outputs;
use super::progress::Reporter;
use super::{
    DONE, FAILED, INTERRUPTED, Refusal, choose, interrupt, memory, pilot, refuse, setup, streams,
    units,
};
use crate::bound::sample_scale;
use crate::estimate::{FIRST_LOOK, Summary, is_look, summarize};
use crate::film::{Film, SampleRanges};
use crate::render::{Audience, Outcome, Plan, Progress, Stop, render};
use crate::report::{ErrorLog, FileError, Picture, Provenance};
use crate::scene::{MAX_SPP, Scene, Source};
use crate::tracer::{Description, Ledger};
use serde::Serialize;
use std::path::PathBuf;
use std::time::{Duration, Instant};

pub(super) fn run(args: &RenderArgs) -> Result<u8, Refusal> {
    let (scene, source) = setup::load(&args.scene, &args.common, &args.sampling)?;
    let plan = plan(args, &scene);
    let outputs = Outputs::new(args)?;
    if let Some(log) = args.log.as_ref().filter(|log| outputs.contains(log)) {
        return refuse(format_args!("{}: named both as output and as log", log.display()));
    }
    if plan.time.is_none() && plan.target_error.is_none() {
        outputs.check_films(plan.samples.end - plan.samples.start)?;
    }
    let finished = if scene.has_lights() {
        trace(args, scene, &source, plan)?
    } else {
        darkness(args, scene, &plan)?
    };
    let picture = Picture::develop(&finished.film, !finished.scene.has_lights());
    let provenance = finished.provenance(args);
    interrupt::writing_begins();
    let files = outputs.write(&picture, &provenance, args.exposure)?;
    streams::results(&finished.report(args, &files))?;
    if let Some(error) = finished.log_error {
        return Err(error.into());
    }
    Ok(match (finished.outcome.stop, finished.target_reached(args.target_error)) {
        (Stop::Interrupted, _) => INTERRUPTED,
        (_, Some(false)) => FAILED,
        _ => DONE,
    })
}

/// What to render: the samples that were asked for; with `--time` or `--target-error` alone, as
/// many as fit or as it takes.
fn plan(args: &RenderArgs, scene: &Scene) -> Plan {
    let limited = args.time.is_some() || args.target_error.is_some();
    let spp = match args.sampling.spp {
        None if limited => MAX_SPP,
        _ => scene.settings().spp(),
    };
    Plan {
        samples: args.samples.clone().unwrap_or(0..spp),
        time: args.time,
        target_error: args.target_error,
    }
}

/// A render that is over.
struct Finished {
    /// What was rendered, with the estimator that was used.
    scene: Scene,
    film: Film,
    ledger: Ledger,
    summary: Summary,
    outcome: Outcome,
    tracer: Description,
    /// Why the log is not whole.
    log_error: Option<FileError>,
}

/// The log that was asked for, and what became of it. A log that cannot be written costs no
/// picture: it is given up, and said at the end.
struct Log {
    file: Option<ErrorLog>,
    error: Option<FileError>,
}

impl Log {
    fn create(args: &RenderArgs) -> Result<Self, Refusal> {
        let file = args.log.as_deref().map(ErrorLog::create).transpose()?;
        Ok(Self { file, error: None })
    }

    fn observe(&mut self, progress: &Progress) {
        if let Some(summary) = progress.summary.filter(|look| look.samples == progress.done) {
            self.add(&summary, progress.elapsed);
        }
    }

    fn add(&mut self, summary: &Summary, elapsed: Duration) {
        let added = self.file.as_mut().map_or(Ok(()), |file| file.add(summary, elapsed));
        if let Err(error) = added {
            self.error = Some(error);
            self.file = None;
        }
    }
}

fn trace(
    args: &RenderArgs,
    mut scene: Scene,
    source: &Source,
    mut plan: Plan,
) -> Result<Finished, Refusal> {
    let common = &args.common;
    let interrupt = interrupt::watch()?;
    let chosen = choose::choose(&common.device, common.threads)?;
    setup::check_range(&scene, source, &[chosen.arithmetic()])?;
    let needed = memory::needed(scene.size(), chosen.on_processor());
    memory::check(scene.size(), needed)?;
    let mut log = Log::create(args)?;
    let mut reporter = Reporter::new(common.quiet, scene.size().pixels(), &plan);
    if common.device == DeviceChoice::Auto && chosen.adapter().is_none() {
        reporter.message("no Vulkan, Metal or DX12 device opens here; the CPU twin takes over");
    }
    if args.sampling.estimator == Some(EstimatorChoice::Auto) {
        let started = Instant::now();
        scene = pilot::choose_estimator(scene, &chosen, interrupt, &reporter)?;
        plan.time = plan.time.map(|limit| limit.saturating_sub(started.elapsed()));
    }
    let mut tracer = chosen.tracer(&scene)?;
    let description = tracer.describe();
    reporter.message(&format!(
        "{}x{} pixels on {} ({}), {} of memory",
        scene.size().width(),
        scene.size().height(),
        description.device,
        description.driver,
        units::bytes(needed),
    ));
    let audience = if log.file.is_some() { Audience::Log } else { reporter.audience() };
    let outcome = render(tracer.as_mut(), &plan, interrupt, audience, &mut |progress| {
        log.observe(&progress);
        reporter.observe(progress);
    });
    reporter.finish();
    let outcome = outcome?;
    let film = tracer.film()?;
    let ledger = tracer.ledger()?;
    let mut summary = summarize(&film);
    // Invalid samples add 0 where they should not, and an interruption is no look that the
    // confidence is spread over: in neither case does the bound hold.
    let planned = outcome.stop != Stop::Interrupted || is_look(summary.samples);
    if ledger.count > 0 || !planned {
        summary.error_bound = None;
    }
    log.add(&summary, outcome.elapsed);
    let log_error = log.error;
    Ok(Finished { scene, summary, film, ledger, outcome, tracer: description, log_error })
}

/// A scene without lights is a picture of exact zeros; nothing needs to be traced.
fn darkness(args: &RenderArgs, scene: Scene, plan: &Plan) -> Result<Finished, Refusal> {
    let on_host = true;
    memory::check(scene.size(), memory::needed(scene.size(), on_host))?;
    let mut samples = SampleRanges::default();
    // A target is reached at the first look.
    let end = plan.target_error.map_or(plan.samples.end, |_| plan.samples.end.min(FIRST_LOOK));
    samples.insert(plan.samples.start..end)?;
    let summary = Summary::of_darkness(samples.count());
    let mut log = Log::create(args)?;
    log.add(&summary, Duration::ZERO);
    Ok(Finished {
        summary,
        log_error: log.error,
        film: Film::awaiting(scene.size(), sample_scale(&scene), samples),
        ledger: Ledger::default(),
        outcome: Outcome { stop: Stop::Done, elapsed: Duration::ZERO },
        tracer: Description {
            device: "none, the scene has no lights".to_owned(),
            driver: format!("candor {}", env!("CARGO_PKG_VERSION")),
            software: true,
        },
        scene,
    })
}

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
    outputs: &'a [PathBuf],
}

impl Finished {
    /// Whether the error is certainly at or below the target, if there is one.
    fn target_reached(&self, target: Option<f64>) -> Option<bool> {
        target.map(|target| self.summary.error_bound.is_some_and(|bound| bound <= target))
    }

    fn seconds(&self) -> f64 {
        self.outcome.elapsed.as_secs_f64()
    }

    #[expect(clippy::cast_precision_loss, reason = "for show")]
    fn rate(&self) -> Option<f64> {
        let samples = self.summary.samples as f64 * f64::from(self.film.size().pixels());
        (self.seconds() > 0.0).then(|| samples / self.seconds())
    }

    fn provenance(&self, args: &RenderArgs) -> Provenance {
        let name = args.scene.file_name().unwrap_or_default();
        Provenance {
            scene_file: name.to_string_lossy().into_owned(),
            scene_hash: self.scene.hash(),
            estimator: self.scene.settings().estimator().name(),
            bounces: self.scene.settings().bounces(),
            seed: self.scene.settings().seed(),
            samples: self.film.samples().clone(),
            scale: self.film.scale(),
            tracer: self.tracer.clone(),
            seconds: self.seconds(),
            invalid_samples: self.ledger.count,
            unproven_pixels: self.summary.unproven_pixels,
            coarse_pixels: self.summary.coarse_pixels,
            relative_error: self.summary.relative_error,
            error_bound: self.summary.error_bound,
        }
    }

    fn report(&self, args: &RenderArgs, files: &[PathBuf]) -> String {
        if args.common.json {
            return self.json(args, files);
        }
        let written = files.iter().map(|file| format!("wrote {}", file.display()));
        let invalid = self.ledger.records.iter().map(|sample| {
            format!(
                "invalid: pixel {},{} sample {} ({:?})",
                sample.pixel % self.film.size().width(),
                sample.pixel / self.film.size().width(),
                sample.index,
                sample.reason
            )
        });
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
        if self.outcome.stop == Stop::Interrupted {
            return "the render was interrupted".to_owned();
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
