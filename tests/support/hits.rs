//! Rays against single spheres: one table for the twin and the device, and a running
//! error analysis that says how far off an `f32` kernel may be on each row.

#![allow(dead_code, reason = "each test uses a part")]
#![allow(clippy::many_single_char_names, reason = "the names of the formulas")]

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sphere::{MISS, Quadratic, Ray, anchored, entry, exit, factored};
use glam::{DVec3, Vec3};

/// One `f32` rounding, relative.
pub const U: f64 = 1.0 / (1 << 24) as f64;
/// What WGSL grants √ (as 1/inverseSqrt: 2 and 2.5 ULP) and ÷ (2.5 ULP), in `U`.
const SQRT: f64 = 9.0;
const DIVISION: f64 = 5.0;

/// Points that are hit lie this far from the origin at most, along each axis.
const REACH: f64 = 8.0;

/// Which root is asked for; the numbers are the probe's.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Side {
    /// The near one, from outside.
    Entry,
    /// The far one, from inside.
    Exit,
    /// The far end of the chord that starts on the sphere.
    Chord,
}

/// A ray and a sphere, as the kernel gets them.
#[derive(Debug, Clone, Copy)]
pub struct Case {
    /// Radius of the sphere that was rounded into the row; infinite for a plane.
    pub radius: f64,
    pub anchored: bool,
    pub side: Side,
    pub origin: Vec3,
    pub direction: Vec3,
    /// Centre, or gradient at the origin of space.
    pub position: Vec3,
    /// Radius, or curvature.
    pub size: f32,
    /// Of the anchored form.
    pub offset: f32,
}

/// How far off an `f32` kernel may be.
#[derive(Debug, Clone, Copy)]
pub struct Bounds {
    pub b: f64,
    pub c: f64,
    pub discriminant: f64,
    pub distance: f64,
}

impl Case {
    /// The ray with its direction made a unit vector, in `f64`.
    pub fn ray(&self) -> Ray {
        Ray { origin: self.origin.as_dvec3(), direction: self.direction.as_dvec3().normalize() }
    }

    /// The row without further rounding.
    pub fn exact(&self) -> (Quadratic, f64) {
        let (place, size) = (self.position.as_dvec3(), f64::from(self.size));
        let q = if self.anchored {
            anchored(&self.ray(), place, f64::from(self.offset), size)
        } else {
            factored(&self.ray(), place, size)
        };
        (q, distance(q, self.side))
    }

    /// Distance of the point at `t` from the surface of this very row.
    pub fn residual(&self, t: f64) -> f64 {
        let Ray { origin, direction } = self.ray();
        let (p, place, size) =
            (origin + t * direction, self.position.as_dvec3(), f64::from(self.size));
        if !self.anchored {
            return (p.distance(place) - size).abs();
        }
        let value = size / 2.0 * p.length_squared() + place.dot(p) + f64::from(self.offset);
        // F = h + κh²/2 at height h.
        (2.0 * value / (1.0 + (1.0 + 2.0 * size * value).max(0.0).sqrt())).abs()
    }

    /// Running error analysis of `shaders/sphere.wgsl`; every term is one rounding `u`
    /// of the magnitude that this row gives it. The kernel takes the direction for a
    /// unit vector: it is one within `u`, which `b` takes over.
    pub fn bounds(&self, u: f64) -> Bounds {
        let (q, t) = self.exact();
        let (b, c, discriminant) =
            if self.anchored { self.anchored_errors(&q, u) } else { self.factored_errors(&q, u) };
        let root = q.discriminant.max(0.0).sqrt();
        let root_error = (discriminant / root).min(discriminant.sqrt()) + SQRT * u * root;
        let sum = root + q.b.abs();
        let sum_error = root_error + b + u * sum;
        let quotient = match self.side {
            Side::Chord => 2.0 * b / q.leading,
            Side::Exit if q.b <= 0.0 => sum_error / q.leading,
            // |c| over a sum of the root, however wrong, and |b|.
            Side::Entry | Side::Exit => {
                let least = (sum - sum_error).max(q.b.abs() - b).max(0.0);
                let most = t.max((q.c.abs() + c) / least);
                ((c + t * sum_error) / least).min(most)
            }
        };
        let distance = if t == MISS { f64::INFINITY } else { quotient + DIVISION * u * t };
        Bounds { b, c, discriminant, distance }
    }

