//! The chances with which one of many lights is picked by a walk down the tree, on the device:
//! against `f64`, against the promise that none is below half of an even one, and in
//! distribution. Kernels that are wrong on purpose are told by the same judge.

#![expect(clippy::cast_precision_loss, reason = "counts of lights and picks")]

mod support {
    pub mod gpu;
    pub mod light_scenes;
    pub mod picks;
    pub mod scenes;
    pub mod tracers;
}

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sampling::{around, polar_hemisphere};
use candor::effects::{Effect, Effects};
use candor::gpu::GpuTracer;
use candor::kernel::{Packed, layout::LightNode, probe_source};
use candor::light_tree::SCANNED_LIGHTS;
use candor::scene::{Estimator, Scene};
use candor::viewpoint::Viewpoint;
use glam::{DVec3, Vec3};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use support::light_scenes::lamp_layer;
use support::picks::{Point, ask, packed};
use support::scenes::{emitter, sphere};
use support::tracers::film;

const U: f64 = 1.0 / (1 << 24) as f64;

/// Chance that a correct kernel fails the test in distribution.
const FAMILY: f64 = 1e-6;

/// Most lamps that are scanned.
fn scanned() -> u32 {
    u32::try_from(SCANNED_LIGHTS).expect("a few hundred")
}

/// Sixty lamps in a light that holds the camera, beside one that is larger than the scene.
fn in_sky() -> Scene {
    let layer = lamp_layer(60, 4.0);
    let mut spheres = layer.spheres().to_vec();
    spheres.push(sphere([0.0, 0.0, 0.0], 30.0, emitter([0.5, 1.0, 2.0])));
    spheres.push(sphere([0.0, 500.0, 0.0], 400.0, emitter([3.0, 2.0, 1.0])));
    Scene::new(layer.camera().clone(), layer.size(), layer.settings(), spheres)
}

/// A probe that walks down the tree, however few lights there are.
fn walking_probe() -> String {
    let constant = format!("const SCANNED_LIGHTS: u32 = {}u;", scanned());
    let text = probe_source();
    assert_eq!(text.matches(&constant).count(), 1);
    text.replace(&constant, "const SCANNED_LIGHTS: u32 = 0u;")
}

/// Distance from a node's centre in radii; none from a node without a sphere.
fn radii(node: &LightNode, point: &Point) -> Option<f64> {
    let away = (Vec3::from_array(node.center) - point.position).as_dvec3().length();
    (node.brightness > 0.0).then(|| away / f64::from(node.radius))
}

/// Points within the scene and off the nodes' surfaces, where rounding decides whether they
/// are inside.
fn points(packed: &Packed, count: usize) -> Vec<Point> {
    let draw = |index, block| random_bits(SampleKey { pixel: 8, index }, block, 0).map(unit_float);
    let point = |index| {
        let [turn, rise, side, _] = draw(index, 1);
        let up = around(DVec3::Z, polar_hemisphere(rise), turn);
        let normal = if side < 0.5 { up } else { -up };
        let position = 2.0 * DVec3::from_slice(&draw(index, 0)) - DVec3::ONE;
        Point { position: position.as_vec3(), normal: normal.as_vec3() }
    };
    let clear = |p: &Point| {
        let off = |node| radii(node, p).is_none_or(|radii| (radii - 1.0).abs() > 1e-4);
        packed.light_tree.iter().all(off)
    };
    (0..).map(point).filter(clear).take(count).collect()
}

/// What a node is worth, by angles and in `f64`; and how far off it may be: 32 roundings of
/// the height, 16 of a cosine made of products of sines and cosines, and 8 of the cone's
/// squared cosine, which its root divides by twice that cosine.
fn potential(node: &LightNode, point: &Point) -> (f64, f64) {
    let (brightness, everywhere) = (f64::from(node.brightness), f64::from(node.everywhere));
    let to_center = (Vec3::from_array(node.center) - point.position).as_dvec3();
    let Some(radii) = radii(node, point) else { return (everywhere, 0.0) };
    if radii <= 1.0 {
        return (brightness + everywhere, U * (brightness + everywhere));
    }
    let sigma = radii.recip().asin();
    let theta = to_center.angle_between(point.normal.as_dvec3());
    let cosine = (theta - sigma).max(0.0).cos().max(0.0);
    let whole = 2.0 * (sigma / 2.0).sin().powi(2) * brightness;
    let off = 32.0 * cosine + 16.0 + 8.0 / sigma.cos();
    (whole * cosine + everywhere, U * (whole * off + everywhere))
}

