//! Directions drawn at a surface point, as in `shaders/sampling.wgsl`.

use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Turns a direction given around +z into one around the unit vector `n` (Duff et al.,
/// "Building an Orthonormal Basis, Revisited", JCGT 6(1), 2017).
#[must_use]
pub fn from_local(n: DVec3, local: DVec3) -> DVec3 {
    let s = if n.z >= 0.0 { 1.0 } else { -1.0 };
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    let tangent = DVec3::new(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    let bitangent = DVec3::new(b, s + n.y * n.y * a, -n.y);
    local.x * tangent + local.y * bitangent + local.z * n
}

/// Uniform over the hemisphere around +z, p = 1/2π: cosθ is uniform in [0, 1).
#[must_use]
pub fn sample_hemisphere(u: DVec2) -> DVec3 {
    let cosine = u.x;
    let sine = ((1.0 - cosine) * (1.0 + cosine)).sqrt();
    let (y, x) = (TAU * u.y).sin_cos();
    DVec3::new(sine * x, sine * y, cosine)
}

/// Phong lobe about +z, p = (n+1)cosⁿα/2π: cosα = (1−u)^(1/(n+1)), computed from
/// t = 1 − cosα and sinα = √(t(2−t)), which keep their digits however large n is.
#[must_use]
pub fn sample_phong(u: DVec2, exponent: f64) -> DVec3 {
    let t = -((-u.x).ln_1p() / (exponent + 1.0)).exp_m1();
    let sine = (t * (2.0 - t)).sqrt();
    let (y, x) = (TAU * u.y).sin_cos();
    DVec3::new(sine * x, sine * y, 1.0 - t)
}
