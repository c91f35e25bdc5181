//! The estimators have one mean: each is held to `implicit` on scenes in which sampling a
//! light is hard, and estimators that are wrong on purpose are told.

#![expect(clippy::cast_precision_loss, reason = "counts of pixels and tests")]
#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    pub mod light_scenes;
    pub mod scenes;
    pub mod tracers;
}

use candor::estimate::{Comparison, compare, estimate, z_limit};
use candor::film::Film;
use candor::scene::Estimator::{self, Cosine, Explicit, Implicit, Mis};
use candor::scene::Scene;
use candor::tracer::Tracer;
use support::light_scenes::{
    at_the_floor, classic_of, coincident_crowd, coincident_lights, forty_lights, gloss,
    hidden_light, hollow, in_light, joined_lights, lamp_layer, under_sun,
};
use support::tracers::{film, mutant, on_device, trace, twin};

/// Chance that correct estimators fail a table of this file.
const FAMILY: f64 = 1e-6;

/// A mean that is off by the detectable effect is missed with the chance that a normal
/// deviate passes this: 3e-5.
const POWER: f64 = 4.0;

/// Fewer tests than this are made with one table.
const TESTS: f64 = 1000.0;

/// Relative bias that rounding to `f32` may give one channel of the image: a tenth of
/// what `verify` allows.
const ROUNDING: f64 = 1e-4;

const OTHERS: [Estimator; 3] = [Cosine, Explicit, Mis];

/// Two films of one picture with independent samples, side by side.
#[derive(Debug)]
struct Verdict {
    /// Difference of the image means over the reference's, per channel, with its standard
    /// error: pixels are independent, so the scatter of their differences is the error.
    channels: [(f64, f64); 3],
    /// Luminance of the image and its tiles.
    tiles: Comparison,
}

impl Verdict {
    fn of(film: &Film, reference: &Film) -> Self {
        let channel = |c: usize| {
            let mean = |film: &Film| -> Vec<f64> {
                film.pixels().iter().map(|words| estimate(film, words).rgb[c]).collect()
            };
            let (ours, theirs) = (mean(film), mean(reference));
            let differences: Vec<f64> =
                std::iter::zip(&ours, &theirs).map(|(a, b)| a - b).collect();
            let sum: f64 = differences.iter().sum();
            let average = sum / differences.len() as f64;
            let squares: f64 = differences.iter().map(|d| (d - average).powi(2)).sum();
            let whole: f64 = theirs.iter().sum();
            (sum / whole, squares.sqrt() / whole)
        };
        Self { channels: [0, 1, 2].map(channel), tiles: compare(film, reference) }
    }

    /// Whether a channel or a tile is certainly off.
    fn disagrees(&self) -> bool {
        let limit = z_limit(FAMILY / TESTS);
        let off = |&(bias, error): &(f64, f64)| bias.abs() > limit * error + ROUNDING;
        self.channels.iter().any(off) || self.tiles.disagrees(10.0 * FAMILY / TESTS)
    }

    /// The relative error of a channel that all but certainly does not go unnoticed.
    fn detects(&self) -> f64 {
        let error = self.channels.iter().map(|channel| channel.1).fold(0.0, f64::max);
        (z_limit(FAMILY / TESTS) + POWER) * error + ROUNDING
    }
}

/// The same scene under an estimator, each with random numbers of its own.
fn under(scene: &Scene, estimator: Estimator) -> Scene {
    let seed = Estimator::ALL.iter().position(|&e| e == estimator).expect("one of all");
    let settings = scene.settings().with_estimator(estimator);
    scene.clone().with_settings(settings.with_seed(u32::try_from(seed).expect("one of four")))
}

/// One scene, how many samples the estimators need that find lights by themselves, and how
/// many the others.
struct Case {
    name: &'static str,
    scene: Scene,
    implicit: u64,
    others: u64,
}

impl Case {
    fn new(name: &'static str, scene: Scene, implicit: u64, others: u64) -> Self {
        Self { name, scene, implicit, others }
    }