/// Chances of all leaves and how far off they may be: products of turns, each of which is off
/// by its potentials' errors, by a step of the numbers that decide it and by four roundings.
fn chances(tree: &[LightNode], point: &Point) -> Vec<(f64, f64)> {
    let count = tree.len() / 2;
    // Potentials of a node's children, or of a leaf.
    let below = |node: usize| -> (f64, f64) {
        let children = if node < count { vec![2 * node, 2 * node + 1] } else { vec![node] };
        let each = children.into_iter().map(|node| potential(&tree[node], point));
        each.fold((0.0, 0.0), |sum, p| (sum.0 + p.0, sum.1 + p.1))
    };
    let mut walked = vec![(1.0, 1.0); 2 * count];
    for child in 2..2 * count {
        // Two turns, from the root on, are decided by the nodes two below the first.
        let side = |node: usize| {
            if node.ilog2() % 2 == 1 { below(node) } else { potential(&tree[node], point) }
        };
        let (own, other) = (side(child), side(child ^ 1));
        let total = own.0 + other.0;
        let (share, off) = if total > 0.0 {
            let share = own.0 / total;
            (share, (own.1 * (1.0 - share) + other.1 * share) / total)
        } else {
            (0.5, 0.0)
        };
        let parent = walked[child / 2];
        walked[child] = (parent.0 * share, parent.1 * (share + off + U + 4.0 * U * share));
    }
    let even = 0.5 / count as f64;
    walked[count..].iter().map(|w| (0.5 * w.0 + even, 0.5 * (w.1 - w.0) + 4.0 * U)).collect()
}

/// What is wrong with the chances of one scene's lights, and how near to their bound they come.
fn judge_chances(packed: &Packed, wgsl: &str, points: &[Point]) -> (Vec<String>, f64) {
    let count = packed.light_tree.len() / 2;
    let leaves = &packed.light_tree[count..];
    let questions: Vec<(Point, u32)> =
        points.iter().flat_map(|&p| leaves.iter().map(move |leaf| (p, leaf.light))).collect();
    let found = ask(packed, wgsl, &questions);
    let (mut wrong, mut worst) = (Vec::new(), 0.0_f64);
    for (point, found) in points.iter().zip(found.chunks(count)) {
        let sum: f64 = found.iter().map(|f| f64::from(f.0)).sum();
        // Products of at most 20 turns, and the even half.
        if (sum - 1.0).abs() > 24.0 * U {
            wrong.push(format!("{point:?}: they sum to {sum}"));
        }
        for (&(chance, picked, own), (truth, bound)) in
            found.iter().zip(chances(&packed.light_tree, point))
        {
            let off = (f64::from(chance) - truth).abs();
            worst = worst.max(off / bound);
            if off > bound {
                wrong.push(format!("{point:?}: {chance} for {truth} within {bound:e}"));
            }
            if f64::from(chance) < 0.5 / count as f64 * (1.0 - 2.0 * U) {
                wrong.push(format!("{point:?}: {chance} is less than half of an even one"));
            }
            // The light that is picked has the chance that it is asked for.
            let at = leaves.iter().position(|leaf| leaf.light == picked);
            if at.is_none_or(|at| found[at].0.to_bits() != own.to_bits()) {
                wrong.push(format!("{point:?}: {picked} is picked with {own}"));
            }
        }
    }
    (wrong, worst)
}

#[test]
fn chances_are_those_of_the_tree_and_none_is_small() {
    let layers = [(2, 200), (3, 200), (5, 200), (17, 200), (64, 100), (300, 40)];
    let layers = layers.map(|(count, points)| (lamp_layer(count, 4.0), points));
    for (scene, count_of_points) in layers.into_iter().chain([(in_sky(), 100)]) {
        let packed = packed(&scene);
        let count = packed.lights.len();
        let points = points(&packed, count_of_points);
        let (wrong, worst) = judge_chances(&packed, &walking_probe(), &points);
        let around = packed.light_tree[1].everywhere;
        println!("{count} lights, {around} around: chances at {worst:.2} of their bound");
        assert!(wrong.is_empty(), "{count} lights, {} are wrong: {}", wrong.len(), wrong[0]);
    }
}

