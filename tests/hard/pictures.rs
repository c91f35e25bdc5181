//! Cases of whole pictures: how samples are divided, what sizes and counts do, and what
//! must be the same in two pictures.

#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

use crate::support::gpu;
use crate::support::scenes::{classic, diffuse, emitter, glossy, seen, size, sphere, with_seed};
use crate::support::tracers::{kernel, on_device, trace, twin, with_effects, with_kernel};
use crate::{Line, Verdict};
use candor::effects::Effects;
use candor::estimate::{Summary, compare, pair, summarize};
use candor::film::{Film, sums};
use candor::gpu::GpuTracer;
use candor::scene::{Camera, Estimator, RenderSettings, Scene, load};
use candor::verify::{ALPHA, MAX_BIAS};
use glam::DVec3;
use std::ops::Range;
use std::path::Path;

fn hard(name: &str) -> Scene {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/hard");
    load(&folder.join(format!("{name}.toml"))).expect("a valid scene")
}

fn under(scene: &Scene, estimator: Estimator) -> Scene {
    scene.clone().with_settings(scene.settings().with_estimator(estimator))
}

/// The kernel of a scene with a change, which must be one.
fn changed(scene: &Scene, from: &str, to: &str) -> String {
    let text = kernel(scene);
    assert!(text.contains(from), "{from:?} in the kernel");
    text.replace(from, to)
}

/// A film of each division of the samples, by tracers of their own.
fn film_of(scene: &Scene, text: &str, ranges: &[Range<u64>]) -> Film {
    trace(&mut with_kernel(scene, text), ranges).0
}

fn same(accepts: bool) -> Verdict {
    let found = if accepts { "the same bits" } else { "other bits" };
    Verdict { accepts, found: found.to_owned() }
}

/// 5: where no path met the light, the error is unproven, and not zero.
fn unproven() -> Line {
    let scene = under(&hard("05-tiny-lamp"), Estimator::Implicit);
    let (film, _) = trace(&mut on_device(&scene), &[0..64]);
    let pixels = u64::from(scene.size().pixels());
    let judge = |summary: &Summary| {
        let open = summary.relative_error.is_none() && summary.error_bound.is_none();
        let accepts = open && summary.unproven_pixels == pixels;
        let found = format!("{} pixels unproven", summary.unproven_pixels);
        Verdict { accepts, found }
    };
    Line {
        case: 5,
        place: "05-tiny-lamp, implicit".to_owned(),
        expected: format!("{pixels} pixels unproven"),
        right: judge(&summarize(&film)),
        fault: "no hit is no error",
        wrong: judge(&Summary::of_darkness(64)),
    }
}

/// 25: light sampling and chance meetings have one mean.
fn one_mean() -> Line {
    let scene = hard("25-lamps-touch-and-overlap");
    let (implicit, explicit) =
        (under(&scene, Estimator::Implicit), under(&with_seed(&scene, 1), Estimator::Explicit));
    let range = &[0..1024];
    let reference = film_of(&implicit, &kernel(&implicit), range);
    let judge = |text: &str| {
        let found = compare(&film_of(&explicit, text, &[0..256]), &reference);
        let accepts = found.conclusive && !found.disagrees(ALPHA);
        Verdict { accepts, found: format!("p = {:.1e}", found.p()) }
    };
    Line {
        case: 25,
        place: "25-lamps-…, explicit = implicit".to_owned(),
        expected: format!("p > {ALPHA:.0e}"),
        right: judge(&kernel(&explicit)),
        fault: "lamps hide nothing",
        wrong: judge(&changed(
            &explicit,
            "return first < distance || earlier <= distance;",
            "return false;",
        )),
    }
}