    /// What is wrong with the estimators, or with the number of samples.
    fn judge(&self, effect: f64, make: &dyn Fn(&Scene) -> Box<dyn Tracer>) -> Vec<String> {
        let reference = film(make(&under(&self.scene, Implicit)).as_mut(), &[0..self.implicit]);
        let mut failures = Vec::new();
        for estimator in OTHERS {
            let samples = if estimator == Cosine { self.implicit } else { self.others };
            let found = film(make(&under(&self.scene, estimator)).as_mut(), &[0..samples]);
            let verdict = Verdict::of(&found, &reference);
            let (name, detects) = (self.name, verdict.detects());
            println!(
                "{name:<28}{:<10}{:>7.2?} image z {:>5.2}, worst of {} tiles {:>5.2}, detects {:.2} %",
                estimator.name(),
                verdict.channels.map(|(bias, error)| bias / error.max(f64::MIN_POSITIVE)),
                verdict.tiles.image.z,
                verdict.tiles.tiles,
                verdict.tiles.worst.z,
                100.0 * detects
            );
            if verdict.disagrees() {
                failures.push(format!("{name}, {}: {verdict:?}", estimator.name()));
            }
            if detects > effect || !verdict.tiles.conclusive {
                failures.push(format!("{name}, {}: only {detects} is noticed", estimator.name()));
            }
        }
        failures
    }
}

