//! `candor explain`: which effects the scene calls for, what was left out, what that saves.

use super::args::{DeviceChoice, EstimatorChoice, ExplainArgs, SamplingArgs};
use super::choose::{self, Chosen};
use super::steps::Steps;
use super::{DONE, FAILED, INTERRUPTED, Refusal, explain_table, interrupt, refuse, setup, streams};
use crate::explain::{Agreement, ExplainError, Explanation, Measured, Step, Version, measure};
use crate::gpu::Adapter;
use crate::kernel::spirv;
use crate::range::Arithmetic;
use crate::scene::{Scene, Source};
use crate::tracer::Description;
use crate::viewpoint::Viewpoint;
use crate::watch::Watch;
use serde::Serialize;
use std::io::IsTerminal;

pub(super) fn run(args: &ExplainArgs) -> Result<u8, Refusal> {
    if args.estimator == Some(EstimatorChoice::Auto) {
        return refuse("explain shows one estimator's kernel; --estimator auto is for render");
    }
    let sampling = SamplingArgs { spp: None, estimator: args.estimator };
    let (scene, source) = setup::load(&args.scene, &args.common, &sampling)?;
    if args.wgsl || args.spirv {
        return print_kernel(&scene, args.spirv);
    }
    let chosen = if scene.has_lights() {
        Some(choose::choose(&args.common.device, args.common.threads)?)
    } else {
        None
    };
    let viewpoint = Viewpoint::of(&scene);
    let versions = [Version::specialised(&scene, &viewpoint), Version::general(&scene, &viewpoint)];
    let explanation =
        Explanation::of(&scene, &viewpoint, &versions[0], &versions[1]).or_else(mistake)?;
    let measurement = match &chosen {
        Some(Chosen::Adapter(adapter)) => {
            match measured(args, &scene, &source, [&versions[0], &versions[1]], adapter) {
                Err(Stopped::Interrupted) => return Ok(INTERRUPTED),
                Err(Stopped::Refused(refusal)) => return Err(refusal),
                Ok(measured) => Measurement::Made(adapter.describe(), Box::new(measured)),
            }
        }
        Some(Chosen::Twin(_)) if args.common.device == DeviceChoice::Cpu => {
            Measurement::None("the CPU twin has no kernel")
        }
        Some(Chosen::Twin(_)) => Measurement::None("no Vulkan, Metal or DX12 device opens here"),
        None => Measurement::None(
            "the scene has no lights: the picture is black everywhere, and no kernel is run",
        ),
    };
    let explained =
        Explained { file: args.scene.display().to_string(), scene, explanation, measurement };
    let report = if args.common.json { json(&explained) } else { explain_table::text(&explained) };
    streams::results(&report)?;
    Ok(if explained.measurement.is_sound() { DONE } else { FAILED })
}

/// Everything that is said of a scene.
pub(super) struct Explained {
    pub file: String,
    pub scene: Scene,
    pub explanation: Explanation,
    pub measurement: Measurement,
}

/// What was measured, or why nothing was.
pub(super) enum Measurement {
    Made(Description, Box<Measured>),
    None(&'static str),
}

impl Measurement {
    /// Whether both kernels made the same film, of valid samples alone.
    fn is_sound(&self) -> bool {
        match self {
            Self::Made(_, made) => {
                made.films != Agreement::Differ && made.invalid_samples == [0, 0]
            }
            Self::None(_) => true,
        }
    }
}

fn mistake<T>(message: impl std::fmt::Display) -> Result<T, Refusal> {
    refuse(format_args!("this is a mistake in candor: naga refuses the kernel: {message}"))
}

/// The kernel itself and nothing else.
fn print_kernel(scene: &Scene, binary: bool) -> Result<u8, Refusal> {
    let wgsl = Version::specialised(scene, &Viewpoint::of(scene)).kernel.wgsl();
    if !binary {
        streams::results(wgsl.trim_end())?;
    } else if std::io::stdout().is_terminal() {
        return refuse(
            "SPIR-V is binary and this is a terminal; write it to a file (--spirv > kernel.spv) \
             or into a disassembler (--spirv | spirv-dis)",
        );
    } else {
        let words = spirv(&wgsl).or_else(mistake)?;
        streams::binary(bytemuck::cast_slice(&words))?;
    }
    Ok(DONE)
}

enum Stopped {
    Refused(Refusal),
    Interrupted,
}

impl<E: Into<Refusal>> From<E> for Stopped {
    fn from(refusal: E) -> Self {
        Self::Refused(refusal.into())
    }
}

fn measured(
    args: &ExplainArgs,
    scene: &Scene,
    source: &Source,
    versions: [&Version; 2],
    adapter: &Adapter,
) -> Result<Measured, Stopped> {
    setup::check_range(scene, source, &[Arithmetic::Single])?;
    let mut steps = Steps::new(args.common.quiet, Step::name);
    let interrupt = interrupt::watch()?;
    let mut watch = Watch { interrupt, observe: &mut |progress| steps.observe(progress) };
    let measured = measure(scene, versions, adapter, &mut watch);
    steps.finish();
    match measured {
        Err(ExplainError::Interrupted) => Err(Stopped::Interrupted),
        measured => Ok(measured?),
    }
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    scene: &'a str,
    width: u32,
    height: u32,
    estimator: &'static str,
    bounces: u32,
    #[serde(flatten)]
    explanation: &'a Explanation,
    device: Option<&'a str>,
    driver: Option<&'a str>,
    /// Why nothing was measured.
    not_measured: Option<&'static str>,
    measured: Option<&'a Measured>,
}

fn json(explained: &Explained) -> String {
    let (tracer, measured, not_measured) = match &explained.measurement {
        Measurement::Made(tracer, measured) => (Some(tracer), Some(measured.as_ref()), None),
        Measurement::None(why) => (None, None, Some(*why)),
    };
    let settings = explained.scene.settings();
    let json = Json {
        scene: &explained.file,
        width: explained.scene.size().width(),
        height: explained.scene.size().height(),
        estimator: settings.estimator().name(),
        bounces: settings.bounces(),
        explanation: &explained.explanation,
        device: tracer.map(|tracer| tracer.device.as_str()),
        driver: tracer.map(|tracer| tracer.driver.as_str()),
        not_measured,
        measured,
    };
    serde_json::to_string(&json).expect("plain values serialize")
}
