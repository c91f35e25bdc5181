//! The twin's hierarchy finds what a loop over all spheres finds, to the bit: hits and
//! shadows, on scenes and rays that look for what boxes could lose.

mod support {
    pub mod scenes;
}
#[path = "../benches/support/volume.rs"]
mod volume;

use candor::cpu::nearest::{Hit, nearest, occluded};
use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sphere::Ray;
use candor::cpu::{PreparedScene, Search};
use candor::range::{self, Arithmetic};
use candor::scene::{Scene, Sphere};
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use support::scenes::{diffuse, many, room, seen, size, sphere};

fn uniform(index: u64, block: u32) -> [f64; 4] {
    random_bits(SampleKey { pixel: 2, index }, block, 11).map(unit_float)
}

fn around(spheres: Vec<Sphere>) -> Scene {
    seen([0.3, 0.2, 4.0], [0.0; 3], size(4, 4), 2, spheres)
}

/// Spheres of unit radius that touch each other in a grid, with exact coordinates.
fn touching() -> Vec<Sphere> {
    let grid = || (-2..=2).map(|i| 2.0 * f64::from(i));
    let centers = grid().flat_map(|x| grid().flat_map(move |y| grid().map(move |z| [x, y, z])));
    centers.filter(|c| c[2] < 3.0).map(|c| sphere(c, 1.0, diffuse(0.5))).collect()
}

/// Spheres in each other that touch in one point, from inside.
fn nested() -> Vec<Sphere> {
    let radius = |i: i32| 1.25_f64.powi(i - 20);
    (0..24).map(|i| sphere([radius(i), 0.0, 0.0], radius(i), diffuse(0.5))).collect()
}

/// Pairs that overlap all but wholly, in both orders of size.
fn coincident() -> Vec<Sphere> {
    let pair = |i: u64| {
        let [x, y, z, w] = uniform(i, 1);
        let center = 4.0 * DVec3::new(x, y, z) - 2.0;
        let nudge = if w < 0.5 { 1.0 + f64::EPSILON } else { 1.0 - f64::EPSILON };
        [sphere(center, 0.25, diffuse(0.5)), sphere(center, 0.25 * nudge, diffuse(0.25))]
    };
    (0..200).flat_map(pair).collect()
}

/// Dust on and beside large spheres, some of which are larger than the scene.
fn dust() -> Vec<Sphere> {
    let mut spheres = vec![
        sphere([0.0, -1e5, 0.0], 1e5, diffuse(0.5)),
        sphere([0.0, 1.0, 0.0], 1.0, diffuse(0.5)),
    ];
    for i in 0..500 {
        let [x, y, z, w] = uniform(i, 2);
        let direction = volume::direction(i, 7);
        let radius = 10_f64.powf(-6.0 * w);
        let center = DVec3::Y + (1.0 + radius) * direction;
        spheres.push(sphere(center, radius * 0.99, diffuse(0.5)));
        spheres.push(sphere([x - 0.5, radius, z + y], radius, diffuse(0.5)));
    }
    spheres
}

/// All of it far from the origin, where `f64` itself is coarse.
fn moved(spheres: Vec<Sphere>, by: DVec3) -> Scene {
    let moved =
        spheres.into_iter().map(|s| sphere(s.center() + by, s.radius(), s.surface())).collect();
    seen(DVec3::new(0.3, 0.2, 4.0) + by, by, size(4, 4), 2, moved)
}

fn scenes() -> Vec<(&'static str, Scene)> {
    vec![
        ("one", around(vec![sphere([0.0; 3], 1.0, diffuse(0.5))])),
        ("many", many(size(4, 4))),
        ("room", room(1e4, true)),
        ("touching", around(touching())),
        ("nested", around(nested())),
        ("coincident", around(coincident())),
        ("dust", around(dust())),
        ("far from the origin", moved(touching(), DVec3::new(1e9, -3e8, 7e7))),
        ("far camera", seen([0.0, 1e7, 3e7], [0.0; 3], size(4, 4), 2, touching())),
        ("volume of 1000", volume::scene(1000, size(4, 4))),
        ("volume of 100000", volume::scene(100_000, size(4, 4))),
    ]
}