/// 26: sample indices pass 2^32 without repeating or wrapping.
fn past_32_bits() -> Line {
    let (scene, edge) = (classic(size(16, 16)), 1 << 32);
    let judge = |text: &str| {
        let across = film_of(&scene, text, &[edge - 5..edge + 8]);
        let parts = film_of(&scene, text, &[edge..edge + 8, edge - 5..edge]);
        let repeats = film_of(&scene, text, &[edge..edge + 8]).pixels()
            == film_of(&scene, text, &[0..8]).pixels();
        same(across == parts && !repeats)
    };
    Line {
        case: 26,
        place: "samples 2^32 - 5 to 2^32 + 8".to_owned(),
        expected: "the same bits, no repeat".to_owned(),
        right: judge(&kernel(&scene)),
        fault: "index without carry",
        wrong: judge(&changed(&scene, "u32(low < id.z)", "0u")),
    }
}

/// 27: the same samples in one, two or seven parts, in any order.
fn divisions() -> Line {
    let scene = classic(size(27, 51));
    let seven = [(16, 21), (3, 6), (0, 1), (10, 15), (1, 3), (15, 16), (6, 10)];
    let divisions: [Vec<Range<u64>>; 3] =
        [vec![0..8, 8..21], vec![8..21, 0..8], seven.map(|(start, end)| start..end).into()];
    let judge = |text: &str| {
        let whole = film_of(&scene, text, &[0..21]);
        let lit = whole.pixels().iter().flatten().any(|&word| word > 0);
        same(lit && divisions.iter().all(|parts| film_of(&scene, text, parts) == whole))
    };
    Line {
        case: 27,
        place: "21 samples in 1, 2 and 7 parts".to_owned(),
        expected: "the same bits".to_owned(),
        right: judge(&kernel(&scene)),
        fault: "parts start at sample 0",
        wrong: judge(&changed(&scene, "work.first_sample_low + id.z", "id.z")),
    }
}

/// Share of the pixels that differ from the twin's by more than 1e-3 of the brighter.
#[expect(clippy::cast_precision_loss, reason = "sums and counts become shares")]
fn differing(ours: &Film, theirs: &Film) -> f64 {
    let differ = |(a, b): (&_, &_)| {
        let ([a, ..], [b, ..]) = (sums(a), sums(b));
        a.abs_diff(b) as f64 > 1e-3 * a.max(b) as f64
    };
    let pairs = ours.pixels().iter().zip(theirs.pixels());
    pairs.filter(|&pair| differ(pair)).count() as f64 / ours.pixels().len() as f64
}

/// 28: pictures of one pixel, one row, one column. A path that rounding sends elsewhere
/// makes its pixel differ: fewer than one in a hundred.
fn sizes() -> impl Iterator<Item = Line> {
    let sizes = [(16384, 1), (1, 16384), (1, 1)];
    sizes.into_iter().map(|(width, height)| {
        let scene = under(&classic(size(width, height)), Estimator::Mis);
        let reference = trace(&mut twin(&scene), &[0..8]).0;
        let judge = |text: &str| {
            let share = differing(&film_of(&scene, text, &[0..8]), &reference);
            let found = format!("{:.2} % of pixels differ", 100.0 * share);
            Verdict { accepts: share < 0.01, found }
        };
        Line {
            case: 28,
            place: format!("a picture of {width}x{height}"),
            expected: "the twin, pixel by pixel".to_owned(),
            right: judge(&kernel(&scene)),
            fault: "samples of one pixel repeat",
            wrong: judge(&changed(
                &scene,
                "work.first_sample_low + id.z",
                "work.first_sample_low + id.z / 2u",
            )),
        }
    })
}