    /// f = o - c: 1 rounding. b = f·d: that, 3 of the dot product, 1 of the direction.
    /// l = f - b·d: its error along d is perpendicular to l and enters l² squared, the
    /// rest is one rounding each of f, b·d and l.
    fn factored_errors(&self, q: &Quadratic, u: f64) -> (f64, f64, f64) {
        let f = (self.origin.as_dvec3() - self.position.as_dvec3()).length();
        let squared = f64::from(self.size).powi(2);
        let l = (squared - q.discriminant).max(0.0).sqrt();
        let b = 5.0 * u * f;
        let c = u * (5.0 * f * f + squared + q.c.abs());
        let across = 2.0 * l * (f + q.b.abs() + l) + 3.0 * l * l;
        let along = b + 2.0 * u * q.b.abs();
        (b, c, u * (squared + q.discriminant.abs() + across) + along * along)
    }

    /// g = m + κo: 2 roundings. c = (m + g)·o + 2e: those of g, 1 of the sum, 3 of the
    /// dot product, 1 of the last sum. b = g·d: those of g, 3 and 1 as above.
    fn anchored_errors(&self, q: &Quadratic, u: f64) -> (f64, f64, f64) {
        let (m, o, k) = (self.position.as_dvec3(), self.origin.as_dvec3(), f64::from(self.size));
        let g = m + k * o;
        let g_error = u * (k * o.length() + g.length());
        let b = g_error + u * (3.0 * g.length() + q.b.abs());
        let c = o.length() * (g_error + 4.0 * u * (m + g).length()) + u * q.c.abs();
        let square = 2.0 * q.b.abs() * b + b * b + u * q.b * q.b;
        (b, c, square + k * c + u * (k * q.c.abs() + q.discriminant.abs()))
    }

    /// Whether rounding may decide either way if the sphere is hit.
    fn undecided(q: &Quadratic, bounds: &Bounds) -> bool {
        q.discriminant.abs() <= bounds.discriminant || q.b.abs() <= bounds.b
    }

    /// Judges a distance that an `f32` kernel found: its error as a share of the bound,
    /// or `None` where it is not even right about hit and miss.
    pub fn judge(&self, found: f32) -> Option<f64> {
        let ((q, t), bounds) = (self.exact(), self.bounds(U));
        let hit = found < 3.0e38;
        if found.is_nan() || found < 0.0 {
            return None;
        }
        if hit != (t < MISS) || bounds.distance == f64::INFINITY && hit {
            return Self::undecided(&q, &bounds).then_some(0.0);
        }
        let share = if hit { (f64::from(found) - t).abs() / bounds.distance } else { 0.0 };
        (share <= 1.0).then_some(share)
    }
}

fn distance(q: Quadratic, side: Side) -> f64 {
    match side {
        Side::Entry => entry(q),
        Side::Exit => exit(q, false),
        Side::Chord => exit(q, true),
    }
}

/// A case before anything is rounded: what the table is made of.
#[derive(Debug, Clone, Copy)]
pub struct Plan {
    pub radius: f64,
    pub anchored: bool,
    pub side: Side,
    pub point: DVec3,
    pub normal: DVec3,
    pub direction: DVec3,
    pub distance: f64,
}

impl Plan {
    /// Centre and radius, or gradient, curvature and offset.
    pub fn shape(&self) -> (DVec3, f64, f64) {
        let (p, n, k) = (self.point, self.normal, 1.0 / self.radius);
        if self.anchored {
            let gradient = n - k * p;
            (gradient, k, -(gradient.dot(p) + k / 2.0 * p.length_squared()))
        } else {
            (p - self.radius * n, self.radius, 0.0)
        }
    }

    pub fn origin(&self) -> DVec3 {
        self.point - self.distance * self.direction
    }

    #[expect(clippy::cast_possible_truncation, reason = "the kernel computes in f32")]
    pub fn round(&self) -> Case {
        let (place, size, offset) = self.shape();
        Case {
            radius: self.radius,
            anchored: self.anchored,
            side: self.side,
            origin: self.origin().as_vec3(),
            direction: self.direction.as_vec3(),
            position: place.as_vec3(),
            size: size as f32,
            offset: offset as f32,
        }
    }
}

