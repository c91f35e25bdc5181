//! One path: from the camera to a light, to nowhere, or to its last bounce, as in
//! `shaders/trace.wgsl`.

use super::interior::facing_normal;
use super::material::{scatter_diffuse, scatter_glossy};
use super::nearest::{Hit, nearest};
use super::rng::{SampleKey, random_bits, unit_floats};
use super::scene::{Pinhole, PreparedScene, PreparedSphere};
use super::sphere::Ray;
use crate::scene::Surface;
use glam::{DVec2, DVec3};

/// A point that was hit.
struct SurfacePoint {
    position: DVec3,
    /// Unit normal on the side that the ray came from.
    normal: DVec3,
}

/// The point is put back onto the surface along the normal, which takes off most of
/// the rounding of the distance.
fn surface_point(ray: &Ray, hit: Hit, sphere: &PreparedSphere) -> SurfacePoint {
    let reached = ray.origin + hit.distance * ray.direction;
    let outward = (reached - sphere.center).normalize();
    SurfacePoint {
        position: sphere.center + sphere.radius * outward,
        normal: facing_normal(outward, sphere),
    }
}

/// The ray through a point of the pixel drawn uniformly (box filter).
fn camera_ray(camera: &Pinhole, pixel: u32, u: DVec2) -> Ray {
    let (column, row) = (pixel % camera.width, pixel / camera.width);
    let x = 2.0 * (f64::from(column) + u.x) / f64::from(camera.width) - 1.0;
    let y = 1.0 - 2.0 * (f64::from(row) + u.y) / f64::from(camera.height);
    let direction = (camera.forward + x * camera.right + y * camera.up).normalize();
    Ray { origin: camera.origin, direction }
}

/// The radiance that one sample brings back, whole: not rounded to `f32`.
#[must_use]
pub fn trace(scene: &PreparedScene, key: SampleKey) -> DVec3 {
    let random = |block| unit_floats(random_bits(key, block, scene.seed));
    let mut ray = camera_ray(&scene.camera, key.pixel, random(0));
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
        let u = random(bounce + 1);
        let (albedo, scattering) = match sphere.surface {
            Surface::Emitter(_) => unreachable!("an emitter ends the path"),
            Surface::Diffuse(albedo) => (albedo, scatter_diffuse(point.normal, u)),
            Surface::Glossy(albedo, exponent) => {
                let lobe = scatter_glossy(point.normal, ray.direction, exponent.get(), u);
                (albedo, lobe)
            }
        };
        if scattering.weight == 0.0 {
            break;
        }
        throughput *= scattering.weight * albedo.rgb();
        ray = Ray { origin: point.position, direction: scattering.direction };
        leaving = Some(hit.sphere);
    }
    DVec3::ZERO
}
