//! The sphere that a ray meets first, as in `shaders/nearest.wgsl`.
//!
//! Every sphere is met in factored form: `f64` leaves a hit point within about
//! 4·2⁻⁵³·R of the surface along its normal, 5e-11 for a wall of radius 1e5 and 5e-7
//! for one of 1e9, in scene units.

use super::interior::distance_to;
use super::scene::PreparedScene;
use super::sphere::{MISS, Ray, factored};

/// A sphere that was hit, and how far away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Hit {
    pub(super) distance: f64,
    pub(super) sphere: usize,
}

/// `leaving` is the sphere that the ray starts on. The strict comparison leaves the
/// lowest index where distances are equal.
pub(super) fn nearest(scene: &PreparedScene, ray: &Ray, leaving: Option<usize>) -> Option<Hit> {
    let mut best = Hit { distance: MISS, sphere: usize::MAX };
    for (i, sphere) in scene.spheres.iter().enumerate() {
        let q = factored(ray, sphere.center, sphere.radius);
        let distance = distance_to(q, sphere, leaving == Some(i));
        if distance < best.distance {
            best = Hit { distance, sphere: i };
        }
    }
    (best.distance < MISS).then_some(best)
}

/// Whether a sphere other than `light` is seen first: one that is nearer than `distance`, or
/// as near and earlier in the scene file.
pub(super) fn occluded(
    scene: &PreparedScene,
    ray: &Ray,
    leaving: usize,
    light: usize,
    distance: f64,
) -> bool {
    let mut others = scene.spheres.iter().enumerate().filter(|&(i, _)| i != light);
    others.any(|(i, sphere)| {
        let q = factored(ray, sphere.center, sphere.radius);
        let other = distance_to(q, sphere, leaving == i);
        if i < light { other <= distance } else { other < distance }
    })
}
