//! One path that counts light only where it hits it by itself, as in
//! `shaders/path_blind.wgsl`.

use super::nearest::nearest;
use super::rng::{SampleKey, random_bits, unit_floats};
use super::scene::PreparedScene;
use super::sphere::Ray;
use super::trace::{Path, scatter, surface_point};
use crate::scene::Surface;

/// Follows one segment and scatters at its end; whether the path goes on.
pub(super) fn advance(path: &mut Path, scene: &PreparedScene, key: SampleKey, bounce: u32) -> bool {
    let Some(hit) = nearest(scene, &path.ray, path.leaving) else { return false };
    let sphere = &scene.spheres[hit.sphere];
    if let Surface::Emitter(radiance) = sphere.surface {
        path.radiance = path.throughput * radiance.rgb();
        return false;
    }
    if bounce == scene.bounces {
        return false;
    }
    let point = surface_point(&path.ray, hit, sphere);
    let u = unit_floats(random_bits(key, bounce + 1, scene.seed));
    let (albedo, scattering) =
        scatter(scene.estimator, sphere.surface, point.normal, path.ray.direction, u);
    if scattering.weight == 0.0 {
        return false;
    }
    path.throughput *= scattering.weight * albedo.rgb();
    path.ray = Ray { origin: point.position, direction: scattering.direction };
    path.leaving = Some(hit.sphere);
    true
}
