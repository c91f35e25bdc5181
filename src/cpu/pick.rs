//! Which light is sampled: half of the time in proportion to a bound on what it can
//! contribute, half of the time evenly, as in `shaders/pick_many.wgsl`.

use super::light::cone_of;
use super::rng::{SampleKey, random_bits, unit_float};
use super::scene::{PreparedScene, PreparedSphere};
use super::trace::SurfacePoint;
use crate::scene::Surface;

/// The blocks of random numbers from here on pick lights.
const PICK_BLOCKS: u32 = 128;

/// A light and the probability of picking it.
pub(super) struct Pick {
    pub(super) light: usize,
    pub(super) chance: f64,
}

/// height · brightest channel · largest cosine of a direction in the cone. That cosine is
/// cos(θ − σ) for a centre at the angle θ > σ from the normal.
fn potential(light: &PreparedSphere, point: &SurfacePoint) -> f64 {
    let Surface::Emitter(radiance) = light.surface else { return 0.0 };
    let cone = cone_of(light, point);
    let cos_theta = cone.axis.dot(point.normal).clamp(-1.0, 1.0);
    let cos_sigma = 1.0 - cone.height;
    let cosine = if cos_theta >= cos_sigma {
        1.0
    } else {
        (cos_theta.acos() - cos_sigma.acos()).cos().max(0.0)
    };
    cone.height * cosine * radiance.rgb().max_element()
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
    let chances = chances(scene, point);
    let of_light = std::iter::zip(&scene.lights, chances).find(|&(&other, _)| other == light);
    of_light.map_or(0.0, |(_, chance)| chance)
}
