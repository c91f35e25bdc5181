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

/// The cone that holds a sphere, or the half-space towards its centre from within.
/// 1 − cosσ = sin²σ/(1 + cosσ) does not cancel.
pub(super) fn cone_from(to_centre: DVec3, radius: f64) -> Cone {
    let d = to_centre.length();
    let sine = radius / d;
    let cosine2 = (d - radius) * (d + radius) / (d * d);
    let height = (sine * sine).min(1.0) / (1.0 + cosine2.max(0.0).sqrt());
    Cone { axis: to_centre / d, height }
}

/// From inside a light, where every direction meets it, the half-space above the surface;
/// from outside, the cone that holds it.
pub(super) fn cone_of(light: &PreparedSphere, point: &SurfacePoint) -> Cone {
    if light.inside {
        return Cone { axis: point.normal, height: 1.0 };
    }
    cone_from(light.center - point.position, light.radius)
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

#[cfg(test)]
mod tests {
    use super::{PreparedSphere, Ray, SurfacePoint, cone_of, light_distance};
    use crate::scene::{Radiance, Surface};
    use glam::DVec3;

    /// A light of radius 1 around (0, 0, `z`).
    fn light(z: f64, inside: bool) -> PreparedSphere {
        let surface = Surface::Emitter(Radiance::new(DVec3::ONE).expect("a radiance"));
        PreparedSphere { center: DVec3::new(0.0, 0.0, z), radius: 1.0, inside, surface }
    }

    const ORIGIN: SurfacePoint = SurfacePoint { position: DVec3::ZERO, normal: DVec3::X };

    /// 1 − cosσ = 2sin²(σ/2) with sinσ = r/d.
    #[test]
    fn cones_hold_the_light() {
        for d in [1.0, 1.000_001, 2.0, 1e3, 1e9] {
            let cone = cone_of(&light(d, false), &ORIGIN);
            let expected = 2.0 * ((1.0 / d).asin() / 2.0).sin().powi(2);
            // The root of (d - 1)/d takes half of the digits of a touching light.
            assert!((cone.height / expected - 1.0).abs() < 1e-9, "{d}: {cone:?}");
            assert_eq!(cone.axis, DVec3::Z);
        }
        let half_space = cone_of(&light(0.5, true), &ORIGIN);
        assert_eq!((half_space.axis, half_space.height.to_bits()), (DVec3::X, 1.0_f64.to_bits()));
    }

    /// Straight ahead, along the rim, beside it by a rounding, and from inside.
    #[test]
    fn rays_in_a_cone_meet_the_light() {
        let toward = |x: f64, z: f64| Ray {
            origin: DVec3::ZERO,
            direction: DVec3::new(x, 0.0, z).normalize(),
        };
        let rim = 3.0_f64.sqrt();
        for (ray, distance) in
            [(toward(0.0, 1.0), 1.0), (toward(1.0, rim), rim), (toward(1.0 + 1e-12, rim), rim)]
        {
            let found = light_distance(&light(2.0, false), &ray);
            assert!((found - distance).abs() < 1e-6, "{ray:?}: {found}");
        }
        let out = light_distance(&light(0.5, true), &toward(0.0, 1.0));
        assert!((out - 1.5).abs() < 1e-12, "{out}");
    }
}
