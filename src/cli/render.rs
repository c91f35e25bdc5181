//! `candor render`: from a scene file to pictures.

use super::args::{DeviceChoice, EstimatorChoice, RenderArgs};
use super::checkpoint::Checkpoints;
use super::endure::{self, Traced};
use super::log::Log;
use super::output::{Outputs, Wishes};
use super::progress::Reporter;
use super::render_report::Finished;
use super::{Refusal, choose, interrupt, memory, pilot, refuse, resume, setup, streams, units};
use crate::bound::sample_scale;
use crate::estimate::{FIRST_LOOK, Summary, is_look, summarize};
use crate::film::{Film, Identity, SampleRanges};
use crate::render::{Audience, Begun, Outcome, Plan, Stop};
use crate::report::{Origin, StoredFilm};
use crate::scene::{MAX_SPP, Scene, Source};
use crate::tracer::{Description, Ledger, Tracer};
use std::path::Path;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

pub(super) fn run(args: &RenderArgs) -> Result<u8, Refusal> {
    let (scene, source) = setup::load(&args.scene, &args.common, &args.sampling)?;
    let outputs = outputs(args)?;
    let (scene, begun) = match outputs.state().filter(|_| args.resume) {
        Some(path) => resume::open(path, scene, args)?,
        None => (scene, None),
    };
    let job = Job::new(args, scene, source, begun)?;
    job.check_films(&outputs)?;
    let finished = if job.scene.has_lights() { job.trace(&outputs)? } else { job.darkness()? };
    interrupt::writing_begins();
    let aside = finished.aside.as_deref();
    let (files, failed) =
        outputs.write(&finished.picture(), &finished.film, &finished.provenance(), aside)?;
    if failed.is_none() || !files.is_empty() {
        streams::results(&finished.report(args, &files))?;
    }
    let (code, invalid) = (finished.code(args), finished.ledger.count);
    if let Some(refusal) = failed.or(finished.log_error.map(Refusal::from)) {
        return Err(refusal);
    }
    if args.strict && invalid > 0 {
        streams::message(&format!(
            "error: {invalid} samples were invalid, and --strict allows none"
        ));
    }
    Ok(code)
}

fn outputs(args: &RenderArgs) -> Result<Outputs, Refusal> {
    let wishes = Wishes::of(&args.write, args.common.quiet);
    let outputs = Outputs::new(&args.output, args.scene.file_stem(), wishes)?;
    match args.log.as_ref().filter(|log| outputs.contains(log)) {
        Some(log) => refuse(format_args!("{}: named both as output and as log", log.display())),
        None => Ok(outputs),
    }
}

/// What is to be rendered.
struct Job<'a> {
    args: &'a RenderArgs,
    scene: Scene,
    source: Source,
    /// The film that is gone on from.
    begun: Option<StoredFilm>,
    plan: Plan,
    /// The samples of the film in the end, unless something else ends it.
    planned: SampleRanges,
}

impl<'a> Job<'a> {
    /// The samples that were asked for and are not there; with `--time` or `--target-error`
    /// alone, as many as fit or as it takes.
    fn new(
        args: &'a RenderArgs,
        scene: Scene,
        source: Source,
        begun: Option<StoredFilm>,
    ) -> Result<Self, Refusal> {
        let there = samples(begun.as_ref());
        let limited = args.time.is_some() || args.target_error.is_some();
        let spp = match args.sampling.spp {
            None if limited => MAX_SPP - there.count(),
            _ => scene.settings().spp(),
        };
        let plan = Plan {
            begun: begun.as_ref().map(|film| earlier(film, args)).unwrap_or_default(),
            ranges: there.missing(&args.samples.clone().unwrap_or(0..spp)),
            time: args.time,
            target_error: args.target_error,
        };
        let planned = there.union(&plan.ranges)?;
        Ok(Self { args, scene, source, begun, plan, planned })
    }

    /// Whether something but the samples may end it.
    fn is_limited(&self) -> bool {
        self.plan.time.is_some() || self.plan.target_error.is_some()
    }

    /// Refuses to trace what could not be written in the end.
    fn check_films(&self, outputs: &Outputs) -> Result<(), Refusal> {
        if self.is_limited() {
            return Ok(());
        }
        let undecided = self.args.sampling.estimator == Some(EstimatorChoice::Auto);
        let identity = (!undecided || self.begun.is_some()).then(|| self.identity());
        outputs.check_films(identity.as_ref(), &self.planned)
    }

    fn identity(&self) -> Identity {
        Identity::of(&self.scene, sample_scale(&self.scene))
    }

