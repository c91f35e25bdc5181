//! The tree over many lights: every light is one leaf, every node holds what is under it, and
//! the same scene gives the same tree.

mod support {
    pub mod scenes;
}

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::effects::{Effect, Effects};
use candor::light_tree::{LightTree, Node, SCANNED_LIGHTS, most_iterations};
use candor::scene::{Estimator, Scene, Sphere};
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use support::scenes::{diffuse, emitter, seen, size, sphere};

/// Balls and lamps in turn, at random places and of random sizes.
fn lamps(count: u32) -> Scene {
    let spheres = (0..count).flat_map(|index| -> [Sphere; 2] {
        let key = SampleKey { pixel: 5, index: u64::from(index) };
        let [x, y, z, size] = random_bits(key, 0, 0).map(unit_float);
        let place = 8.0 * DVec3::new(x, y, z) - DVec3::new(4.0, 4.0, 14.0);
        let lamp = emitter([1.0 + f64::from(index % 7), 0.5, 0.25]);
        [sphere(place + 9.0 * DVec3::X, 0.01, diffuse(0.5)), sphere(place, 0.02 + 0.1 * size, lamp)]
    });
    seen([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], size(8, 8), 1, spheres.collect())
}

fn tree_of(scene: &Scene) -> LightTree {
    LightTree::of(scene, &Viewpoint::of(scene))
}

/// The leaves under a node.
fn under(node: usize, count: usize) -> Vec<usize> {
    if node >= count {
        return vec![node];
    }
    [under(2 * node, count), under(2 * node + 1, count)].concat()
}

#[test]
fn every_light_is_one_leaf() {
    for count in (0..70).chain([255, 256, 257, 1000]) {
        let scene = lamps(count);
        let (tree, count) = (tree_of(&scene), count as usize);
        assert_eq!(tree.nodes().len(), 2 * count);
        let mut lights = tree.lights().to_vec();
        lights.sort_unstable();
        assert_eq!(lights, (0..count).map(|i| 2 * i + 1).collect::<Vec<_>>());
        for (place, &leaf) in tree.leaves().iter().enumerate() {
            assert_eq!(leaf == 0, place % 2 == 0);
            assert!(leaf == 0 || tree.lights()[leaf - count] == place);
        }
    }
}

/// Spheres hold their lights, but for rounding, and shine like them together.
#[test]
fn nodes_hold_what_is_under_them() {
    for count in [1_usize, 2, 3, 17, 300] {
        let scene = lamps(u32::try_from(count).expect("few"));
        let tree = tree_of(&scene);
        for number in 1..2 * count {
            let node = &tree.nodes()[number];
            let leaves = under(number, count);
            let reach = |leaf: &usize| {
                let Node { center, radius, .. } = tree.nodes()[*leaf];
                center.distance(node.center) + radius
            };
            let farthest = leaves.iter().map(reach).fold(0.0, f64::max);
            assert!(farthest <= node.radius * (1.0 + 1e-14), "{number} of {count}");
            let power = |node: &Node| node.brightness * node.radius * node.radius;
            let sum: f64 = leaves.iter().map(|&leaf| power(&tree.nodes()[leaf])).sum();
            assert!((power(node) / sum - 1.0).abs() < 1e-12, "{number} of {count}");
        }
        for (leaf, &place) in (count..).zip(tree.lights()) {
            let (node, sphere) = (&tree.nodes()[leaf], &scene.spheres()[place]);
            assert_eq!((node.center, node.radius), (sphere.center(), sphere.radius()));
            let color = f64::from(u32::try_from(place / 2 % 7).expect("few"));
            assert_eq!(node.brightness.to_bits(), (1.0 + color).to_bits());
        }
    }
}

/// Where lights stand in a row, every node holds a stretch of it.
#[test]
fn neighbours_stay_together() {
    let place = |i: u32| DVec3::new(f64::from(i * 37 % 101), 0.1 * f64::from(i % 2), -5.0);
    let spheres = (0..101).map(|i| sphere(place(i), 0.1, emitter([1.0; 3]))).collect();
    let scene = seen([50.0, 0.0, 90.0], [50.0, 0.0, 0.0], size(8, 8), 1, spheres);
    let tree = tree_of(&scene);
    for number in 1..202 {
        let xs = under(number, 101).into_iter().map(|leaf| tree.nodes()[leaf].center.x);
        let (mut low, mut high, mut count) = (f64::INFINITY, 0.0_f64, 0.0);
        for x in xs {
            (low, high, count) = (low.min(x), high.max(x), count + 1.0);
        }
        assert_eq!((high - low + 1.0).to_bits(), f64::to_bits(count), "node {number}");
    }
}

/// Lights at one place, with one thread and with several.
#[test]
fn one_scene_has_one_tree() {
    let mut spheres = lamps(10_000).spheres().to_vec();
    let (place, lamp) = (DVec3::new(0.0, 0.0, -9.0), emitter([1.0; 3]));
    spheres.extend((1..9_000).map(|i| sphere(place, 1e-4 * f64::from(i), lamp)));
    let scene = seen([0.0, 0.0, 0.0], [0.0, 0.0, -1.0], size(8, 8), 1, spheres);
    let with = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| tree_of(&scene))
    };
    assert_eq!(with(1), with(4));
}

#[test]
fn trees_are_for_many_lights_that_are_sampled() {
    let few = lamps(u32::try_from(SCANNED_LIGHTS).expect("few"));
    let many = lamps(u32::try_from(SCANNED_LIGHTS).expect("few") + 1);
    for estimator in Estimator::ALL {
        let has = |scene: &Scene| {
            let settings = scene.settings().with_estimator(estimator);
            let scene = scene.clone().with_settings(settings);
            Effects::of(&scene, &Viewpoint::of(&scene)).has(Effect::LightTree)
        };
        assert!(!has(&few));
        assert_eq!(has(&many), estimator.samples_lights());
    }
    // Two scans and one; two walks of five turns by two.
    assert_eq!(most_iterations(SCANNED_LIGHTS), 3 * (SCANNED_LIGHTS as u64 + 1));
    assert_eq!(most_iterations(1 << 10), 2 * (5 + 1));
    assert_eq!(most_iterations((1 << 10) + 1), 2 * (6 + 1));
}