/// Rays from the camera, from surfaces and from anywhere; towards anywhere, towards spheres
/// and their rims, and along the axes.
fn rays(scene: &Scene, count: u32) -> Vec<(Ray, Option<usize>)> {
    let (spheres, focus) = (scene.spheres(), Viewpoint::of(scene).focus());
    let extent = Viewpoint::of(scene).extent();
    let chosen = |bits: u32| bits as usize % spheres.len();
    let ray = |index: u32| {
        let axis = DVec3::AXES[index as usize % 3];
        let index = u64::from(index);
        let key = SampleKey { pixel: 2, index };
        let [from, to, start, aim] = random_bits(key, 3, 11);
        let source = &spheres[chosen(from)];
        let normal = volume::direction(index, 4);
        let (origin, leaving) = match start % 4 {
            0 => (scene.camera().position(), None),
            1 => (focus + extent * volume::direction(index, 5), None),
            2 => (source.center() + source.radius() * axis, Some(chosen(from))),
            _ => (source.center() + source.radius() * normal, Some(chosen(from))),
        };
        let target = &spheres[chosen(to)];
        let away = target.center() - origin;
        let across = away.cross(volume::direction(index, 6)).normalize_or(DVec3::X);
        let direction = match aim % 5 {
            0 => away,
            1 => away + target.radius() * across,
            2 => axis,
            3 => -axis,
            _ => volume::direction(index, 8),
        };
        (Ray { origin, direction: direction.normalize_or(DVec3::Z) }, leaving)
    };
    (0..count).map(ray).collect()
}

/// So few rays where the loop is long.
fn budget(scene: &Scene) -> u32 {
    u32::try_from(20_000_000 / scene.spheres().len()).map_or(40_000, |count| count.min(40_000))
}

fn bits(hit: Option<Hit>) -> Option<(u64, usize)> {
    hit.map(|hit| (hit.distance.to_bits(), hit.sphere))
}

#[test]
fn the_hierarchy_finds_the_hits_of_the_loop() {
    for (name, scene) in scenes() {
        let looped = PreparedScene::searched(&scene, Search::Loop);
        let tree = PreparedScene::searched(&scene, Search::Hierarchy);
        let mut hits = 0;
        for (ray, leaving) in rays(&scene, budget(&scene)) {
            let expected = nearest(&looped, &ray, leaving);
            hits += u32::from(expected.is_some());
            let found = nearest(&tree, &ray, leaving);
            assert_eq!(bits(found), bits(expected), "{name}: {ray:?} from {leaving:?}");
        }
        assert!(hits > 50, "{name}: {hits} hits");
    }
}

/// Shadow rays that end just before, at and just behind what they hit.
#[test]
fn the_hierarchy_finds_the_shadows_of_the_loop() {
    for (name, scene) in scenes() {
        let looped = PreparedScene::searched(&scene, Search::Loop);
        let tree = PreparedScene::searched(&scene, Search::Hierarchy);
        let mut hidden = [0; 2];
        for (index, (ray, leaving)) in rays(&scene, budget(&scene)).into_iter().enumerate() {
            let (Some(leaving), Some(hit)) = (leaving, nearest(&looped, &ray, leaving)) else {
                continue;
            };
            let light = [hit.sphere, index % scene.spheres().len()][index % 2];
            for limit in [hit.distance.next_down(), hit.distance, 1.01 * hit.distance, f64::MAX] {
                let expected = occluded(&looped, &ray, leaving, light, limit);
                hidden[usize::from(expected)] += 1;
                let found = occluded(&tree, &ray, leaving, light, limit);
                assert_eq!(found, expected, "{name}: {ray:?} from {leaving}, {light} at {limit}");
            }
        }
        assert!(name == "one" || hidden.iter().all(|&count| count > 50), "{name}: {hidden:?}");
    }
}

/// The scene with its spheres in the opposite order gives ties to the highest place.
#[test]
fn the_rays_tell_a_wrong_tie_rule() {
    for (name, scene) in scenes().into_iter().filter(|(name, _)| *name == "coincident") {
        let spheres: Vec<Sphere> = scene.spheres().iter().rev().cloned().collect();
        let last = spheres.len() - 1;
        let reversed = Scene::new(scene.camera().clone(), scene.size(), scene.settings(), spheres);
        let looped = PreparedScene::searched(&scene, Search::Loop);
        let wrong = PreparedScene::searched(&reversed, Search::Hierarchy);
        let differs = |&(ref ray, leaving): &(Ray, Option<usize>)| {
            let found = nearest(&wrong, ray, leaving.map(|place| last - place));
            let found = found.map(|hit| Hit { sphere: last - hit.sphere, ..hit });
            bits(found) != bits(nearest(&looped, ray, leaving))
        };
        let count = rays(&scene, budget(&scene)).iter().filter(|ray| differs(ray)).count();
        assert!(count > 0, "{name}");
    }
}

/// What the speed of large scenes is measured on is in range, on devices and here.
#[test]
fn the_uniform_volume_is_in_range() {
    for count in [8, 1000, 100_000] {
        let scene = volume::scene(count, size(4, 4));
        let viewpoint = Viewpoint::of(&scene);
        for arithmetic in [Arithmetic::Single, Arithmetic::Double] {
            assert_eq!(range::check(&scene, &viewpoint, arithmetic), Ok(()), "{count}");
        }
    }
}