/// Radii in either form: the factored one up to the extent, the anchored one from there
/// to a plane.
const FACTORED: [f64; 5] = [1e-3, 1e-2, 0.1, 1.0, 10.0];
const ANCHORED: [f64; 8] = [10.0, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, f64::INFINITY];

/// Cosines between ray and normal, from head-on to grazing.
const COSINES: [f64; 6] = [1.0, 0.7, 0.3, 1e-1, 1e-2, 1e-3];

/// Random numbers of one row of the table.
struct Draw {
    row: u64,
    block: u32,
}

impl Draw {
    fn four(&mut self) -> [f64; 4] {
        self.block += 1;
        random_bits(SampleKey { pixel: 0, index: self.row }, self.block, 7).map(unit_float)
    }

    fn direction(&mut self) -> DVec3 {
        let [z, turn, ..] = self.four();
        let (z, (y, x)) = (2.0 * z - 1.0, (std::f64::consts::TAU * turn).sin_cos());
        let sine = (1.0 - z * z).sqrt();
        DVec3::new(sine * x, sine * y, z)
    }
}

/// The table: every radius, normals along the axes and anywhere, every angle, every
/// side, distances over four decades; and rays that pass close to tangent.
pub fn plans() -> Vec<Plan> {
    let sizes = FACTORED.map(|r| (r, false)).into_iter().chain(ANCHORED.map(|r| (r, true)));
    let mut plans = Vec::new();
    for (radius, anchored) in sizes {
        for (place, cosine) in (0..64_u32).flat_map(|n| COSINES.map(|c| (n, c))) {
            for side in [Side::Entry, Side::Exit, Side::Chord] {
                // Nobody is inside a plane.
                if side == Side::Entry || radius < f64::INFINITY {
                    let draw = Draw { row: plans.len() as u64, block: 0 };
                    plans.push(plan(draw, radius, anchored, side, place, cosine));
                }
            }
        }
    }
    plans
}

fn plan(mut draw: Draw, radius: f64, anchored: bool, side: Side, place: u32, cosine: f64) -> Plan {
    let axes = [DVec3::X, DVec3::Y, DVec3::Z, DVec3::NEG_X, DVec3::NEG_Y, DVec3::NEG_Z];
    let normal = axes.get(place as usize).copied().unwrap_or_else(|| draw.direction());
    let [x, y, z, decades] = draw.four();
    let point = REACH * (2.0 * DVec3::new(x, y, z) - 1.0);
    let across = normal.cross(draw.direction()).normalize();
    let into = if side == Side::Exit { cosine } else { -cosine };
    let direction = across * (1.0 - cosine * cosine).sqrt() + into * normal;
    let far = 1e-3 * 10.0_f64.powf(4.2 * decades);
    let distance = match side {
        Side::Entry => far,
        Side::Exit => far.min(1.99 * radius * cosine),
        Side::Chord => 0.0,
    };
    Plan { radius, anchored, side, point, normal, direction, distance }
}

/// Rays that pass a sphere at (1 ± ε)R from its centre.
pub fn tangents() -> Vec<Case> {
    let sizes = FACTORED.map(|r| (r, false)).into_iter().chain(ANCHORED.map(|r| (r, true)));
    let offsets = [0.0, 1e-7, 1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 0.1].map(|e| [e, -e]);
    let mut cases = Vec::new();
    for (radius, anchored) in sizes.filter(|size| size.0 < f64::INFINITY) {
        for (place, &offset) in
            (0..16).flat_map(|n| offsets.as_flattened().iter().map(move |e| (n, e)))
        {
            let draw = Draw { row: (1 << 32) + cases.len() as u64, block: 0 };
            let mut plan = plan(draw, radius, anchored, Side::Entry, place, 0.0);
            // Shifts the sphere along the normal and leaves the ray where it is.
            let ray = plan.round();
            plan.point += offset * plan.radius.min(REACH) * plan.normal;
            cases.push(Case { origin: ray.origin, direction: ray.direction, ..plan.round() });
        }
    }
    cases
}
