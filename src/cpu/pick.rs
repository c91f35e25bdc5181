//! Which light is sampled: half of the time in proportion to a bound on what it can
//! contribute, half of the time evenly, as in `shaders/pick_scan.wgsl`; many are left to
//! [`walk`](super::walk).

use super::light::{Cone, cone_of};
use super::rng::{SampleKey, random_bits, unit_float};
use super::scene::{PreparedScene, PreparedSphere};
use super::trace::SurfacePoint;
use super::walk::{chance_of_leaf, pick_leaf};
use crate::scene::Surface;
use glam::DVec3;

/// The blocks of random numbers from here on pick lights.
pub(super) const PICK_BLOCKS: u32 = 128;

/// A light and the probability of picking it.
pub(super) struct Pick {
    pub(super) light: usize,
    pub(super) chance: f64,
}

/// Largest cosine of a direction in a cone: cos(θ − σ) for an axis at the angle θ > σ from
/// the normal, never below 0.
pub(super) fn largest_cosine(cone: &Cone, normal: DVec3) -> f64 {
    let cos_theta = cone.axis.dot(normal).clamp(-1.0, 1.0);
    let cos_sigma = 1.0 - cone.height;
    if cos_theta >= cos_sigma { 1.0 } else { (cos_theta.acos() - cos_sigma.acos()).cos().max(0.0) }
}

/// height · brightest channel · largest cosine.
fn potential(light: &PreparedSphere, point: &SurfacePoint) -> f64 {
    let Surface::Emitter(radiance) = light.surface else { return 0.0 };
    let cone = cone_of(light, point);
    cone.height * largest_cosine(&cone, point.normal) * radiance.rgb().max_element()
}

/// Chances of all lights, in their order. A point that none of them can light picks evenly.
fn chances(scene: &PreparedScene, point: &SurfacePoint) -> Vec<f64> {
    let potentials: Vec<f64> =
        scene.lights.iter().map(|&light| potential(&scene.spheres[light], point)).collect();
    let total: f64 = potentials.iter().sum();
    #[expect(clippy::cast_precision_loss, reason = "a count of spheres")]
    let even = 1.0 / scene.lights.len() as f64;
    let chance = |potential: f64| 0.5 * (potential / total + even);
    potentials.into_iter().map(|p| if total > 0.0 { chance(p) } else { even }).collect()
}

/// Picks a light for a vertex.
pub(super) fn pick_light(
    scene: &PreparedScene,
    point: &SurfacePoint,
    key: SampleKey,
    bounce: u32,
) -> Pick {
    if let [light] = scene.lights[..] {
        return Pick { light, chance: 1.0 };
    }
    if let Some(tree) = &scene.light_tree {
        let (leaf, chance) = pick_leaf(tree, point, key, bounce, scene.seed);
        return Pick { light: tree.lights()[leaf - tree.lights().len()], chance };
    }
    let chances = chances(scene, point);
    let u = unit_float(random_bits(key, PICK_BLOCKS + bounce, scene.seed)[0]);
    let mut sum = 0.0;
    let last = chances.len() - 1;
    let place = chances.iter().position(|chance| {
        sum += chance;
        u < sum
    });
    let place = place.unwrap_or(last);
    Pick { light: scene.lights[place], chance: chances[place] }
}

/// Probability of picking a light that a path hit by itself.
pub(super) fn chance_of(scene: &PreparedScene, light: usize, point: &SurfacePoint) -> f64 {
    if scene.lights.len() == 1 {
        return 1.0;
    }
    if let Some(tree) = &scene.light_tree {
        return chance_of_leaf(tree, tree.leaves()[light], point);
    }
    let chances = chances(scene, point);
    let of_light = std::iter::zip(&scene.lights, chances).find(|&(&other, _)| other == light);
    of_light.map_or(0.0, |(_, chance)| chance)
}