/// 29: whole paths of nothing but the ends of their random numbers, from a white body in
/// uniform light. Means over the two ends are the trapezoidal rule, which is exact for what
/// is linear in u: 1, of a light of 1. Only the power heuristic's shares are not: with x = 2
/// and x = 0 at the ends, half of 2/5 and half of 4/5.
fn extreme_paths() -> impl Iterator<Item = Line> {
    // A sample is at most 2: its mean's standard error is at most 1/√(1024·256) = 0.002.
    const WITHIN: f64 = 0.01;
    Estimator::ALL.into_iter().map(|estimator| {
        let truth = if estimator == Estimator::Mis { 0.6 } else { 1.0 };
        let scene = under(&hard("20-furnace"), estimator);
        let number = "f32(bits >> 8u) * 5.9604644775390625e-8";
        let ends = changed(&scene, number, "select(0.0, 0.99999994, (bits & 1u) == 1u)");
        let judge = |text: &str| {
            let mut tracer = with_kernel(&scene, text);
            let (film, ledger) = trace(&mut tracer, &[0..256]);
            let mean = summarize(&film).luminance;
            let accepts = ledger.count == 0 && (mean - truth).abs() <= WITHIN;
            Verdict { accepts, found: format!("{mean:.3}, {} invalid", ledger.count) }
        };
        // Every weight of `cosine` is 1, whatever the numbers.
        let (fault, wrong) = if estimator == Estimator::Cosine {
            let from = "f32 {\n    return 1.0;";
            assert!(ends.contains(from), "{from:?} in the kernel");
            ("cosine counted twice", ends.replace(from, "f32 {\n    return polar.y;"))
        } else {
            let outside = "select(-0.5, 2.0, (bits & 1u) == 1u)";
            ("numbers outside of [0, 1)", changed(&scene, number, outside))
        };
        Line {
            case: 29,
            place: format!("u = 0 or 1 - 2^-24 alone, {}", estimator.name()),
            expected: format!("{truth} within {WITHIN}"),
            right: judge(&ends),
            fault,
            wrong: judge(&wrong),
        }
    })
}

/// A floor under many small balls, of which some are lamps.
fn crowd(spheres: u32, lamps: u32, bounces: u32) -> Scene {
    let mut all = vec![sphere([0.0, -1e4, 0.0], 1e4, diffuse(0.7))];
    for i in 1..spheres {
        let [x, y, z] = [i % 8, i / 8 % 8, i / 64].map(f64::from);
        let surface = match i {
            _ if i <= lamps => emitter([4.0; 3]),
            _ if i % 3 == 0 => glossy(0.8, 20.0),
            _ => diffuse(0.6),
        };
        all.push(sphere([x - 3.5, y + 0.5, z - 3.5], 0.3, surface));
    }
    seen([0.0, 4.0, 14.0], [0.0, 3.0, 0.0], size(16, 16), bounces, all)
}

/// 30: loops over more samples and spheres than lavapipe's limit of 65,535 iterations.
fn long_loops() -> [Line; 2] {
    let scene = crowd(300, 40, 2);
    let samples = &[0..256];
    let reference = trace(&mut twin(&scene), samples).0;
    let judge = |text: &str| {
        let (film, ledger) = trace(&mut with_kernel(&scene, text), samples);
        let bias = pair(&film, &reference);
        let accepts = ledger.count == 0 && bias.is_within(MAX_BIAS, ALPHA);
        Verdict { accepts, found: format!("{} invalid, off by {:.0e}", ledger.count, bias.bias[1]) }
    };
    let loops = Line {
        case: 30,
        place: "300 spheres, 256 samples".to_owned(),
        expected: "the twin within 0.1 %".to_owned(),
        right: judge(&kernel(&scene)),
        fault: "a loop cut short",
        wrong: judge(&changed(&scene, "; i < scene.sphere_count; i++", "; i < 200u; i++")),
    };
    let refused = |bounces| {
        let scene = under(&crowd(512, 500, bounces), Estimator::Explicit);
        let refusal = GpuTracer::new(&scene, gpu::open()).err().map(|error| error.to_string());
        let accepts = refusal.is_some_and(|text| text.contains("fewer than"));
        let found = if accepts { "refused" } else { "taken" };
        Verdict { accepts, found: found.to_owned() }
    };
    let limit = Line {
        case: 30,
        place: "512 spheres, 500 lamps, 64 bounces".to_owned(),
        expected: "refused".to_owned(),
        right: refused(64),
        fault: "2 bounces",
        wrong: refused(2),
    };
    [loops, limit]
}

