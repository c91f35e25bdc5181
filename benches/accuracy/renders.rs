//! Nanoseconds of one sample of a whole render, with kernels that differ in one thing.

use crate::hits::textbook;
use crate::options::{open, root};
use crate::turns::{self, Measure, Middle};
use crate::wgsl::with_body;
use candor::bound::sample_scale;
use candor::cpu::CpuTracer;
use candor::gpu::{Adapter, GpuTracer};
use candor::kernel::{Form, Kernel, KernelUnits, Packed, layout, pack};
use candor::scene::{Estimator, Scene, parse};
use candor::tracer::Tracer;
use candor::viewpoint::Viewpoint;
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

/// Measures the rungs in turns and prints what each takes above the first.
fn print(title: &str, rounds: u64, rungs: &mut [Rung]) {
    let mut rows: Vec<Measure> =
        rungs.iter_mut().map(|rung| Box::new(|round| rung.nanoseconds(round)) as Measure).collect();
    let times = turns::take(rounds, &mut rows);
    drop(rows);
    println!("Nanoseconds per sample, {title}; above the first");
    for (rung, row) in std::iter::zip(rungs.iter(), &times) {
        let extra = turns::extra(row, &times[0]);
        let verdict = if rung.name == rungs[0].name { "" } else { extra.verdict() };
        println!("{:32} {:>23} {extra:>24} {verdict}", rung.name, Middle::of(row));
    }
    println!();
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
    let packed = pack(scene, &viewpoint, sample_scale(scene)).expect("few spheres");
    let wgsl = Kernel::of(scene, &viewpoint, &packed).wgsl();
    (packed, wgsl)
}

const SINCOS: (&str, &str) =
    ("sincos_2pi", "return vec2<f32>(sin(6.283185307179586 * u), cos(6.283185307179586 * u));");
const LOG: (&str, &str) = ("minus_log_complement", "return -log(1.0 - u);");
const FRACTION: (&str, &str) = ("one_minus_exp_minus", "return 1.0 - exp(-x);");
const EXP: (&str, &str) = ("exp_minus", "return exp(-x);");
/// The lobe as course texts write it.
const POWER: (&str, &str) = (
    "polar_phong",
    "let cosine = pow(1.0 - u, 1.0 / (exponent + 1.0));
    return vec2<f32>(sqrt(max(1.0 - cosine * cosine, 0.0)), cosine);",
);

/// The kernel with WGSL's functions in place of its own.
fn measure_estimator(adapter: &Adapter, rounds: u64, estimator: Estimator) {
    let scene = classic(1e5);
    let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
    let (packed, kernel) = packed(&scene);
    let rung = |name, bodies: &[(&str, &str)]| {
        let wgsl = bodies.iter().fold(kernel.clone(), |wgsl, (f, body)| with_body(&wgsl, f, body));
        let tracer = GpuTracer::with_kernel(&scene, open(adapter), &packed.scene, &wgsl);
        Rung::new(name, tracer.expect("the device takes the kernel"), &scene, SPP)
    };
    let mut rungs = [
        rung("all built-in, lobe by pow", &[SINCOS, LOG, FRACTION, EXP, POWER]),
        rung("all built-in", &[SINCOS, LOG, FRACTION, EXP]),
        rung("own sin, cos", &[LOG, FRACTION, EXP]),
        rung("own log, 1-exp, exp", &[SINCOS]),
        rung("all own (the kernel)", &[]),
    ];
    let title = format!("two-spheres.toml, {}", estimator.name());
    print(&title, rounds, &mut rungs);
}

pub fn measure_functions(adapter: &Adapter, rounds: u64) {
    measure_estimator(adapter, rounds, Estimator::Implicit);
    measure_estimator(adapter, rounds, Estimator::Mis);
}

/// The packed scene with every sphere by centre and radius, in the order of the file.
fn by_centre(scene: &Scene, packed: &Packed) -> Packed {
    let units = KernelUnits::of(&Viewpoint::of(scene));
    let mut centred = packed.clone();
    for (place, sphere) in scene.spheres().iter().enumerate() {
        let mut old = packed.scene.spheres.iter();
        let old = old.find(|old| old.index as usize == place).expect("every sphere is packed");
        centred.scene.spheres[place] = layout::Sphere {
            position: floats(units.point(sphere.center())),
            size: floats(DVec3::splat(units.length(sphere.radius())))[0],
            offset: 0.0,
            ..*old
        };
    }
    centred.scene.factored_count = centred.scene.sphere_count;
    centred.forms.fill(Form::Factored);
    // The lamp is the first sphere of the file, here as in the packed scene.
    assert_eq!(centred.scene.spheres[0].kind, layout::KIND_EMITTER);
    centred
}

fn floats(v: DVec3) -> [f32; 3] {
    v.as_vec3().to_array()
}

/// The ladder of hits: walls of radius 100, with which every form is right.
pub fn measure_forms(adapter: &Adapter, rounds: u64) {
    let scene = classic(1e2);
    let (packed, kernel) = packed(&scene);
    let centred = by_centre(&scene, &packed);
    let factored = Kernel::of(&scene, &Viewpoint::of(&scene), &centred).wgsl();
    let rung = |name, packed: &Packed, wgsl: &str| {
        let tracer = GpuTracer::with_kernel(&scene, open(adapter), &packed.scene, wgsl);
        Rung::new(name, tracer.expect("the device takes the kernel"), &scene, SPP)
    };
    let twin = CpuTracer::new(&scene, None).expect("threads");
    let mut rungs = [
        rung("textbook", &centred, &textbook(&factored)),
        rung("factored", &centred, &factored),
        rung("walls anchored (the kernel)", &packed, &kernel),
        Rung::new("f64 on the CPU (the twin)", twin, &scene, TWIN_SPP),
    ];
    let title = "two-spheres.toml with walls of radius 100, implicit";
    print(title, rounds, &mut rungs);
}
