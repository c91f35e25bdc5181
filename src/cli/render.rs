//! `candor render`: from a scene file to pictures.

use super::args::{DeviceChoice, EstimatorChoice, RenderArgs};
use super::endure::{self, Traced};
use super::output::Outputs;
use super::progress::Reporter;
use super::{
    DONE, FAILED, INTERRUPTED, REFUSED, Refusal, choose, interrupt, memory, pilot, refuse, setup,
    streams, units,
};
use crate::bound::sample_scale;
use crate::estimate::{FIRST_LOOK, Summary, is_look, summarize};
use crate::film::{Film, SampleRanges};
use crate::render::{Audience, Outcome, Plan, Progress, Stop};
use crate::report::{ErrorLog, FileError, Picture, Provenance};
use crate::scene::{MAX_SPP, Scene, Source};
use crate::tracer::{Description, Ledger, Tracer};
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
    if args.strict && finished.ledger.count > 0 {
        let count = finished.ledger.count;
        streams::message(&format!("error: {count} samples were invalid, and --strict allows none"));
    }
    Ok(finished.code(args))
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
pub(super) struct Finished {
    /// What was rendered, with the estimator that was used.
    pub scene: Scene,
    pub film: Film,
    pub ledger: Ledger,
    pub summary: Summary,
    pub outcome: Outcome,
    pub tracer: Description,
    /// Why the log is not whole.
    pub log_error: Option<FileError>,
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
    let needed = memory::needed(&scene, chosen.films());
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
    let mut tracer = chosen.enduring(&scene, reporter.messenger())?;
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
    let rendered = endure::trace(&mut tracer, &plan, interrupt, audience, &mut |progress| {
        log.observe(&progress);
        reporter.observe(progress);
    });
    reporter.finish();
    let Traced { outcome, film, ledger, failure } = rendered?;
    drop(tracer);
    if let Some(error) = failure {
        streams::message(&format!("error: {error}"));
    }
    let mut summary = summarize(&film);
    // Invalid samples add 0 where they should not, and an interruption is no look that the
    // confidence is spread over: in neither case does the bound hold.
    let cut_short = matches!(outcome.stop, Stop::Interrupted | Stop::Failed);
    let planned = !cut_short || is_look(summary.samples);
    if ledger.count > 0 || !planned {
        summary.error_bound = None;
    }
    log.add(&summary, outcome.elapsed);
    let log_error = log.error;
    Ok(Finished { scene, summary, film, ledger, outcome, tracer: description, log_error })
}

/// A scene without lights is a picture of exact zeros; nothing needs to be traced.
fn darkness(args: &RenderArgs, scene: Scene, plan: &Plan) -> Result<Finished, Refusal> {
    memory::check(scene.size(), memory::needed(&scene, 1))?;
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

impl Finished {
    /// The exit code.
    pub(super) fn code(&self, args: &RenderArgs) -> u8 {
        let missed = self.target_reached(args.target_error) == Some(false);
        match self.outcome.stop {
            Stop::Interrupted => INTERRUPTED,
            Stop::Failed => REFUSED,
            _ if missed || (args.strict && self.ledger.count > 0) => FAILED,
            _ => DONE,
        }
    }

    pub(super) fn provenance(&self, args: &RenderArgs) -> Provenance {
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
            ledger: self.ledger.clone(),
            unproven_pixels: self.summary.unproven_pixels,
            coarse_pixels: self.summary.coarse_pixels,
            relative_error: self.summary.relative_error,
            error_bound: self.summary.error_bound,
        }
    }
}
