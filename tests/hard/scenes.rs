//! Cases that are a scene under `scenes/hard`: what the scene must show, and a change to
//! the kernel's text that must not go unnoticed.

use crate::support::closed_form::{integrating_sphere, lobe_albedo, sphere_form_factor};
use crate::support::judge::{Estimate, Quantity, detectable, deviation, is_exactly, limit};
use crate::support::tracers::{kernel, trace, twin, with_kernel};
use crate::{Line, Verdict};
use candor::estimate::pair;
use candor::gpu::GpuTracer;
use candor::scene::Estimator::{self, Cosine, Explicit, Implicit, Mis};
use candor::scene::{Scene, load, parse};
use candor::verify::{ALPHA, MAX_BIAS};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// What a scene must show.
#[derive(Clone, Copy)]
enum Expected {
    /// Every sample of every pixel is this; N counts all of them.
    Exactly([f32; 3]),
    /// The mean of all samples: its closed form, the relative error that rounding adds, and
    /// the relative error that must not go unnoticed.
    Mean { truth: f64, bias: f64, effect: f64 },
    /// The twin's picture of the same samples, within `verify`'s bias.
    Twin,
}

/// A scene file, how it is traced, and what is wrong on purpose: what stands in the kernel,
/// and what takes its place.
struct Case {
    number: u32,
    file: &'static str,
    estimator: Estimator,
    samples: u64,
    expected: Expected,
    fault: (&'static str, &'static str, &'static str),
}

/// Relative error of `f32` directions and normals where the surface faces the eye, a few
/// units of 6e-8; seen from θ it is as much larger as cosθ is smaller.
const BIAS: f64 = 1e-6;

const COSINE_OF_LIGHTS: (&str, &str, &str) = (
    "light under the horizon counts",
    "2.0 * max(dot(normal, direction), 0.0)",
    "2.0 * abs(dot(normal, direction))",
);
const COSINE_OF_LOBES: (&str, &str, &str) = (
    "lobe under the horizon counts",
    "max(dot(normal, direction), 0.0)",
    "abs(dot(normal, direction))",
);
const MIRROR: (&str, &str, &str) =
    ("mirror direction off", "incoming - 2.0 * dot", "incoming - 1.9 * dot");
const SIDE: (&str, &str, &str) =
    ("normal of the wrong side", "select(outward, -outward,", "select(-outward, outward,");
const LAST: (&str, &str, &str) =
    ("the last of equal distances", "t < best.distance", "t <= best.distance");
const RADIANCE_AT_START: (&str, &str, &str) = (
    "a path starts with radiance",
    "NO_SPHERE, vec3<f32>(0.0), false",
    "NO_SPHERE, vec3<f32>(0.5), false",
);

fn form_factor(brightness: f64, degrees: f64, h: f64) -> Expected {
    let truth = brightness * sphere_form_factor(degrees.to_radians(), h);
    Expected::Mean { truth, bias: BIAS, effect: 0.02 }
}

fn lobe(brightness: f64, degrees: f64, n: f64) -> Expected {
    let theta = degrees.to_radians();
    // The eye's own width, half of 1e-6 degrees, and the rounding, under the angle.
    let bias = BIAS / theta.cos();
    Expected::Mean { truth: brightness * lobe_albedo(theta, n), bias, effect: 0.02 + bias }
}

fn mean(truth: f64) -> Expected {
    Expected::Mean { truth, bias: BIAS, effect: 0.01 }
}

fn walls() -> impl Iterator<Item = Case> {
    let files = [
        "02-wall-1e3",
        "02-wall-1e4",
        "02-wall-1e5",
        "02-wall-1e6",
        "02-wall-1e7",
        "02-wall-1e8",
        "02-wall-1e9",
    ];
    files.into_iter().map(|file| Case {
        number: 2,
        file,
        estimator: Mis,
        samples: 128,
        expected: form_factor(7.5, 45.0, 2.0),
        fault: ("the wall's offset halved", "ray.origin) + 2.0 * offset;", "ray.origin) + offset;"),
    })
}

fn case(
    number: u32,
    file: &'static str,
    estimator: Estimator,
    samples: u64,
    expected: Expected,
    fault: (&'static str, &'static str, &'static str),
) -> Case {
    Case { number, file, estimator, samples, expected, fault }
}

/// Where nothing is random.
fn exact() -> Vec<Case> {
    let exactly =
        |number, file, rgb, fault| case(number, file, Implicit, 64, Expected::Exactly(rgb), fault);
    // 32·32 pixels, three segments a path: 1e7 rays.
    let corner = Case {
        samples: 3300,
        ..exactly(
            4,
            "04-room-corner",
            [0.0; 3],
            ("hits must lie ahead", "q.b < 0.0 && q.disc", "q.c > 0.0 && q.b < 0.0 && q.disc"),
        )
    };
    vec![
        corner,
        exactly(
            8,
            "08-on-the-surface-outward",
            [1.0, 2.0, 3.0],
            ("rays that head away hit", "q.b < 0.0 && q.disc", "q.disc"),
        ),
        exactly(
            8,
            "08-on-the-surface-inward",
            [4.0, 5.0, 6.0],
            ("near root from inside", "(root - q.b) / q.leading", "(root + q.b) / q.leading"),
        ),
        exactly(
            10,
            "10-inside-a-lamp",
            [10.0; 3],
            ("near root from inside", "select(outer, exit(q, leaves),", "select(outer, outer,"),
        ),
        exactly(
            11,
            "11-lamp-fills-the-view",
            [10.0; 3],
            ("luminance of 1 - 2^-16", "46871u, 4732u", "46871u, 4731u"),
        ),
        exactly(12, "12-coincident-lamp-first", [3.0; 3], LAST),
        exactly(
            13,
            "13-concentric-shells",
            [1.0, 2.0, 3.0],
            ("an epsilon between hits", "t < best.distance;", "t < best.distance + 1.0e-3;"),
        ),
        exactly(
            22,
            "22-albedo-zero",
            [0.0; 3],
            ("albedo of 1 % and more", "weight * color", "weight * max(color, vec3<f32>(0.01))"),
        ),
        exactly(22, "22-no-lights", [0.0; 3], RADIANCE_AT_START),
        exactly(22, "22-no-spheres", [0.0; 3], RADIANCE_AT_START),
        Case { estimator: Explicit, ..exactly(24, "24-lamp-set", [0.0; 3], COSINE_OF_LIGHTS) },
    ]
}

/// Where a closed form exists.
fn closed() -> Vec<Case> {
    let tiny = |estimator| {
        // The cone is as wide as 1e-4 is seen through coordinates of up to 100: BIAS of it.
        let expected = form_factor(5.0, 30.0, 1e6);
        let fault = (
            "1 - cosine of the half angle",
            "min(sine2, 1.0) / (1.0 + sqrt(max(cosine2, 0.0)))",
            "1.0 - sqrt(max(cosine2, 0.0))",
        );
        case(5, "05-tiny-lamp", estimator, 64, expected, fault)
    };
    let hair = |estimator| {
        let fault = ("axis away from the lamp", "g * -inverseSqrt(g2)", "g * inverseSqrt(g2)");
        case(7, "07-lamp-at-a-hair", estimator, 256, form_factor(5.0, 0.0, 1.0 + 1e-8), fault)
    };
    let truth = 5.0 * integrating_sphere(0.8, 0.25, 2);
    let hollow = Expected::Mean { truth, bias: BIAS, effect: 0.02 };
    vec![
        tiny(Explicit),
        tiny(Mis),
        hair(Explicit),
        case(9, "09-integrating-sphere", Implicit, 2048, hollow, SIDE),
        case(12, "12-coincident-wall-first", Implicit, 1024, mean(0.8), LAST),
        case(15, "15-uniform-lobe", Implicit, 1024, lobe(1.0, 60.0, 0.0), COSINE_OF_LOBES),
        case(16, "16-exponent-1e7", Implicit, 64, lobe(1.0, 40.0, 1e7), MIRROR),
        case(16, "16-exponent-1e10", Implicit, 64, lobe(1.0, 40.0, 1e10), MIRROR),
        case(18, "18-grazing", Implicit, 1024, lobe(1.0, 89.99, 1.0), COSINE_OF_LOBES),
        case(
            20,
            "20-furnace",
            Implicit,
            1024,
            mean(1.0),
            ("2 % too much of a cosine", "2.0 * polar.y", "2.04 * polar.y"),
        ),
        case(
            20,
            "20-furnace",
            Cosine,
            64,
            Expected::Exactly([1.0; 3]),
            ("2 % too much weight", "f32 {\n    return 1.0;", "f32 {\n    return 0.98;"),
        ),
        case(23, "23-lamp-half-set", Explicit, 1024, form_factor(5.0, 90.0, 2.0), COSINE_OF_LIGHTS),
    ]
}

/// Where the twin is the truth.
fn paired() -> Vec<Case> {
    let lamps = |estimator, fault| {
        case(25, "25-lamps-touch-and-overlap", estimator, 128, Expected::Twin, fault)
    };
    vec![
        lamps(Implicit, LAST_WINS),
        lamps(Explicit, ("chance of a lamp forgotten", " / pick.chance", "")),
        lamps(Mis, ("chance of a hit forgotten", " / chance_of(light, point)", "")),
    ]
}

const LAST_WINS: (&str, &str, &str) = (
    "the far one of two wins",
    "let is_closer = t < best.distance;",
    "let is_closer = t < MISS && (best.distance == MISS || t > best.distance);",
);

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hard")
}

/// The scenes in the folder, without their ending.
fn names() -> BTreeSet<String> {
    let entries = fs::read_dir(folder()).expect("scenes/hard can be listed");
    let paths = entries.map(|entry| entry.expect("scenes/hard can be listed").path());
    paths.map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned()).collect()
}

