//! `candor render`: from a scene file to pictures.

use super::args::{DeviceChoice, RenderArgs};
use super::output::Outputs;
use super::progress::Reporter;
use super::{DONE, INTERRUPTED, Refusal, choose, interrupt, memory, setup, streams, units};
use crate::bound::sample_scale;
use crate::estimate::{Summary, summarize};
use crate::film::{Film, SampleRanges};
use crate::render::{Outcome, Plan, Stop, render};
use crate::report::{Picture, Provenance};
use crate::scene::{MAX_SPP, Scene};
use crate::tracer::{Description, Ledger};
use serde::Serialize;
use std::path::PathBuf;
use std::time::Duration;

pub(super) fn run(args: &RenderArgs) -> Result<u8, Refusal> {
    let scene = setup::load(&args.common)?;
    let plan = plan(args, &scene);
    let outputs = Outputs::new(args)?;
    if plan.time.is_none() {
        outputs.check_films(plan.samples.end - plan.samples.start)?;
    }
    let finished =
        if scene.has_lights() { trace(args, &scene, &plan)? } else { darkness(&scene, &plan)? };
    let picture = Picture::develop(&finished.film, !scene.has_lights());
    let provenance = finished.provenance(args, &scene);
    interrupt::writing_begins();
    let files = outputs.write(&picture, &provenance, args.exposure)?;
    streams::results(&finished.report(args, &files))?;
    Ok(if finished.outcome.stop == Stop::Interrupted { INTERRUPTED } else { DONE })
}

/// What to render: the samples that were asked for; with `--time` alone, as many as fit.
fn plan(args: &RenderArgs, scene: &Scene) -> Plan {
    let spp = match (args.common.spp, args.time) {
        (None, Some(_)) => MAX_SPP,
        _ => scene.settings().spp(),
    };
    Plan { samples: args.samples.clone().unwrap_or(0..spp), time: args.time }
}

/// A render that is over.
struct Finished {
    film: Film,
    ledger: Ledger,
    summary: Summary,
    outcome: Outcome,
    tracer: Description,
}

fn trace(args: &RenderArgs, scene: &Scene, plan: &Plan) -> Result<Finished, Refusal> {
    let common = &args.common;
    let interrupt = interrupt::watch()?;
    let chosen = choose::choose(&common.device, common.threads)?;
    let needed = memory::needed(scene.size(), chosen.on_processor());
    memory::check(scene.size(), needed)?;
    let mut tracer = chosen.tracer(scene)?;
    let description = tracer.describe();

    let planned = plan.samples.end - plan.samples.start;
    let mut reporter = Reporter::new(common.quiet, scene.size().pixels(), planned, plan.time);
    if common.device == DeviceChoice::Auto && chosen.adapter().is_none() {
        reporter.message("no Vulkan, Metal or DX12 device opens here; the CPU twin takes over");
    }
    reporter.message(&format!(
        "{}x{} pixels on {} ({}), {} of memory",
        scene.size().width(),
        scene.size().height(),
        description.device,
        description.driver,
        units::bytes(needed),
    ));
    let look = reporter.shows_error();
    let outcome = render(tracer.as_mut(), plan, interrupt, look, &mut |p| reporter.observe(p));
    reporter.finish();
    let outcome = outcome?;
    let film = tracer.film()?;
    let ledger = tracer.ledger()?;
    Ok(Finished { summary: summarize(&film), film, ledger, outcome, tracer: description })
}

