//! Nanoseconds of one sample of a whole render, with kernels that differ in one thing.

use crate::functions::{Measured, Worst, short};
use crate::hits::{LEAST_COSINE, RADII, Table, textbook};
use crate::options::{open, root};
use crate::turns::{self, Measure, Middle, above};
use crate::wgsl::with_body;
use candor::bound::sample_scale;
use candor::cpu::CpuTracer;
use candor::effects::{Effect, Effects};
use candor::gpu::{Adapter, GpuTracer};
use candor::kernel::{Kernel, KernelUnits, Packed, layout, pack};
use candor::scene::{Estimator, Scene, parse};
use candor::tracer::Tracer;
use candor::viewpoint::{Form, Viewpoint};
use glam::DVec3;
use std::time::Instant;

/// Samples per pixel of one measurement on the device, and on the twin.
const SPP: u64 = 16;
const TWIN_SPP: u64 = 4;

/// One kernel, or the twin.
struct Rung {
    name: &'static str,
    tracer: Box<dyn Tracer>,
    spp: u64,
    pixels: f64,
}

impl Rung {
    fn new(name: &'static str, tracer: impl Tracer + 'static, scene: &Scene, spp: u64) -> Self {
        let pixels = f64::from(scene.size().pixels());
        let mut rung = Self { name, tracer: Box::new(tracer), spp, pixels };
        // The first dispatches compile the kernel and find the device's pace.
        rung.nanoseconds(1 << 20);
        rung
    }

    #[expect(clippy::cast_precision_loss, reason = "a few samples")]
    fn nanoseconds(&mut self, round: u64) -> f64 {
        let started = Instant::now();
        let first = round * self.spp;
        self.tracer.add_samples(first..first + self.spp).expect("samples");
        started.elapsed().as_secs_f64() * 1e9 / self.pixels / self.spp as f64
    }
}

/// Measures the rungs in turns: their times, round by round.
fn times(rounds: u64, rungs: &mut [Rung]) -> Vec<Vec<f64>> {
    let mut rows: Vec<Measure> =
        rungs.iter_mut().map(|rung| Box::new(|round| rung.nanoseconds(round)) as Measure).collect();
    turns::take(rounds, &mut rows)
}

/// The classic scene with walls of another radius, where the walls stay.
fn classic(radius: f64) -> Scene {
    let path = root().join("scenes/two-spheres.toml");
    let mut text = std::fs::read_to_string(path).expect("the classic scene");
    for wall in [0.0, 3.0, 4.0] {
        text = text.replace(&format!("{:?}", 1e5 + wall), &format!("{:?}", radius + wall));
    }
    parse("classic", &text).expect("a valid scene")
}

fn packed(scene: &Scene) -> (Packed, String) {
    let viewpoint = Viewpoint::of(scene);
    let effects = Effects::of(scene, &viewpoint);
    let packed = pack(scene, &viewpoint, effects, sample_scale(scene));
    let wgsl = Kernel::of(scene, effects, &packed).wgsl();
    (packed, wgsl)
}

/// A function and another body for it.
type Body = (&'static str, &'static str);

const SINCOS: &[Body] =
    &[("sincos_2pi", "return vec2<f32>(sin(6.283185307179586 * u), cos(6.283185307179586 * u));")];

/// The lobe as course texts write it, and its density by WGSL's log and exp.
const LOBE: &[Body] = &[
    (
        "polar_phong",
        "let cosine = pow(1.0 - u, 1.0 / (exponent + 1.0));
    return vec2<f32>(sqrt(max(1.0 - cosine * cosine, 0.0)), cosine);",
    ),
    ("minus_log_complement", "return -log(1.0 - u);"),
    ("exp_minus", "return exp(-x);"),
];