fn check(cases: &[Case], effect: f64, make: &dyn Fn(&Scene) -> Box<dyn Tracer>) {
    let failures: Vec<String> = cases.iter().flat_map(|case| case.judge(effect, make)).collect();
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

#[test]
fn the_device_has_one_mean() {
    let cases = [
        Case::new("classic, no bounce", classic_of(1e5, 0), 8192, 8192),
        Case::new("classic, 1 bounce", classic_of(1e5, 1), 12288, 3072),
        Case::new("classic, 2 bounces", classic_of(1e5, 2), 12288, 3072),
        Case::new("classic, walls of 100", classic_of(1e2, 2), 12288, 3072),
        Case::new("classic, 5 bounces", classic_of(1e5, 5), 10240, 3072),
        Case::new("hollow, 2 bounces", hollow(2), 2048, 1024),
        Case::new("hollow, 8 bounces", hollow(8), 2048, 1024),
        Case::new("in a light", in_light(), 1024, 1024),
        Case::new("gloss", gloss(), 2048, 2048),
        Case::new("under a sun of 1e3", under_sun(1e3), 1024, 1024),
        Case::new("under a sun of 1e6", under_sun(1e6), 1024, 1024),
        Case::new("lamps at the floor", at_the_floor(), 4096, 1024),
        Case::new("joined lamps", joined_lights(), 4096, 1024),
        Case::new("forty lamps", forty_lights(), 8192, 6144),
        Case::new("hidden lamp", hidden_light(), 6144, 1024),
        Case::new("coincident lamps", coincident_lights(), 8192, 2048),
        Case::new("coincident in a crowd", coincident_crowd(), 8192, 2048),
        Case::new("a thousand lamps", lamp_layer(1000, 1.0), 3584, 1792),
    ];
    check(&cases, 0.02, &|scene| Box::new(on_device(scene)));
}

#[test]
fn the_twin_has_one_mean() {
    let cases = [
        Case::new("hollow, 2 bounces", hollow(2), 1024, 512),
        Case::new("in a light", in_light(), 512, 512),
        Case::new("under a sun of 1e6", under_sun(1e6), 512, 512),
        Case::new("joined lamps", joined_lights(), 1024, 512),
        Case::new("200 lamps", lamp_layer(200, 1.0), 1792, 896),
    ];
    check(&cases, 0.03, &|scene| Box::new(twin(scene)));
}

/// An estimator that is wrong on purpose: name, estimator, what stands in the kernel and
/// what takes its place.
type Fault = (&'static str, Estimator, &'static str, &'static str);

/// A scene and the faults that it tells.
type Faulty = (&'static str, fn() -> Scene, &'static [Fault]);

const FAULTS: &[Faulty] = &[
    (
        "hollow",
        || hollow(2),
        &[
            ("light counted twice", Explicit, "select(0.0, 1.0, departure.alone)", "1.0"),
            (
                "a bounce too few",
                Explicit,
                "return bounce == BOUNCES &&",
                "return bounce + 1u == BOUNCES &&",
            ),
            ("nothing after gloss", Explicit, "!samples_light_at(hit.sphere))", "false)"),
            (
                "cosine without its density",
                Cosine,
                "fn weight_diffuse(polar: vec2<f32>) -> f32 {\n    return 1.0;",
                "fn weight_diffuse(polar: vec2<f32>) -> f32 {\n    return 2.0 * polar.y;",
            ),
            (
                "no heuristic",
                Mis,
                "fn share_of_sampled(x: f32) -> f32 {\n    return x / (1.0 + x * x);",
                "fn share_of_sampled(x: f32) -> f32 {\n    return x;",
            ),
            ("chance forgotten by hits", Mis, " / chance_of(light, point)", ""),
        ],
    ),
    (
        "in a light",
        in_light,
        &[("a quarter of the sky", Explicit, "Cone(normal, 1.0)", "Cone(normal, 0.5)")],
    ),
    ("gloss", gloss, &[("density of one side", Mis, "(exponent + 1.0) * lobe", "exponent * lobe")]),
    (
        "forty lamps",
        forty_lights,
        &[
            ("chance forgotten", Explicit, " / pick.chance", ""),
            (
                "cone twice as high",
                Explicit,
                "min(sine2, 1.0) / (1.0 + sqrt",
                "2.0 * min(sine2, 0.5) / (1.0 + sqrt",
            ),
        ],
    ),
    (
        "hidden lamp",
        hidden_light,
        &[
            (
                "nothing hides",
                Explicit,
                "return first < distance || earlier <= distance;",
                "return false;",
            ),
            (
                "light seen too near",
                Explicit,
                "max(q.c, 0.0) / max(root + abs(q.b), 1.0e-30)",
                "0.5 * max(q.c, 0.0) / max(root + abs(q.b), 1.0e-30)",
            ),
        ],
    ),
    (
        "coincident",
        coincident_lights,
        &[("both of a place seen", Explicit, " || earlier <= distance", "")],
    ),
    (
        "200 lamps",
        || lamp_layer(200, 1.0),
        &[
            ("no even half", Explicit, "0.5 * walked + 0.5 / f32(scene.light_count)", "walked"),
            (
                "chance of the other side",
                Explicit,
                "select(1.0 - chance, chance, goes_left)",
                "select(chance, 1.0 - chance, goes_left)",
            ),
            (
                "chance of another leaf",
                Mis,
                "u32(spheres[light].exponent)",
                "u32(spheres[light].exponent) ^ 7u",
            ),
        ],
    ),
    (
        "crowd",
        coincident_crowd,
        &[(
            "both of a place seen",
            Mis,
            "i != scene.factored_count;\n    return first < distance || earlier <= distance;",
            "i != scene.factored_count;\n    return first < distance;",
        )],
    ),
];

#[test]
fn faults_are_told() {
    for (name, scene, faults) in FAULTS {
        let scene = scene();
        let reference = film(&mut on_device(&under(&scene, Implicit)), &[0..1024]);
        for (fault, estimator, from, to) in *faults {
            let mut wrong = mutant(&under(&scene, *estimator), from, to);
            // A sample above its bound tells too.
            let (found, ledger) = trace(&mut wrong, &[0..256]);
            let verdict = Verdict::of(&found, &reference);
            println!("{name:<14}{fault:<28}{:+.3?}", verdict.channels.map(|channel| channel.0));
            assert!(verdict.disagrees() || ledger.count > 0, "{name}, {fault}: {verdict:?}");
        }
    }
}