/// A scene without lights is a picture of exact zeros; nothing needs to be traced.
fn darkness(scene: &Scene, plan: &Plan) -> Result<Finished, Refusal> {
    let on_host = true;
    memory::check(scene.size(), memory::needed(scene.size(), on_host))?;
    let mut samples = SampleRanges::default();
    samples.insert(plan.samples.clone())?;
    Ok(Finished {
        summary: Summary::of_darkness(samples.count()),
        film: Film::awaiting(scene.size(), sample_scale(scene), samples),
        ledger: Ledger::default(),
        outcome: Outcome { stop: Stop::Done, elapsed: Duration::ZERO },
        tracer: Description {
            device: "none, the scene has no lights".to_owned(),
            driver: format!("candor {}", env!("CARGO_PKG_VERSION")),
            software: true,
        },
    })
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    device: &'a str,
    driver: &'a str,
    width: u32,
    height: u32,
    spp: u64,
    seconds: f64,
    samples_per_second: Option<f64>,
    relative_error: Option<f64>,
    unproven_pixels: u64,
    coarse_pixels: u64,
    invalid_samples: u64,
    outputs: &'a [PathBuf],
}

impl Finished {
    fn seconds(&self) -> f64 {
        self.outcome.elapsed.as_secs_f64()
    }

    #[expect(clippy::cast_precision_loss, reason = "for show")]
    fn rate(&self) -> Option<f64> {
        let samples = self.summary.samples as f64 * f64::from(self.film.size().pixels());
        (self.seconds() > 0.0).then(|| samples / self.seconds())
    }

    fn provenance(&self, args: &RenderArgs, scene: &Scene) -> Provenance {
        let name = args.common.scene.file_name().unwrap_or_default();
        Provenance {
            scene_file: name.to_string_lossy().into_owned(),
            scene_hash: scene.hash(),
            estimator: scene.settings().estimator().name(),
            bounces: scene.settings().bounces(),
            seed: scene.settings().seed(),
            samples: self.film.samples().clone(),
            scale: self.film.scale(),
            tracer: self.tracer.clone(),
            seconds: self.seconds(),
            invalid_samples: self.ledger.count,
            unproven_pixels: self.summary.unproven_pixels,
            coarse_pixels: self.summary.coarse_pixels,
            relative_error: self.summary.relative_error,
        }
    }

    fn report(&self, args: &RenderArgs, files: &[PathBuf]) -> String {
        if args.common.json {
            return self.json(files);
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
        written.chain(invalid).chain([self.line()]).collect::<Vec<_>>().join("\n")
    }

    fn json(&self, outputs: &[PathBuf]) -> String {
        let json = Json {
            device: &self.tracer.device,
            driver: &self.tracer.driver,
            width: self.film.size().width(),
            height: self.film.size().height(),
            spp: self.summary.samples,
            seconds: self.seconds(),
            samples_per_second: self.rate(),
            relative_error: self.summary.relative_error,
            unproven_pixels: self.summary.unproven_pixels,
            coarse_pixels: self.summary.coarse_pixels,
            invalid_samples: self.ledger.count,
            outputs,
        };
        serde_json::to_string(&json).expect("plain values serialize")
    }

    /// The last line: what was reached, and what the next halving of the error would cost.
    fn line(&self) -> String {
        let stopped = match self.outcome.stop {
            Stop::Done => "done",
            Stop::Time => "time is up",
            Stop::Interrupted => "interrupted",
        };
        let error = self
            .summary
            .relative_error
            .map_or("error unknown".to_owned(), |e| format!("error {:.3} %", 100.0 * e));
        let mut facts = vec![
            error,
            format!("{} spp", self.summary.samples),
            format!("{:.2} s on {}", self.seconds(), self.tracer.device),
            format!("{} invalid samples", self.ledger.count),
            format!("{} unproven pixels", self.summary.unproven_pixels),
        ];
        if self.summary.coarse_pixels > 0 {
            facts.push(format!("{} pixels near the film's step", self.summary.coarse_pixels));
        }
        if self.summary.relative_error.is_some_and(|error| error > 0.0) {
            // The error falls with the square root of the samples: half of it takes four times.
            facts.push(format!("half the error takes {} more", units::time(3.0 * self.seconds())));
        }
        format!("{stopped}: {}", facts.join(", "))
    }
}
