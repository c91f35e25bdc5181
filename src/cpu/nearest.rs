//! The sphere that a ray meets first, as in `shaders/nearest.wgsl`.
//!
//! Every sphere is met in factored form: `f64` leaves a hit point within about
//! 4·2⁻⁵³·R of the surface along its normal, 5e-11 for a wall of radius 1e5 and 5e-7
//! for one of 1e9, in scene units.

use super::interior::distance_to;
use super::scene::PreparedScene;
use super::sphere::{MISS, Ray, entry, factored};

/// A sphere that was hit, and how far away.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Along the ray, in scene units; 0 or more.
    pub distance: f64,
    /// Its place in the scene.
    pub sphere: usize,
}

impl Hit {
    /// The earlier one; of two at the same distance, that of the lower place.
    fn or(self, distance: f64, sphere: usize) -> Self {
        let is_first =
            distance < self.distance || (distance <= self.distance && sphere < self.sphere);
        if is_first { Self { distance, sphere } } else { self }
    }
}

/// How far a ray, which starts on the sphere `leaving`, goes to one that it meets.
#[inline]
fn distance(scene: &PreparedScene, ray: &Ray, leaving: Option<usize>, index: usize) -> f64 {
    let sphere = &scene.spheres[index];
    let q = factored(ray, sphere.center, sphere.radius);
    distance_to(q, sphere, leaving == Some(index))
}

/// What a ray hits first; `leaving` is the place of the sphere that it starts on. Of spheres
/// at equal distances it is the one with the lowest place.
#[must_use]
pub fn nearest(scene: &PreparedScene, ray: &Ray, leaving: Option<usize>) -> Option<Hit> {
    let mut best = Hit { distance: MISS, sphere: usize::MAX };
    if let Some(tree) = &scene.tree {
        for &i in tree.outside() {
            best = best.or(distance(scene, ray, leaving, i), i);
        }
        tree.visit(ray, best.distance, |member| {
            if leaving != Some(member.sphere) {
                let q = factored(ray, member.center, member.radius);
                best = best.or(entry(q), member.sphere);
            }
            best.distance
        });
    } else {
        for i in 0..scene.spheres.len() {
            best = best.or(distance(scene, ray, leaving, i), i);
        }
    }
    (best.distance < MISS).then_some(best)
}

/// Whether a sphere other than `light` is seen first from the sphere `leaving`: one that is
/// nearer than `limit`, or as near and earlier in the scene file.
#[must_use]
pub fn occluded(
    scene: &PreparedScene,
    ray: &Ray,
    leaving: usize,
    light: usize,
    limit: f64,
) -> bool {
    let hides =
        |i: usize, other: f64| if i < light { other <= limit } else { i != light && other < limit };
    let hidden_by = |i: usize| hides(i, distance(scene, ray, Some(leaving), i));
    let Some(tree) = &scene.tree else {
        return (0..scene.spheres.len()).any(hidden_by);
    };
    let mut is_hidden = tree.outside().iter().any(|&i| hidden_by(i));
    if !is_hidden {
        tree.visit(ray, limit, |member| {
            let other = entry(factored(ray, member.center, member.radius));
            is_hidden |= member.sphere != leaving && hides(member.sphere, other);
            if is_hidden { -1.0 } else { limit }
        });
    }
    is_hidden
}
