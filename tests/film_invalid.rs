//! Samples that are invalid: counted, recorded with their address, and not in the film.

#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::bound::sample_scale;
use candor::effects::{Effect, Effects};
use candor::film::Film;
use candor::gpu::GpuTracer;
use candor::scene::Scene;
use candor::tracer::{InvalidReason, InvalidSample, Ledger};
use support::scenes::{classic, many, size};
use support::tracers::{film, kernel, mutant, on_device, trace, with_effects, with_kernel};

const FIRST: u64 = (1 << 32) - 3;
const WIDTH: u32 = 13;

/// Where the kernel has a sample in hand.
const SAMPLE: &str = "let sample = trace(pixel, key);";

fn scene() -> Scene {
    classic(size(WIDTH, 9))
}

/// Puts `value` into one channel of every fourth sample of three pixels.
fn poisoned(value: &str) -> String {
    format!(
        "var sample = trace(pixel, key);
    if (pixel.x % 5u == 2u && pixel.y == 4u && (key.index_low & 3u) == 1u) {{ {value} }}"
    )
}

/// The samples that `poisoned` meets of `count` from `FIRST` on.
fn addresses(count: u64) -> Vec<(u32, u64)> {
    let samples = (FIRST..FIRST + count).filter(|index| index % 4 == 1);
    let pixels = [2, 7, 12].map(|x| 4 * WIDTH + x);
    let mut all: Vec<_> = samples.flat_map(|index| pixels.map(|pixel| (pixel, index))).collect();
    all.sort_unstable();
    all
}

fn traced(to: &str, count: u64) -> (Film, Ledger) {
    trace(&mut mutant(&scene(), SAMPLE, to), &[FIRST..FIRST + count])
}

#[test]
fn invalid_samples_are_recorded_and_add_nothing() {
    let bound = sample_scale(&scene()).bound();
    // Written so that no compiler can see the value at compile time.
    let bits = |bits: u32| {
        poisoned(&format!("sample.radiance.y = bitcast<f32>({bits}u + (key.pixel & 0x80000000u));"))
    };
    let (without, ledger) = traced(&poisoned("sample.radiance = vec3<f32>(0.0);"), 12);
    assert_eq!(ledger.count, 0);
    let values = [
        ("NaN", f32::NAN, InvalidReason::NotANumber),
        ("a NaN with its sign", -f32::NAN, InvalidReason::NotANumber),
        ("a signalling NaN", f32::from_bits(0x7f80_0001), InvalidReason::NotANumber),
        ("infinity", f32::INFINITY, InvalidReason::Infinite),
        ("minus infinity", f32::NEG_INFINITY, InvalidReason::Infinite),
        ("a negative number", -1e-30, InvalidReason::Negative),
        ("minus zero", -0.0, InvalidReason::Negative),
        ("more than the bound", bound.next_up(), InvalidReason::AboveBound),
        ("the largest number", f32::MAX, InvalidReason::AboveBound),
    ];
    let expected = addresses(12);
    for (name, value, reason) in values {
        let (film, ledger) = traced(&bits(value.to_bits()), 12);
        assert_eq!(ledger.count, expected.len() as u64, "{name}");
        let found: Vec<_> = ledger.records.iter().map(|r| (r.pixel, r.index)).collect();
        assert_eq!(found, expected, "{name}");
        assert!(ledger.records.iter().all(|r| r.reason == reason), "{name}: {ledger:?}");
        assert!(film == without, "{name} left something in the film");
        assert_eq!(film.samples().count(), 12, "{name}");
    }
    // What is at the bound is valid, and seen in the film.
    let (film, ledger) = traced(&bits(bound.to_bits()), 12);
    assert_eq!(ledger.count, 0);
    assert!(film != without);
}

/// More than the ledger has room for are still counted.
#[test]
fn the_ledger_counts_beyond_its_records() {
    let (_, ledger) = traced(&poisoned("sample.radiance.x = -1.0;"), 400);
    let expected = addresses(400);
    assert_eq!((ledger.count, ledger.records.len()), (expected.len() as u64, 16));
    for record in ledger.records {
        assert!(expected.contains(&(record.pixel, record.index)), "{record:?}");
    }
}