/// A still life, `scale` times as large and `shift` away; coordinates through `rounded`.
fn moved(scale: f64, shift: f64, rounded: &dyn Fn(DVec3) -> DVec3) -> Scene {
    let place = |p: [f64; 3]| rounded(scale * DVec3::from(p) + DVec3::splat(shift));
    let ball = |center, radius, surface| sphere(place(center), scale * radius, surface);
    let spheres = vec![
        ball([0.0, 3.4, -1.0], 1.6, emitter([2.0; 3])),
        ball([0.0, -100.0, 0.0], 100.0, diffuse(0.6)),
        ball([-1.3, 1.0, 0.0], 1.0, diffuse(0.8)),
        ball([1.3, 1.0, 0.5], 1.0, glossy(0.8, 20.0)),
    ];
    let (position, target) = (place([0.0, 1.8, 7.0]), place([0.0, 1.5, 0.0]));
    let camera = Camera::new(position, target, DVec3::Y, 50.0).expect("a camera");
    let settings = RenderSettings::default().with_estimator(Estimator::Mis);
    Scene::new(camera, size(32, 32), settings, spheres)
}

/// 32: the picture does not depend on where the scene is and in which unit. The stated loss
/// is `verify`'s: paths that rounding sends elsewhere.
fn places_and_units() -> impl Iterator<Item = Line> {
    let samples = &[0..256];
    let here = trace(&mut on_device(&moved(1.0, 0.0, &|p| p)), samples).0;
    [
        ("translated by 1e4", 1.0, 1e4),
        ("1e3 times as large", 1e3, 0.0),
        ("1e-3 as large", 1e-3, 0.0),
    ]
    .into_iter()
    .map(move |(name, scale, shift)| {
        let judge = |scale, shift, rounded: &dyn Fn(DVec3) -> DVec3| {
            let there = trace(&mut on_device(&moved(scale, shift, rounded)), samples).0;
            let found = pair(&there, &here);
            let accepts = found.is_within(MAX_BIAS, ALPHA);
            Verdict {
                accepts,
                found: format!("off by {:.0e} ± {:.0e}", found.bias[1], found.error[1]),
            }
        };
        Line {
            case: 32,
            place: format!("a still life {name}"),
            expected: "the same within 0.1 %".to_owned(),
            right: judge(scale, shift, &|p| p),
            fault: "1e-3 as large at 1e4, places in f32",
            wrong: judge(1e-3, 1e4, &|p| p.as_vec3().as_dvec3()),
        }
    })
}

/// 33: leaving out what a scene does not need changes no bit.
fn left_out() -> Line {
    let scene = classic(size(32, 32));
    let plain = crowd(6, 1, 2);
    let judge = |change: &dyn Fn(&str) -> String| {
        let same_bits = |scene: &Scene| {
            let special = film_of(scene, &change(&kernel(scene)), &[0..32]);
            trace(&mut with_effects(scene, Effects::general(scene)), &[0..32]).0 == special
        };
        same(same_bits(&scene) && same_bits(&plain))
    };
    Line {
        case: 33,
        place: "specialised and general kernel".to_owned(),
        expected: "the same bits".to_owned(),
        right: judge(&str::to_owned),
        fault: "a factor of 1 + 2^-23",
        wrong: judge(&|text| text.replace("2.0 * polar.y", "2.0000002 * polar.y")),
    }
}

/// Every picture, judged.
pub fn lines() -> Vec<Line> {
    let mut lines = vec![unproven(), one_mean(), past_32_bits(), divisions(), left_out()];
    lines.extend(sizes());
    lines.extend(extreme_paths());
    lines.extend(long_loops());
    lines.extend(places_and_units());
    lines
}