impl Case {
    fn scene(&self, seed: u32) -> Scene {
        let scene = load(&folder().join(format!("{}.toml", self.file))).expect("a valid scene");
        let settings = scene.settings().with_estimator(self.estimator).with_seed(seed);
        scene.with_settings(settings)
    }

    /// The verdict, and whether the effect that must not go unnoticed would have shown.
    fn judge(&self, scene: &Scene, tracer: &mut GpuTracer, claims: usize) -> (Verdict, bool) {
        let (film, ledger) = trace(tracer, std::slice::from_ref(&(0..self.samples)));
        let valid = ledger.count == 0 && film.samples().count() == self.samples;
        let mut sees = true;
        let (accepts, found) = match self.expected {
            Expected::Exactly(rgb) => {
                let exact = is_exactly(&film, rgb, self.samples);
                (exact, if exact { "exactly that" } else { "something else" }.to_owned())
            }
            Expected::Mean { truth, bias, effect } => {
                let estimate = Estimate::of(&film, Quantity::Channel(1));
                let limit = limit(claims, estimate.freedom);
                let z = deviation(estimate, truth, bias);
                sees = detectable(estimate, truth, bias, limit) <= effect;
                let found = format!("{:.6e} ± {:.1e}", estimate.mean, estimate.standard_error);
                (z.abs() <= limit, found)
            }
            Expected::Twin => {
                let theirs = trace(&mut twin(scene), std::slice::from_ref(&(0..self.samples))).0;
                let paired = pair(&film, &theirs);
                let [r, g, b] = paired.bias;
                (paired.is_within(MAX_BIAS, ALPHA), format!("off by {r:.0e} {g:.0e} {b:.0e}"))
            }
        };
        let found = if valid { found } else { format!("{} invalid samples", ledger.count) };
        (Verdict { accepts: accepts && valid, found }, sees)
    }