/// Reading the ledger between the samples neither loses nor repeats anything, and the records
/// that were there stay.
#[test]
fn a_ledger_that_is_read_goes_on() {
    let mut tracer = mutant(&scene(), SAMPLE, &poisoned("sample.radiance.x = -1.0;"));
    let mut counts = Vec::new();
    let mut records = Vec::new();
    for part in 0..8 {
        let first = FIRST + 8 * part;
        let (_, ledger) = trace(&mut tracer, &[first..first + 8]);
        counts.push(ledger.count);
        records.push(ledger.records);
    }
    let expected: Vec<u64> = (1..=8).map(|part| addresses(8 * part).len() as u64).collect();
    assert_eq!(counts, expected);
    let early = addresses(16);
    assert!(early.len() == 12 && records.last().map(Vec::len) == Some(16), "{records:?}");
    for record in records.iter().skip(1).map(|r| r.iter().map(|r| (r.pixel, r.index))) {
        let found: Vec<_> = record.collect();
        assert!(early.iter().all(|address| found.contains(address)), "{found:?}");
    }
}

/// Directions that are none would turn into hits or misses and be lost; they are told where
/// they are made, under every estimator, also where the path would have ended there.
#[test]
fn a_direction_that_is_none_is_an_invalid_sample() {
    let wrong = [
        ("NaN", "bitcast<f32>(0x7fc00000u + (key.pixel & 0x80000000u))", InvalidReason::NotANumber),
        (
            "infinite",
            "bitcast<f32>(0x7f800000u + (key.pixel & 0x80000000u))",
            InvalidReason::Infinite,
        ),
        ("too short", "0.5", InvalidReason::AboveBound),
    ];
    for estimator in candor::scene::Estimator::ALL {
        let scene = scene();
        let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
        for (name, value, reason) in wrong {
            let from = "if !is_direction(scattering.direction) {";
            let to = format!(
                "if key.pixel == 58u {{ scattering.direction = vec3<f32>({value}, 0.0, 0.0); }}\n{from}"
            );
            let kernel = kernel(&scene)
                .replace("let scattering = scatter(", "var scattering = scatter(")
                .replace(from, &to);
            let (_, ledger) = trace(&mut with_kernel(&scene, &kernel), &[0..8]);
            let told = ledger.records.iter().all(|r| r.pixel == 58 && r.reason == reason);
            assert!(ledger.count == 8 && told, "{name}, {}: {ledger:?}", estimator.name());
            let blind = kernel
                .replace(from, "if false {")
                .replace("light, is_direction(direction));", "light, true);");
            let (_, ledger) = trace(&mut with_kernel(&scene, &blind), &[0..8]);
            assert!(ledger.count < 8, "{name}, {}, unchecked: {ledger:?}", estimator.name());
        }
    }
}

/// So are directions to sampled lights.
#[test]
fn a_direction_to_a_light_that_is_none_is_an_invalid_sample() {
    use candor::scene::Estimator::{Explicit, Mis};
    for estimator in [Explicit, Mis] {
        let scene = scene();
        let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
        let from = "around(cone.axis, polar_cone(u.x, cone.height), u.y)";
        let to = format!("select(1.0, 0.0, key.pixel == 58u) * {from}");
        let (_, ledger) = trace(&mut mutant(&scene, from, &to), &[0..64]);
        let told =
            ledger.records.iter().all(|r| r.pixel == 58 && r.reason == InvalidReason::Negative);
        assert!(ledger.count > 32 && told, "{}: {ledger:?}", estimator.name());
    }
}

/// A sample is what is wrong with any channel; what is worst is said first.
#[test]
fn reasons_go_by_the_worst_channel() {
    let of = |r, g, b| InvalidReason::of([r, g, b], 2.0);
    assert_eq!(of(0.0, 2.0, 1.0), None);
    assert_eq!(of(0.0, 2.0_f32.next_up(), 0.0), Some(InvalidReason::AboveBound));
    assert_eq!(of(9.0, 0.0, -0.0), Some(InvalidReason::Negative));
    assert_eq!(of(9.0, -1.0, f32::INFINITY), Some(InvalidReason::Infinite));
    assert_eq!(of(f32::NEG_INFINITY, -1.0, -f32::NAN), Some(InvalidReason::NotANumber));
}