/// The kernel with WGSL's functions in place of its own, and what they are off by.
fn measure_estimator(adapter: &Adapter, rounds: u64, estimator: Estimator, errors: &[Measured]) {
    let scene = classic(1e5);
    let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
    let (packed, kernel) = packed(&scene);
    let rung = |name, bodies: &[&[Body]]| {
        let wgsl = bodies
            .iter()
            .copied()
            .flatten()
            .fold(kernel.clone(), |wgsl, (function, body)| with_body(&wgsl, function, body));
        let tracer = GpuTracer::with_kernel(&scene, open(adapter), &packed, &wgsl);
        Rung::new(name, tracer.expect("the device takes the kernel"), &scene, SPP)
    };
    let mut rungs = [
        rung("WGSL's", &[SINCOS, LOBE]),
        rung("own sin, cos", &[LOBE]),
        rung("own lobe", &[SINCOS]),
        rung("all own (the kernel)", &[]),
    ];
    let times = times(rounds, &mut rungs);
    let circle = error_of(errors, "sin 2πu", |worst| worst.absolute);
    let lobe = error_of(errors, "1-cosα, n = 1e2", |worst| worst.relative);
    println!("Nanoseconds per sample, two-spheres.toml, {}, and errors in 2^-24", estimator.name());
    println!(
        "{:24} {:>12} {:>12} {:>23} {:>25}",
        "", "sin 2πu, abs", "lobe, rel", "", "above the first"
    );
    let own = [[false, false], [true, false], [false, true], [true, true]];
    for ((rung, row), own) in rungs.iter().zip(&times).zip(own) {
        let [circle, lobe] = [&circle[usize::from(own[0])], &lobe[usize::from(own[1])]];
        println!(
            "{:24} {circle:>12} {lobe:>12} {:>23}{}",
            rung.name,
            Middle::of(row),
            above(row, &times[0])
        );
    }
    println!();
}

/// The error of WGSL's way and of the kernel's.
fn error_of(errors: &[Measured], name: &str, of: impl Fn(&Worst) -> f64) -> [String; 2] {
    let found = errors.iter().find(|m| m.function.name == name).expect("it was measured");
    let own = found.own.expect("the kernel has its own");
    [short(of(&found.built_in)), short(of(&own))]
}

pub fn measure_functions(adapter: &Adapter, rounds: u64, errors: &[Measured]) {
    measure_estimator(adapter, rounds, Estimator::Implicit, errors);
    measure_estimator(adapter, rounds, Estimator::Mis, errors);
}

/// The packed scene with every sphere by centre and radius, in the order of the file.
fn by_centre(scene: &Scene, packed: &Packed) -> Packed {
    let units = KernelUnits::of(&Viewpoint::of(scene));
    let mut centred = packed.clone();
    for (place, sphere) in scene.spheres().iter().enumerate() {
        let mut old = packed.spheres.iter();
        let old = old.find(|old| old.index as usize == place).expect("every sphere is packed");
        centred.spheres[place] = layout::Sphere {
            position: floats(units.point(sphere.center())),
            size: floats(DVec3::splat(units.length(sphere.radius())))[0],
            offset: 0.0,
            ..*old
        };
    }
    centred.scene.factored_count = centred.scene.sphere_count;
    centred.forms.fill(Form::Factored);
    // The lamp is the first sphere of the file, here as in the packed scene.
    assert_eq!(centred.spheres[0].kind, layout::KIND_EMITTER);
    centred
}

fn floats(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// The ladder of hits, walls of radius 100, with which every form is right: ns per sample
/// of each form, and per ray and sphere; beside them, how far off their hits are.
pub fn measure_forms(adapter: &Adapter, rounds: u64, errors: &Table) {
    let scene = classic(1e2);
    let (packed, kernel) = packed(&scene);
    let centred = by_centre(&scene, &packed);
    let effects = Effects::of(&scene, &Viewpoint::of(&scene)).without(Effect::Anchored);
    let factored = Kernel::of(&scene, effects, &centred).wgsl();
    let rung = |name, packed: &Packed, wgsl: &str| {
        let tracer = GpuTracer::with_kernel(&scene, open(adapter), packed, wgsl);
        Rung::new(name, tracer.expect("the device takes the kernel"), &scene, SPP)
    };
    let twin = CpuTracer::new(&scene, None).expect("threads");
    let mut rungs = [
        rung("textbook", &centred, &textbook(&factored)),
        rung("factored", &centred, &factored),
        rung("anchored (walls; kernel)", &packed, &kernel),
        Rung::new("f64 on the CPU (twin)", twin, &scene, TWIN_SPP),
    ];
    let times = times(rounds, &mut rungs);
    println!(
        "Worst distance of a hit from the sphere that was meant (points up to 8 from the focus"
    );
    println!(
        "along each axis, rays of up to 16, cosines from {LEAST_COSINE}), and nanoseconds per sample,"
    );
    println!("two-spheres.toml with walls of radius 100, implicit");
    let radii = RADII.map(|radius| format!("{:>10}", format!("R = {radius:.0e}"))).concat();
    println!("{:24} {radii} {:>24} {:>25}", "", "", "above the first");
    for ((rung, row), off) in rungs.iter().zip(&times).zip(errors) {
        let off = off.map(|off| format!("{off:>10.1e}")).concat();
        println!("{:24} {off} {:>24}{}", rung.name, Middle::of(row), above(row, &times[0]));
    }
    println!();
}