    fn line(&self, seed: u32, claims: usize) -> Line {
        let scene = self.scene(seed);
        let text = kernel(&scene);
        let (fault, from, to) = self.fault;
        let times = text.matches(from).count();
        assert_eq!(times, 1, "{}: occurrences of {from:?} in the kernel", self.file);
        let judge = |text: &str| self.judge(&scene, &mut with_kernel(&scene, text), claims);
        let (right, has_power) = judge(&text);
        assert!(has_power, "{}: an error that must be seen would not", self.file);
        Line {
            case: self.number,
            place: format!("{}, {}", self.file, self.estimator.name()),
            expected: match self.expected {
                Expected::Exactly([r, g, b]) => format!("exactly {r} {g} {b}"),
                Expected::Mean { truth, effect, .. } => {
                    format!("{truth:.6e}, to {:.0} %", 100.0 * effect)
                }
                Expected::Twin => "the twin within 0.1 %".to_owned(),
            },
            right,
            fault,
            wrong: judge(&text.replace(from, to)).0,
        }
    }
}

/// Files that the loader must refuse: the message, and the change that makes them scenes,
/// which a judge of refusals must not take for one.
const REFUSED: [(u32, &str, &str, &str, &str); 7] = [
    (14, "14-radius-zero", "a radius from 1e-15 to 1e15", "radius = 0.0", "radius = 1.0"),
    (14, "14-radius-negative", "a radius from 1e-15 to 1e15", "radius = -1.0", "radius = 1.0"),
    (14, "14-radius-nan", "a radius from 1e-15 to 1e15", "radius = nan", "radius = 1.0"),
    (17, "17-exponent-infinite", "a Phong exponent from 0 to 1e10", "= inf", "= 1e10"),
    (17, "17-exponent-nan", "a Phong exponent from 0 to 1e10", "= nan", "= 1e10"),
    (17, "17-exponent-too-large", "a Phong exponent from 0 to 1e10", "= 1e11", "= 1e10"),
    (21, "21-albedo-above-one", "an albedo per channel, each from 0 to 1", "[1.5, ", "[1.0, "),
];

