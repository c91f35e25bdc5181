//! Scattering: a direction and its weight `f_r`·cosθ/p, without the albedo, as in
//! `shaders/material.wgsl`.

use super::sampling::{around, polar_hemisphere, polar_phong};
use glam::{DVec2, DVec3};

/// Where a path goes on. A weight of zero ends it; the sample still counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattering {
    /// Unit direction.
    pub direction: DVec3,
    /// `f_r`·cosθ/p without the albedo.
    pub weight: f64,
}

/// Lambertian surface, uniform hemisphere: (1/π)·cosθ·2π = 2cosθ.
#[must_use]
pub fn scatter_diffuse(normal: DVec3, u: DVec2) -> Scattering {
    let polar = polar_hemisphere(u.x);
    Scattering { direction: around(normal, polar, u.y), weight: 2.0 * polar.y }
}

/// Phong lobe about the mirror direction: `f_r`/p = 1, so the weight is cosθ, and 0 for
/// the part of the lobe that lies under the surface.
#[must_use]
pub fn scatter_glossy(normal: DVec3, incoming: DVec3, exponent: f64, u: DVec2) -> Scattering {
    let mirror = (incoming - 2.0 * incoming.dot(normal) * normal).normalize();
    let direction = around(mirror, polar_phong(u.x, exponent), u.y);
    Scattering { direction, weight: normal.dot(direction).max(0.0) }
}
