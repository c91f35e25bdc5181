//! Scattering: a direction and its weight `f_r`·cosθ/p, without the albedo, as in
//! `shaders/material.wgsl`.

use super::sampling::{from_local, sample_hemisphere, sample_phong};
use glam::{DVec2, DVec3};

/// Where a path goes on. A weight of zero ends it; the sample still counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Scattering {
    pub(super) direction: DVec3,
    pub(super) weight: f64,
}

/// Lambertian surface, uniform hemisphere: (1/π)·cosθ·2π = 2cosθ.
pub(super) fn scatter_diffuse(normal: DVec3, u: DVec2) -> Scattering {
    let local = sample_hemisphere(u);
    Scattering { direction: from_local(normal, local), weight: 2.0 * local.z }
}

/// Phong lobe about the mirror direction: `f_r`/p = 1, so the weight is cosθ, and 0 for
/// the part of the lobe that lies under the surface.
pub(super) fn scatter_glossy(
    normal: DVec3,
    incoming: DVec3,
    exponent: f64,
    u: DVec2,
) -> Scattering {
    let mirror = (incoming - 2.0 * incoming.dot(normal) * normal).normalize();
    let direction = from_local(mirror, sample_phong(u, exponent));
    Scattering { direction, weight: normal.dot(direction).max(0.0) }
}