fn refused() -> impl Iterator<Item = Line> {
    REFUSED.into_iter().map(|(case, file, allowed, from, to)| {
        let path = folder().join(format!("{file}.toml"));
        let text = fs::read_to_string(path).expect("a scene file");
        assert!(text.contains(from), "{file}: {from}");
        let judge = |text: &str| match parse(file, text) {
            Ok(_) => Verdict { accepts: false, found: "loaded".to_owned() },
            Err(error) => {
                let accepts = error.to_string().contains(allowed);
                let found = if accepts { "refused" } else { "another message" };
                Verdict { accepts, found: found.to_owned() }
            }
        };
        Line {
            case,
            place: file.to_owned(),
            expected: "refused".to_owned(),
            right: judge(&text),
            fault: "a scene that is valid",
            wrong: judge(&text.replace(from, to).replace("1.5, 1.5", "1.0, 1.0")),
        }
    })
}

/// Every scene, judged; each with a seed of its own, and one family-wise level for all
/// means.
pub fn lines() -> Vec<Line> {
    let cases: Vec<Case> = walls().chain(exact()).chain(closed()).chain(paired()).collect();
    let is_mean = |case: &&Case| matches!(case.expected, Expected::Mean { .. });
    let claims = cases.iter().filter(is_mean).count();
    let judged = (0..).zip(&cases).map(|(seed, case)| case.line(seed, claims));
    let mut lines: Vec<Line> = judged.collect();
    lines.extend(refused());
    let files = cases.iter().map(|case| case.file).chain(REFUSED.map(|row| row.1));
    assert_eq!(files.map(str::to_owned).collect::<BTreeSet<_>>(), names(), "every scene is used");
    lines
}
