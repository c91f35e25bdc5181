//! `candor cost`: what accuracy costs in time on this device.

use super::args::{CostArgs, DeviceChoice, EstimatorChoice, SamplingArgs};
use super::choose::Chosen;
use super::steps::Steps;
use super::{
    DONE, INTERRUPTED, Refusal, choose, cost_table, interrupt, memory, refuse, setup, streams,
    units,
};
use crate::cost::{
    CostError, Phase, Plan, Study, Tracers, Watch, bytes_per_pixel, resolvable, study,
};
use crate::cpu::CpuTracer;
use crate::range::Arithmetic;
use crate::report::cost::{CostReport, check_folder};
use crate::scene::Scene;
use crate::tracer::{Description, TraceError, Tracer};
use serde::Serialize;
use std::path::PathBuf;

pub(super) fn run(args: &CostArgs) -> Result<u8, Refusal> {
    let common = &args.common;
    // No estimator is named: each is checked on its own.
    let every = SamplingArgs { estimator: Some(EstimatorChoice::Auto), ..SamplingArgs::default() };
    let (scene, source) = setup::load(&args.scene, common, &every)?;
    if !scene.has_lights() {
        return refuse("the scene has no lights: it is black everywhere, at no cost");
    }
    let scene = resolvable(scene)?;
    check_folder(&args.output)?;
    let needed = u64::from(scene.size().pixels()) * bytes_per_pixel();
    memory::check(scene.size(), needed)?;
    let chosen = choose::choose(&common.device, common.threads)?;
    setup::check_range(&scene, &source, &[chosen.arithmetic(), Arithmetic::Double])?;
    let mut phases = Steps::new(common.quiet, Phase::name);
    if common.device == DeviceChoice::Auto && chosen.adapter().is_none() {
        phases.message("no Vulkan, Metal or DX12 device opens here; the CPU twin takes over");
    }
    let description = chosen.describe(&scene)?;
    phases.message(&planned(&args.budget, &description.device));
    phases.message(&format!("needs up to {} of memory", units::bytes(needed)));
    let measured = measure(args, &scene, &chosen, &mut phases);
    phases.finish();
    let measured = match measured {
        Err(CostError::Interrupted) => return Ok(INTERRUPTED),
        measured => measured?,
    };
    interrupt::writing_begins();
    let name = args.scene.file_name().unwrap_or_default().to_string_lossy();
    let report = CostReport { scene: &name, tracer: &description, study: &measured };
    let written = report.write(&args.output);
    // In the current folder, files are called by their bare names.
    let bare = |file: &PathBuf| file.strip_prefix(".").unwrap_or(file).to_owned();
    let files: Vec<PathBuf> = written.iter().flatten().map(bare).collect();
    // What was measured is not lost where the files cannot be written.
    let results = if common.json { json(&report, &files) } else { text(&report, &files) };
    streams::results(&results)?;
    written?;
    Ok(if measured.interrupted { INTERRUPTED } else { DONE })
}

/// Says what is planned.
fn planned(plan: &Plan, device: &str) -> String {
    let phases = Phase::ALL
        .map(|phase| format!("{} {}", phase.name(), units::time(plan.length(phase).as_secs_f64())));
    format!("planned on {device}: {}", phases.join(", "))
}

fn measure(
    args: &CostArgs,
    scene: &Scene,
    chosen: &Chosen,
    phases: &mut Steps<Phase>,
) -> Result<Study, CostError> {
    let interrupt = interrupt::watch()
        .map_err(|error| TraceError::Device(format!("cannot listen for Ctrl-C: {error}")))?;
    let device = |scene: &Scene| chosen.tracer(scene);
    let twin = |scene: &Scene| -> Result<Box<dyn Tracer>, TraceError> {
        Ok(Box::new(CpuTracer::new(scene, args.common.threads)?))
    };
    let tracers = Tracers {
        device: &device,
        twin: if chosen.adapter().is_some() { Some(&twin) } else { None },
    };
    let mut observe = |progress| phases.observe(progress);
    study(scene, tracers, &args.budget, &mut Watch { interrupt, observe: &mut observe })
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    device: &'a str,
    driver: &'a str,
    #[serde(flatten)]
    study: &'a Study,
    outputs: &'a [PathBuf],
}

fn json(report: &CostReport, outputs: &[PathBuf]) -> String {
    let Description { device, driver, .. } = report.tracer;
    serde_json::to_string(&Json { device, driver, study: report.study, outputs })
        .expect("plain values serialize")
}

fn text(report: &CostReport, files: &[PathBuf]) -> String {
    let mut parts: Vec<String> =
        files.iter().map(|file| format!("wrote {}", file.display())).collect();
    if !files.is_empty() {
        parts.push(String::new());
    }
    parts.push(cost_table::tables(report));
    parts.join("\n")
}
