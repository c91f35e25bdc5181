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
