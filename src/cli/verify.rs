//! `candor verify`: this machine's device against the f64 twin.

use super::args::{CommonArgs, DeviceChoice, EstimatorChoice, VerifyArgs};
use super::choose::Chosen;
use super::progress::Reporter;
use super::{
    DONE, FAILED, INTERRUPTED, Refusal, choose, hard, interrupt, memory, refuse, setup, streams,
};
use crate::cpu::CpuTracer;
use crate::film::{Film, SampleRanges};
use crate::range::Arithmetic;
use crate::render::{Audience, Begun, Plan, Stop, render};
use crate::scene::Scene;
use crate::tracer::{Description, Tracer};
use crate::verify::{ALPHA, MAX_BIAS, Verdict, judge};
use serde::Serialize;
use std::sync::atomic::AtomicBool;

pub(super) fn run(args: &VerifyArgs) -> Result<u8, Refusal> {
    let common = &args.common;
    if args.sampling.estimator == Some(EstimatorChoice::Auto) {
        return refuse("verify checks one estimator; --estimator auto is for render");
    }
    let Some(file) = args.scene.as_ref().filter(|_| !args.hard) else {
        return hard::run(args);
    };
    let (scene, source) = setup::load(file, common, &args.sampling)?;
    let spp = scene.settings().spp();
    if spp < 2 {
        return refuse("verify needs at least 2 samples per pixel");
    }
    if !scene.has_lights() {
        return refuse("the scene has no lights: it is black everywhere, with nothing to compare");
    }
    let (chosen, device) = device(common)?;
    setup::check_range(&scene, &source, &[Arithmetic::Single, Arithmetic::Double])?;
    memory::check(scene.size(), 3 * memory::needed(&scene, 2))?;
    let other_seed = scene.settings().with_seed(scene.settings().seed().wrapping_add(1));
    let other_scene = scene.clone().with_settings(other_seed);
    let run = Run { interrupt: interrupt::watch()?, quiet: common.quiet, spp };
    let films = [
        run.film("device", &scene, chosen.tracer(&scene)?)?,
        run.film("twin", &scene, Box::new(CpuTracer::new(&scene, common.threads)?))?,
        run.film("device, other seed", &other_scene, chosen.tracer(&other_scene)?)?,
    ];
    let [Some(ours), Some(twin), Some(other)] = films else {
        streams::message("interrupted: there is no verdict on a part of the samples");
        return Ok(INTERRUPTED);
    };
    let invalid = ours.invalid + twin.invalid + other.invalid;
    let verdict = judge(&ours.film, &twin.film, &other.film);
    streams::results(&report(&verdict, invalid, &device, spp, common.json))?;
    Ok(if verdict.agrees() && invalid == 0 { DONE } else { FAILED })
}

/// The device that is checked.
pub(super) fn device(args: &CommonArgs) -> Result<(Chosen, Description), Refusal> {
    if args.device == DeviceChoice::Cpu {
        return refuse(
            "verify compares a device with the CPU twin; --device cpu is the twin itself",
        );
    }
    let chosen = choose::choose(&args.device, args.threads)?;
    match chosen.adapter() {
        Some(device) => Ok((chosen, device)),
        None => refuse(format_args!(
            "verify compares a device with the CPU twin, and there is no device here; {}",
            choose::INSTALL_DRIVER
        )),
    }
}

struct Run<'a> {
    interrupt: &'a AtomicBool,
    quiet: bool,
    spp: u64,
}

impl Run<'_> {
    /// Traces all samples; nothing where the user interrupted.
    fn film(
        &self,
        what: &str,
        scene: &Scene,
        mut tracer: Box<dyn Tracer>,
    ) -> Result<Option<Traced>, Refusal> {
        let plan = Plan {
            begun: Begun::default(),
            ranges: SampleRanges::default().missing(&(0..self.spp)),
            time: None,
            target_error: None,
        };
        let mut reporter = Reporter::new(self.quiet, scene.size().pixels(), &plan);
        reporter.message(&format!("{what}: {}", tracer.describe().device));
        let mut observe = |progress: &_, _: &mut dyn Tracer| {
            reporter.observe(progress);
            Ok(())
        };
        let audience = Audience::Nobody;
        let outcome = render(tracer.as_mut(), &plan, self.interrupt, audience, &mut observe);
        reporter.finish();
        if outcome?.stop == Stop::Interrupted {
            return Ok(None);
        }
        Ok(Some(Traced { film: tracer.film()?, invalid: tracer.ledger()?.count }))
    }
}

/// What came of one tracer's samples.
struct Traced {
    film: Film,
    /// How many were invalid.
    invalid: u64,
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    device: &'a str,
    driver: &'a str,
    spp: u64,
    agrees: bool,
    invalid_samples: u64,
    conclusive: bool,
    image_z: f64,
    image_p: f64,
    tiles: usize,
    worst_tile_z: f64,
    worst_tile_p: f64,
    mean_tile_z: f64,
    rms_tile_z: f64,
    bias: [f64; 3],
    bias_error: [f64; 3],
}

fn report(verdict: &Verdict, invalid: u64, device: &Description, spp: u64, json: bool) -> String {
    let found = &verdict.independent;
    if json {
        let json = Json {
            device: &device.device,
            driver: &device.driver,
            spp,
            agrees: verdict.agrees() && invalid == 0,
            invalid_samples: invalid,
            conclusive: found.conclusive,
            image_z: found.image.z,
            image_p: found.image.p,
            tiles: found.tiles,
            worst_tile_z: found.worst.z,
            worst_tile_p: found.worst.p,
            mean_tile_z: found.mean_z,
            rms_tile_z: found.rms_z,
            bias: verdict.paired.bias,
            bias_error: verdict.paired.error,
        };
        return serde_json::to_string(&json).expect("plain values serialize");
    }
    let [r, g, b] = std::array::from_fn(|c| {
        let (bias, error) = (verdict.paired.bias[c], verdict.paired.error[c]);
        format!("{:+.5} ± {:.5} %", 100.0 * bias, 100.0 * error)
    });
    let reading = if invalid > 0 {
        format!("INVALID SAMPLES: {invalid}; candor render names the first of them")
    } else if verdict.agrees() {
        "the device agrees with the twin".to_owned()
    } else if verdict.disagrees() {
        format!(
            "THE DEVICE DISAGREES (family-wise {ALPHA:e}, bias limit {:.1} %)",
            100.0 * MAX_BIAS
        )
    } else if found.conclusive {
        format!("not sure to {:.1} % of bias; use more --spp", 100.0 * MAX_BIAS)
    } else {
        "too few hits to tell; use more --spp".to_owned()
    };
    [
        format!("device    {} ({})", device.device, device.driver),
        format!("samples   {spp} per pixel; deviations in standard errors, device - twin"),
        format!("image     z {:+.2}, p {:.2e}", found.image.z, found.image.p),
        format!("tiles     largest z {:+.2}, p {:.2e}", found.worst.z, found.worst.p),
        format!(
            "          mean z {:+.3}, rms z {:.3}, tiles: {}",
            found.mean_z, found.rms_z, found.tiles
        ),
        format!("bias      r {r}, g {g}, b {b} (same random numbers)"),
        format!("verdict   {reading}"),
    ]
    .join("\n")
}
