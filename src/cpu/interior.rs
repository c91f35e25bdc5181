//! The side from which spheres are seen: those that hold the camera from inside, the
//! others from outside. `shaders/exterior.wgsl` and `interior.wgsl` in one, as a twin
//! has no kernel to keep small.

use super::scene::PreparedSphere;
use super::sphere::{MISS, Quadratic, entry, exit};
use glam::DVec3;

/// How far a ray goes to the side of the sphere that it can see. From outside, a ray
/// that leaves a sphere cannot meet it again; from inside, it meets the far end of the
/// chord.
#[inline]
pub(super) fn distance_to(q: Quadratic, sphere: &PreparedSphere, leaves: bool) -> f64 {
    if sphere.inside {
        exit(q, leaves)
    } else if leaves {
        MISS
    } else {
        entry(q)
    }
}

/// The unit normal on the side that is seen.
#[inline]
pub(super) fn facing_normal(outward: DVec3, sphere: &PreparedSphere) -> DVec3 {
    if sphere.inside { -outward } else { outward }
}
