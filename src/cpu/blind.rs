//! One path that counts light only where it hits it by itself, as in
//! `shaders/path_blind.wgsl`.

use super::nearest::nearest;
use super::rng::{SampleKey, random_bits, unit_floats};
use super::scene::PreparedScene;
use super::sphere::Ray;
use super::trace::{scatter, surface_point};
use crate::scene::Surface;
use glam::DVec3;

/// Follows the path that starts with `ray`.
pub(super) fn trace(scene: &PreparedScene, key: SampleKey, mut ray: Ray) -> DVec3 {
    let mut throughput = DVec3::ONE;
    let mut leaving = None;
    for bounce in 0..=scene.bounces {
        let Some(hit) = nearest(scene, &ray, leaving) else { break };
        let sphere = &scene.spheres[hit.sphere];
        if let Surface::Emitter(radiance) = sphere.surface {
            return throughput * radiance.rgb();
        }
        if bounce == scene.bounces {
            break;
        }
        let point = surface_point(&ray, hit, sphere);
        let u = unit_floats(random_bits(key, bounce + 1, scene.seed));
        let (albedo, scattering) =
            scatter(scene.estimator, sphere.surface, point.normal, ray.direction, u);
        if scattering.weight == 0.0 {
            break;
        }
        throughput *= scattering.weight * albedo.rgb();
        ray = Ray { origin: point.position, direction: scattering.direction };
        leaving = Some(hit.sphere);
    }
    DVec3::ZERO
}
