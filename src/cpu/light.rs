//! What a point sees of a spherical light: a cone, sampled uniformly by solid angle
//! (Shirley, Wang & Zimmerman, "Monte Carlo Techniques for Direct Lighting Calculations",
//! ACM TOG 15(1), 1996, section 3.2), as in `shaders/light.wgsl`.

use super::scene::PreparedSphere;
use super::sphere::{Ray, exit, factored};
use super::trace::SurfacePoint;
use glam::DVec3;

/// The directions among which a light is sampled; the solid angle is 2π·height.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Cone {
    pub(super) axis: DVec3,
    /// 1 − cosσ, σ the half angle; at most 1.
    pub(super) height: f64,
}

/// From inside a light, where every direction meets it, the half-space above the surface;
/// from outside, the cone that holds it. 1 − cosσ = sin²σ/(1 + cosσ) does not cancel.
pub(super) fn cone_of(light: &PreparedSphere, point: &SurfacePoint) -> Cone {
    if light.inside {
        return Cone { axis: point.normal, height: 1.0 };
    }
    let to_centre = light.center - point.position;
    let d = to_centre.length();
    let sine = light.radius / d;
    let cosine2 = (d - light.radius) * (d + light.radius) / (d * d);
    let height = (sine * sine).min(1.0) / (1.0 + cosine2.max(0.0).sqrt());
    Cone { axis: to_centre / d, height }
}

/// Distance to a light along a direction drawn in its cone: the ray is known to meet it,
/// and what rounding makes of the rim counts as met.
pub(super) fn light_distance(light: &PreparedSphere, ray: &Ray) -> f64 {
    let q = factored(ray, light.center, light.radius);
    if light.inside {
        return exit(q, false);
    }
    let root = q.discriminant.max(0.0).sqrt();
    q.c.max(0.0) / (root + q.b.abs()).max(f64::MIN_POSITIVE)
}