/// χ² of picks at one point, the lights that expect less than 5 in one cell.
fn p_value(packed: &Packed, wgsl: &str, point: Point) -> f64 {
    const PICKS: usize = 1 << 16;
    let count = packed.light_tree.len() / 2;
    let leaves = &packed.light_tree[count..];
    let found = ask(packed, wgsl, &vec![(point, leaves[0].light); PICKS]);
    let expected = chances(&packed.light_tree, &point);
    let cells = leaves.iter().zip(expected).map(|(leaf, (chance, _))| {
        let observed = found.iter().filter(|f| f.1 == leaf.light).count() as f64;
        (observed, PICKS as f64 * chance)
    });
    let (thin, mut cells): (Vec<_>, Vec<_>) = cells.partition(|cell| cell.1 < 5.0);
    cells.push(thin.iter().fold((0.0, 0.0), |sum, c| (sum.0 + c.0, sum.1 + c.1)));
    cells.retain(|cell| cell.1 >= 5.0);
    let sum: f64 = cells.iter().map(|(o, e)| (o - e).powi(2) / e).sum();
    ChiSquared::new(cells.len() as f64 - 1.0).expect("several cells").sf(sum)
}

#[test]
fn picks_follow_their_chances() {
    let packed = packed(&lamp_layer(300, 4.0));
    for point in points(&packed, 4) {
        let p = p_value(&packed, &walking_probe(), point);
        println!("{:?}: p = {p:.4}", point.position);
        assert!(p > FAMILY / 4.0, "{point:?}: p = {p:e}");
    }
}

/// The general kernel chooses by the number of lights.
#[test]
#[expect(clippy::single_range_in_vec_init, reason = "one range of samples")]
fn the_general_kernel_has_the_same_bits() {
    for scene in [lamp_layer(scanned(), 1.0), lamp_layer(scanned() + 1, 1.0)] {
        let scene = scene.clone().with_settings(scene.settings().with_estimator(Estimator::Mis));
        let own = Effects::of(&scene, &Viewpoint::of(&scene));
        let other = if own.has(Effect::LightTree) { Effect::LightScan } else { Effect::LightTree };
        let pixels = |effects| {
            let tracer = GpuTracer::with_effects(&scene, support::gpu::open(), effects);
            let mut tracer = tracer.expect("the device takes the scene");
            film(&mut tracer, &[0..16]).pixels().to_vec()
        };
        assert!(pixels(own) == pixels(own.with(other)), "{} spheres", scene.spheres().len());
    }
}

/// What is wrong, what stands in the kernel, and what takes its place.
const FAULTS: [(&str, &str, &str); 8] = [
    (
        "children exchanged",
        "node_potential(2u * node, point), node_potential(2u * node + 1u, point)",
        "node_potential(2u * node + 1u, point), node_potential(2u * node, point)",
    ),
    ("no even half", "0.5 * walked + 0.5 / f32(scene.light_count)", "walked"),
    ("turns to the other side", "select(toward == below,", "select(toward != below,"),
    (
        "turns from the last to the first",
        "let toward = to >> ((firstLeadingBit(to) - firstLeadingBit(below)) & 31u);",
        "let digits = (reverseBits(to) >> (31u - firstLeadingBit(to))) >> 1u;
    let turned = digits | (1u << firstLeadingBit(to));
    let toward = turned >> ((firstLeadingBit(to) - firstLeadingBit(below)) & 31u);",
    ),
    (
        "chance of the other side",
        "select(1.0 - chance, chance, goes_left)",
        "select(chance, 1.0 - chance, goes_left)",
    ),
    (
        "the share's root",
        "round(left / total * 16777216.0) * 5.9604644775390625e-8",
        "sqrt(left / total)",
    ),
    ("twice the same numbers", "select(bits.zwxy, pcg4d(bits), fresh)", "bits"),
    (
        "even picks of the first half",
        "evenly(bits.y, bits.z, scene.light_count)",
        "evenly(bits.y, bits.z, scene.light_count / 2u)",
    ),
];

#[test]
fn faults_are_told() {
    let packed = packed(&lamp_layer(256, 4.0));
    let points = points(&packed, 3);
    for (fault, from, to) in FAULTS {
        let right = walking_probe();
        assert_eq!(right.matches(from).count(), 1, "{fault}: occurrences of {from:?}");
        let text = right.replace(from, to);
        let (wrong, _) = judge_chances(&packed, &text, &points);
        let p = points.iter().map(|&point| p_value(&packed, &text, point)).fold(1.0, f64::min);
        println!("{fault}: {} wrong chances, p = {p:.1e}", wrong.len());
        assert!(!wrong.is_empty() || p < FAMILY, "{fault} is not told");
    }
}
