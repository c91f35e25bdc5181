//! Directions drawn around an axis, as in `shaders/sampling.wgsl`: a polar angle from
//! one number, then the azimuth.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// (sine, cosine) of the angle from the axis, uniform over the hemisphere, p = 1/2π: the
/// cosine is uniform in [0, 1).
#[must_use]
pub fn polar_hemisphere(u: f64) -> DVec2 {
    DVec2::new(((1.0 - u) * (1.0 + u)).sqrt(), u)
}

/// (sine, cosine) of the angle from the axis, p = cosθ/π: sin²θ is uniform in [0, 1).
#[must_use]
pub fn polar_cosine(u: f64) -> DVec2 {
    DVec2::new(u.sqrt(), (1.0 - u).sqrt())
}

/// (sine, cosine) of the angle α from the axis of a cone, uniform over its solid angle:
/// 1 − cosα is uniform in [0, `height`), `height` = 1 − cosine of the half angle.
#[must_use]
pub fn polar_cone(u: f64, height: f64) -> DVec2 {
    let t = u * height;
    DVec2::new((t * (2.0 - t)).sqrt(), 1.0 - t)
}

/// (sine, cosine) of the angle α from the axis of a Phong lobe, p = (n+1)cosⁿα/2π:
/// cosα = (1−u)^(1/(n+1)), computed from t = 1 − cosα and sinα = √(t(2−t)), which keep
/// their digits however large n is.
#[must_use]
pub fn polar_phong(u: f64, exponent: f64) -> DVec2 {
    let t = -((-u).ln_1p() / (exponent + 1.0)).exp_m1();
    DVec2::new((t * (2.0 - t)).sqrt(), 1.0 - t)
}

/// The direction at a polar angle from the unit vector `axis`, its azimuth 2πu (frame of
/// Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
#[must_use]
pub fn around(axis: DVec3, polar: DVec2, u: f64) -> DVec3 {
    let s = if axis.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + axis.z);
    let b = axis.x * axis.y * a;
    let tangent = DVec3::new(1.0 + s * axis.x * axis.x * a, s * b, -s * axis.x);
    let bitangent = DVec3::new(b, s + axis.y * axis.y * a, -axis.y);
    let (sine, cosine) = (TAU * u).sin_cos();
    polar.x * (cosine * tangent + sine * bitangent) + polar.y * axis
}
