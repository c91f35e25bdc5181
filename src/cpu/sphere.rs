//! Ray/sphere intersection in two forms, as in `shaders/sphere.wgsl`; directions have
//! unit length. DESIGN.md ("Hits") derives both and why no epsilon moves a ray.

use glam::DVec3;

/// A half-line; the direction has unit length.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Ray {
    /// Where it starts.
    pub origin: DVec3,
    /// Where it goes.
    pub direction: DVec3,
}

/// The distance of a sphere that is not hit.
pub const MISS: f64 = f64::INFINITY;

/// A ray against one sphere, in either form.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Quadratic {
    /// Half the middle coefficient; negative where the ray heads inwards.
    pub b: f64,
    /// The constant term; negative inside.
    pub c: f64,
    /// The discriminant; negative where the ray's line misses the sphere.
    pub discriminant: f64,
    /// The leading coefficient: 1 in factored form, the curvature in anchored form.
    pub leading: f64,
}

/// Centre and radius, with the discriminant factored so that it does not cancel for
/// small far spheres (Haines, Günther & Akenine-Möller, "Precision Improvements for
/// Ray/Sphere Intersection", Ray Tracing Gems, 2019, ch. 7).
#[must_use]
#[inline]
pub fn factored(ray: &Ray, centre: DVec3, radius: f64) -> Quadratic {
    let f = ray.origin - centre;
    let b = f.dot(ray.direction);
    let l = f - b * ray.direction;
    let squared = radius * radius;
    Quadratic { b, c: f.dot(f) - squared, discriminant: squared - l.dot(l), leading: 1.0 }
}

/// The function F(p) = ½κ|p|² + m·p + e, whose zeros are the sphere, whose gradient
/// κp + m is its unit normal there, and whose value is the distance for κ = 0, a
/// plane. `gradient` is m, `offset` e, `curvature` κ.
#[must_use]
pub fn anchored(ray: &Ray, gradient: DVec3, offset: f64, curvature: f64) -> Quadratic {
    let g = gradient + curvature * ray.origin;
    let c = (gradient + g).dot(ray.origin) + 2.0 * offset;
    let b = g.dot(ray.direction);
    Quadratic { b, c, discriminant: b * b - curvature * c, leading: curvature }
}

/// Distance to the near side from outside; 0 for an origin that rounding put inside.
#[must_use]
#[inline]
pub fn entry(q: Quadratic) -> f64 {
    if q.b < 0.0 && q.discriminant >= 0.0 {
        (q.c / (q.discriminant.sqrt() - q.b)).max(0.0)
    } else {
        MISS
    }
}

/// Distance to the far side from inside. A ray that `leaves` this very sphere has
/// c = 0, which makes it the chord.
#[must_use]
pub fn exit(q: Quadratic, leaves: bool) -> f64 {
    let root = q.discriminant.max(0.0).sqrt();
    if leaves {
        2.0 * q.b.abs() / q.leading
    } else if q.b <= 0.0 {
        (root - q.b) / q.leading
    } else {
        (-q.c / (root + q.b)).max(0.0)
    }
}

#[cfg(test)]
mod tests {
    use super::{MISS, Ray, anchored, entry, exit, factored};
    use glam::DVec3;

    /// A sphere of radius 2 around (0, −2, 0): F = |p|²/4 + y.
    fn both(origin: [f64; 3], direction: [f64; 3]) -> [super::Quadratic; 2] {
        let ray = Ray { origin: origin.into(), direction: DVec3::from(direction).normalize() };
        [factored(&ray, DVec3::new(0.0, -2.0, 0.0), 2.0), anchored(&ray, DVec3::Y, 0.0, 0.5)]
    }

    fn assert_near(found: f64, expected: f64) {
        assert!((found - expected).abs() < 1e-14, "{found} instead of {expected}");
    }

    #[test]
    fn both_forms_meet_the_same_points() {
        for q in both([0.0, 3.0, 0.0], [0.0, -1.0, 0.0]) {
            assert_near(entry(q), 3.0);
        }
        for q in both([0.0, -1.0, 0.0], [0.0, -1.0, 0.0]) {
            assert_near(exit(q, false), 3.0);
        }
        for q in both([0.0, -1.0, 0.0], [0.0, 1.0, 0.0]) {
            assert_near(exit(q, false), 1.0);
        }
        for q in both([0.0, 0.0, 0.0], [1.0, -1.0, 0.0]) {
            assert_near(exit(q, true), 8_f64.sqrt());
        }
    }

    #[test]
    fn rays_beside_and_away_miss() {
        for q in both([0.0, 3.0, 0.0], [1.0, -0.1, 0.0]) {
            assert_eq!(entry(q).to_bits(), MISS.to_bits());
        }
        for q in both([0.0, 3.0, 0.0], [0.0, 1.0, 0.0]) {
            assert_eq!(entry(q).to_bits(), MISS.to_bits());
        }
    }

    /// An origin that rounding put under the surface is on it: heading in, it hits at
    /// once; heading out, not at all. The same from inside.
    #[test]
    fn origins_on_the_wrong_side_are_on_the_surface() {
        for q in both([0.0, -1e-12, 0.0], [0.0, -1.0, 0.0]) {
            assert_eq!(entry(q).to_bits(), 0.0_f64.to_bits());
        }
        for q in both([0.0, -1e-12, 0.0], [0.0, 1.0, 0.0]) {
            assert_eq!(entry(q).to_bits(), MISS.to_bits());
        }
        for q in both([0.0, 1e-12, 0.0], [0.0, 1.0, 0.0]) {
            assert_eq!(exit(q, false).to_bits(), 0.0_f64.to_bits());
        }
        for q in both([0.0, 1e-12, 0.0], [0.0, -1.0, 0.0]) {
            assert_near(exit(q, false), 4.0 + 1e-12);
        }
    }
}