/// A kernel that does not look for invalid samples is told by the ledger alone.
#[test]
fn an_unchecked_kernel_is_rejected() {
    let unchecked = kernel(&scene())
        .replace("|| exceeds_bound(sample.radiance)", "")
        .replace(SAMPLE, &poisoned("sample.radiance.x = -1.0;"));
    let (without, _) = traced(&poisoned("sample.radiance = vec3<f32>(0.0);"), 12);
    let (film, ledger) = trace(&mut with_kernel(&scene(), &unchecked), &[FIRST..FIRST + 12]);
    assert!(ledger.count != addresses(12).len() as u64 && film != without);
}

/// A loop over bounces that is left early, or a segment that is missing where they are written
/// out: exactly the paths that were still under way are unfinished.
#[test]
fn a_path_cut_short_is_unfinished() {
    let last = "    if goes_on {\n        goes_on = advance(&path, key, 2u);\n    }\n";
    let cuts = [(2, last, ""), (6, "bounce <= BOUNCES && goes_on", "bounce < BOUNCES && goes_on")];
    for (bounces, whole, cut) in cuts {
        let under = |bounces| {
            let scene = scene();
            let settings = scene.settings().with_bounces(bounces).expect("a few bounces");
            scene.with_settings(settings)
        };
        let scene = under(bounces);
        let (cut, ledger) = trace(&mut mutant(&scene, whole, cut), &[0..256]);
        assert!(ledger.count > 0 && ledger.records.len() == 16, "{bounces}: {ledger:?}");
        assert!(ledger.records.iter().all(|r| r.reason == InvalidReason::Unfinished));
        // One bounce less, properly ended, leaves the same light.
        let packed = support::scenes::packed(&scene);
        let shorter = kernel(&under(bounces - 1));
        let mut tracer = GpuTracer::with_kernel(&scene, support::gpu::open(), &packed, &shorter)
            .expect("the device takes the kernel");
        assert!(film(&mut tracer, &[0..256]) == cut, "{bounces}");
    }
}

/// A loop over spheres that is left early: every sample is unfinished.
#[test]
fn a_search_cut_short_is_unfinished() {
    let scene = many(size(5, 3));
    assert!(film(&mut on_device(&scene), &[0..8]).pixels().iter().flatten().any(|&w| w > 0));
    let mut cut = mutant(&scene, "; i < scene.sphere_count; i++", "; i < 3u; i++");
    let (film, ledger) = trace(&mut cut, &[0..8]);
    assert_eq!(ledger.count, 5 * 3 * 8);
    let unfinished = |r: &InvalidSample| r.reason == InvalidReason::Unfinished && r.pixel < 15;
    assert!(ledger.records.iter().all(unfinished));
    assert!(film.pixels().iter().flatten().all(|&word| word == 0));
}

/// The longest loops that a scene can ask for are finished.
#[test]
fn the_longest_path_among_the_most_spheres_is_finished() {
    let mut spheres = support::scenes::room(1e4, true).spheres().to_vec();
    let speck = |i: u32| {
        let [x, y, z] = [i % 8, i / 8 % 8, i / 64].map(|n| 0.6 * f64::from(n) - 2.1);
        support::scenes::sphere([x, y, z], 0.01, support::scenes::diffuse(1.0))
    };
    let free = candor::kernel::SPHERE_CAPACITY - spheres.len();
    spheres.extend((0..).map(speck).take(free));
    let scene = |bounces| {
        let (eye, target) = ([1.0, 0.5, 0.25], [2.0, 1.0, 0.0]);
        support::scenes::seen(eye, target, size(16, 16), bounces, spheres.clone())
    };
    let loops = Effects::general(&scene(64)).without(Effect::Hierarchy);
    film(&mut with_effects(&scene(64), loops), &[0..4]);
    // The bound on what a hierarchy may take allows fewer.
    let tracer = |bounces| GpuTracer::new(&scene(bounces), support::gpu::open()).ok();
    let mut most = (48..=64).rev().find_map(tracer).expect("48 bounces are allowed");
    film(&mut most, &[0..4]);
}
