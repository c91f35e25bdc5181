//! Scattering: a direction drawn from a surface's density and what it is worth, as in
//! `shaders/material.wgsl`; and what a direction is worth that was drawn otherwise, as in
//! `shaders/evaluate.wgsl`.

use super::sampling::{around, polar_cosine, polar_hemisphere, polar_phong};
use glam::{DVec2, DVec3};
use std::f64::consts::{FRAC_1_PI, TAU};

/// Where a path goes on. A weight of zero ends it; the sample still counts.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Scattering {
    /// Unit direction.
    pub direction: DVec3,
    /// `f_r`·cosθ/p without the albedo.
    pub weight: f64,
    /// p, per steradian.
    pub density: f64,
}

/// What a direction is worth that a light's density drew.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Worth {
    /// `f_r`·cosθ/p without the albedo.
    pub weight: f64,
    /// p, per steradian.
    pub density: f64,
}

/// Lambertian surface, uniform hemisphere: (1/π)·cosθ·2π = 2cosθ.
#[must_use]
pub fn scatter_diffuse(normal: DVec3, u: DVec2) -> Scattering {
    let polar = polar_hemisphere(u.x);
    let direction = around(normal, polar, u.y);
    Scattering { direction, weight: 2.0 * polar.y, density: 1.0 / TAU }
}

/// Lambertian surface, cosine-weighted hemisphere: p = cosθ/π, weight 1.
#[must_use]
pub fn scatter_cosine(normal: DVec3, u: DVec2) -> Scattering {
    let polar = polar_cosine(u.x);
    let direction = around(normal, polar, u.y);
    Scattering { direction, weight: 1.0, density: polar.y * FRAC_1_PI }
}

/// Phong lobe about the mirror direction: `f_r`/p = 1, so the weight is cosθ, and 0 for
/// the part of the lobe that lies under the surface. cosⁿ⁺¹α = 1 − u gives the density.
#[must_use]
pub fn scatter_glossy(normal: DVec3, incoming: DVec3, exponent: f64, u: DVec2) -> Scattering {
    let polar = polar_phong(u.x, exponent);
    let direction = around(mirror(normal, incoming), polar, u.y);
    let lobe = ((-u.x).ln_1p() * exponent / (exponent + 1.0)).exp();
    Scattering {
        direction,
        weight: normal.dot(direction).max(0.0),
        density: (exponent + 1.0) / TAU * lobe,
    }
}

/// Lambertian surface under cosine-weighted directions.
#[must_use]
pub fn evaluate_diffuse(normal: DVec3, direction: DVec3) -> Worth {
    Worth { weight: 1.0, density: normal.dot(direction).max(0.0) * FRAC_1_PI }
}

/// Phong lobe: cosⁿα from 1 − cosα = |mirror − direction|²/2.
#[must_use]
pub fn evaluate_glossy(normal: DVec3, incoming: DVec3, direction: DVec3, exponent: f64) -> Worth {
    let t = (mirror(normal, incoming) - direction).length_squared() / 2.0;
    let lobe = if t < 1.0 { (exponent * (-t).ln_1p()).exp() } else { 0.0 };
    Worth { weight: normal.dot(direction).max(0.0), density: (exponent + 1.0) / TAU * lobe }
}

fn mirror(normal: DVec3, incoming: DVec3) -> DVec3 {
    (incoming - 2.0 * incoming.dot(normal) * normal).normalize()
}
