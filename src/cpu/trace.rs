//! What every path needs: where it starts, what it hits, how it goes on; as in
//! `shaders/camera.wgsl` and `surface.wgsl`.

use super::interior::facing_normal;
use super::material::{Scattering, scatter_cosine, scatter_diffuse, scatter_glossy};
use super::nearest::Hit;
use super::rng::{SampleKey, random_bits, unit_floats};
use super::scene::{PreparedScene, PreparedSphere};
use super::sphere::Ray;
use super::{blind, connected};
use crate::scene::{Albedo, Estimator, Surface};
use glam::{DVec2, DVec3};

/// A point that was hit.
#[derive(Debug, Clone, Copy)]
pub(super) struct SurfacePoint {
    pub(super) position: DVec3,
    /// Unit normal on the side that the ray came from.
    pub(super) normal: DVec3,
}

/// The point is put back onto the surface along the normal, which takes off most of
/// the rounding of the distance.
pub(super) fn surface_point(ray: &Ray, hit: Hit, sphere: &PreparedSphere) -> SurfacePoint {
    let reached = ray.origin + hit.distance * ray.direction;
    let outward = (reached - sphere.center).normalize();
    SurfacePoint {
        position: sphere.center + sphere.radius * outward,
        normal: facing_normal(outward, sphere),
    }
}

/// Scatters at a surface that does not emit; the albedo beside it.
pub(super) fn scatter(
    estimator: Estimator,
    surface: Surface,
    normal: DVec3,
    incoming: DVec3,
    u: DVec2,
) -> (Albedo, Scattering) {
    match surface {
        Surface::Emitter(_) => unreachable!("an emitter ends the path"),
        Surface::Diffuse(albedo) if estimator == Estimator::Implicit => {
            (albedo, scatter_diffuse(normal, u))
        }
        Surface::Diffuse(albedo) => (albedo, scatter_cosine(normal, u)),
        Surface::Glossy(albedo, exponent) => {
            (albedo, scatter_glossy(normal, incoming, exponent.get(), u))
        }
    }
}

/// The ray of a sample, through a point of its pixel drawn uniformly (box filter).
#[must_use]
pub fn camera_ray(scene: &PreparedScene, key: SampleKey) -> Ray {
    let (camera, pixel) = (&scene.camera, key.pixel);
    let u = unit_floats(random_bits(key, 0, scene.seed));
    let (column, row) = (pixel % camera.width, pixel / camera.width);
    let x = 2.0 * (f64::from(column) + u.x) / f64::from(camera.width) - 1.0;
    let y = 1.0 - 2.0 * (f64::from(row) + u.y) / f64::from(camera.height);
    let direction = (camera.forward + x * camera.right + y * camera.up).normalize();
    Ray { origin: camera.origin, direction }
}

/// How a path left its last vertex.
#[derive(Debug, Clone, Copy)]
pub(super) struct Departure {
    pub(super) point: SurfacePoint,
    /// Density of the direction, per steradian.
    pub(super) density: f64,
    /// Whether nothing but this direction could find the light that it hits.
    pub(super) alone: bool,
}

/// A path under way.
#[derive(Debug, Clone, Copy)]
pub(super) struct Path {
    pub(super) ray: Ray,
    pub(super) throughput: DVec3,
    /// The sphere that the ray starts on.
    pub(super) leaving: Option<usize>,
    /// Only paths that sample lights ask for it.
    pub(super) departure: Departure,
    pub(super) radiance: DVec3,
}

impl Path {
    /// The path of a sample, at the camera.
    pub(super) fn start(scene: &PreparedScene, key: SampleKey) -> Self {
        let ray = camera_ray(scene, key);
        let eye = SurfacePoint { position: ray.origin, normal: ray.direction };
        Self {
            ray,
            throughput: DVec3::ONE,
            leaving: None,
            departure: Departure { point: eye, density: 0.0, alone: true },
            radiance: DVec3::ZERO,
        }
    }
}

/// Whether paths sample lights where they scatter.
pub(super) fn connects(scene: &PreparedScene) -> bool {
    scene.estimator.samples_lights() && !scene.lights.is_empty()
}

/// The radiance that one sample brings back, whole: not rounded to `f32`.
#[must_use]
pub fn trace(scene: &PreparedScene, key: SampleKey) -> DVec3 {
    if connects(scene) {
        follow(scene, key, |path, bounce| connected::advance(path, scene, key, bounce))
    } else {
        follow(scene, key, |path, bounce| blind::advance(path, scene, key, bounce))
    }
}

/// Follows a path from segment to segment.
fn follow(
    scene: &PreparedScene,
    key: SampleKey,
    mut advance: impl FnMut(&mut Path, u32) -> bool,
) -> DVec3 {
    let mut path = Path::start(scene, key);
    let mut bounce = 0;
    while bounce <= scene.bounces && advance(&mut path, bounce) {
        bounce += 1;
    }
    path.radiance
}