    fn trace(mut self, outputs: &Outputs) -> Result<Finished, Refusal> {
        let (args, common) = (self.args, &self.args.common);
        let interrupt = interrupt::watch()?;
        let chosen = choose::choose(&common.device, common.threads)?;
        setup::check_range(&self.scene, &self.source, &[chosen.arithmetic()])?;
        let needed = memory::needed(&self.scene, chosen.films());
        memory::check(self.scene.size(), needed)?;
        let earlier = self.begun.as_ref().map(StoredFilm::read).transpose()?;
        let mut log = Log::create(args, self.plan.begun.samples)?;
        let mut reporter = Reporter::new(common.quiet, self.scene.size().pixels(), &self.plan);
        if common.device == DeviceChoice::Auto && chosen.adapter().is_none() {
            let twin = "no Vulkan, Metal or DX12 device opens here; the CPU twin takes over";
            reporter.message(twin);
        }
        if args.sampling.estimator == Some(EstimatorChoice::Auto) && self.begun.is_none() {
            let started = Instant::now();
            self.scene = pilot::choose_estimator(self.scene, &chosen, interrupt, &reporter)?;
            self.plan.time = self.plan.time.map(|limit| limit.saturating_sub(started.elapsed()));
        }
        let mut tracer = chosen.enduring(&self.scene, reporter.messenger())?;
        let origin = self.origin(&tracer.describe());
        self.announce(&tracer.describe(), needed, &reporter);
        if let Some((film, begun)) = earlier.zip(self.begun.as_ref()) {
            tracer.restore(&film, &begun.provenance.spent.ledger)?;
        }
        let begun = samples(self.begun.as_ref());
        let mut checkpoints = Checkpoints::new(outputs.state(), &origin, args, &begun)?;
        checkpoints.announce(&reporter);
        let audience = if log.is_kept() { Audience::Log } else { reporter.audience() };
        let rendered =
            endure::trace(&mut tracer, &self.plan, interrupt, audience, &mut |at, tracer| {
                log.observe(at);
                reporter.observe(at);
                checkpoints.observe(at, tracer, &reporter)
            });
        reporter.finish();
        if interrupt.load(Ordering::Relaxed) {
            reporter.message("interrupted: writing what was rendered");
        }
        checkpoints.finish(&reporter);
        let Traced { outcome, film, ledger, failure } = rendered?;
        drop(tracer);
        if let Some(error) = failure {
            streams::message(&format!("error: {error}"));
        }
        let cut_short = matches!(outcome.stop, Stop::Interrupted | Stop::Failed);
        // One look at a limit is in the confidence, that of the render which began the film.
        let planned = !cut_short && self.plan.begun.samples == 0;
        let summary = summary(&film, &ledger, planned);
        log.add(&summary, outcome.elapsed);
        let (scene, target) = (self.scene, args.target_error);
        let aside = checkpoints.aside().map(Path::to_owned);
        let log_error = log.end();
        Ok(Finished { scene, origin, film, ledger, summary, outcome, target, aside, log_error })
    }

    /// Says what is about to happen.
    fn announce(&self, tracer: &Description, needed: u64, reporter: &Reporter) {
        reporter.message(&format!(
            "{} pixels on {} ({}), {} of memory",
            self.scene.size(),
            tracer.device,
            tracer.driver,
            units::bytes(needed),
        ));
        let Some(film) = &self.begun else { return };
        let (path, there) = (film.path().display(), &film.provenance);
        let time = units::time(there.spent.seconds);
        reporter.message(&format!("goes on from {path}: samples {}, {time}", there.samples));
        let made = &there.origin.tracer;
        if made.and(tracer) != *made {
            reporter.message(&format!(
                "warning: {path} was made on {} ({}); its samples may differ from this device's \
                 by rounding",
                made.device, made.driver
            ));
        }
    }

    /// A scene without lights is a picture of exact zeros; nothing needs to be traced.
    fn darkness(self) -> Result<Finished, Refusal> {
        memory::check(self.scene.size(), memory::needed(&self.scene, 1))?;
        let args = self.args;
        let mut known = self.planned.clone();
        if args.target_error.is_some() {
            // A target is reached at the first look, or by whatever is there.
            known = samples(self.begun.as_ref());
            if known.count() == 0 {
                known.insert(0..FIRST_LOOK)?;
            }
        }
        let summary = Summary::of_darkness(known.count());
        let elapsed = self.plan.begun.elapsed;
        let mut log = Log::create(args, 0)?;
        log.add(&summary, elapsed);
        let origin = self.origin(&Description {
            device: "none, the scene has no lights".to_owned(),
            driver: format!("candor {}", env!("CARGO_PKG_VERSION")),
            software: true,
        });
        Ok(Finished {
            summary,
            origin,
            aside: None,
            log_error: log.end(),
            film: Film::awaiting(self.scene.size(), sample_scale(&self.scene), known),
            ledger: Ledger::default(),
            outcome: Outcome { stop: Stop::Done, elapsed, next_look: None },
            target: args.target_error,
            scene: self.scene,
        })
    }

    fn origin(&self, tracer: &Description) -> Origin {
        let name = self.args.scene.file_name().unwrap_or_default();
        let before = self.begun.as_ref().map(|film| &film.provenance.origin.tracer);
        Origin {
            scene_file: name.to_string_lossy().into_owned(),
            identity: self.identity(),
            dark: !self.scene.has_lights(),
            tracer: before.map_or_else(|| tracer.clone(), |before| before.and(tracer)),
        }
    }
}

/// The samples of a film that is gone on from, if there is one.
fn samples(begun: Option<&StoredFilm>) -> SampleRanges {
    begun.map(|film| film.provenance.samples.clone()).unwrap_or_default()
}

/// What is known of a film that is gone on from.
fn earlier(film: &StoredFilm, args: &RenderArgs) -> Begun {
    let spent = &film.provenance.spent;
    Begun {
        samples: film.provenance.samples.count(),
        elapsed: Duration::from_secs_f64(spent.seconds),
        next_look: spent
            .next_look
            .filter(|look| Some(look.target) == args.target_error)
            .map(|look| look.samples),
    }
}

/// The summary of a film. Invalid samples add 0 where they should not, and where a render was
/// cut short is no look that the confidence is spread over: in neither case does the bound hold.
pub(super) fn summary(film: &Film, ledger: &Ledger, planned: bool) -> Summary {
    let mut summary = summarize(film);
    if ledger.count > 0 || !(planned || is_look(summary.samples)) {
        summary.error_bound = None;
    }
    summary
}
