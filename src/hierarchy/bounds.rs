//! Boxes in `f32` that hold what they are said to hold.

use super::wide::Wide;
use glam::{DVec3, Vec3};

/// An axis-parallel box, both corners included.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// The smallest coordinates.
    pub low: Vec3,
    /// The largest coordinates.
    pub high: Vec3,
}

impl Bounds {
    /// The smallest box around a sphere of finite centre and radius: rounded outwards, so
    /// that it holds every point of it.
    #[must_use]
    pub fn of_sphere(center: DVec3, radius: f64) -> Self {
        let corner = |round: fn(f64, f64) -> f32| {
            Vec3::from_array(center.to_array().map(|coordinate| round(coordinate, radius)))
        };
        Self { low: corner(|c, r| at_most(c, -r)), high: corner(|c, r| -at_most(-c, -r)) }
    }

    /// The smallest box that holds both.
    #[must_use]
    pub fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// Half of the surface's area, in `f64`, where no scene's lengths overflow.
    #[must_use]
    pub fn half_area(self) -> f64 {
        Wide::from(self).half_area()
    }

    /// Whether the two have a point in common.
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        self.low.cmple(other.high).all() && other.low.cmple(self.high).all()
    }
}

/// The largest `f32` that is not larger than a + b, exactly: what the sum loses to rounding
/// is known (Knuth's `TwoSum`) and decides where the sum itself is an `f32`.
fn at_most(a: f64, b: f64) -> f32 {
    let sum = a + b;
    let of_b = sum - a;
    let lost = (a - (sum - of_b)) + (b - of_b);
    #[expect(clippy::cast_possible_truncation, reason = "rounding is what this is about")]
    let nearest = sum as f32;
    let back = f64::from(nearest);
    let is_above = back > sum || (back >= sum && lost < 0.0);
    if is_above { nearest.next_down() } else { nearest }
}

#[cfg(test)]
mod tests {
    use super::Bounds;
    use glam::DVec3;

    /// Whether x ≤ a + b, by comparing with what the sum loses.
    fn is_at_most(x: f32, a: f64, b: f64) -> bool {
        // x - a is exact or at least correctly rounded, which keeps the order.
        let rest = f64::from(x) - a;
        let lost = (f64::from(x) - (rest + a)) + ((rest + a) - rest - a);
        rest < b || (rest <= b && lost <= 0.0)
    }

    /// The box holds the sphere, and no smaller one does.
    #[test]
    fn boxes_are_tight_and_hold_their_spheres() {
        let centers = [0.0, -0.0, 1.0, -1.0, 0.1, 1.0 / 3.0, -1e9 / 7.0, 16_777_217.0, 1e-20];
        for x in centers {
            for radius in [1e-15, 1e-8, 0.1, 0.5, 1.0, 1e9 / 3.0, 1e15] {
                let found = Bounds::of_sphere(DVec3::new(x, -x, 0.0), radius);
                let (low, high) = (found.low.x, found.high.x);
                assert!(is_at_most(low, x, -radius), "{x} {radius}: {low}");
                assert!(!is_at_most(low.next_up(), x, -radius), "{x} {radius}: {low}");
                assert!(is_at_most(-high, -x, -radius), "{x} {radius}: {high}");
                assert!(!is_at_most(-high.next_down(), -x, -radius), "{x} {radius}: {high}");
                assert_eq!((found.low.y.to_bits(), found.high.y.to_bits()), {
                    ((-high).to_bits(), (-low).to_bits())
                });
            }
        }
    }

    /// 1 − 1e-30 is 1 in `f64` and in `f32`, and yet less: the box of what reaches there
    /// from below may end at 1, that of what goes on from there must begin before it.
    #[test]
    fn what_a_sum_loses_counts() {
        let found = Bounds::of_sphere(DVec3::splat(1.0), 1e-15);
        assert!(found.low.x < 1.0 && found.high.x > 1.0, "{found:?}");
        let exact = Bounds::of_sphere(DVec3::splat(1.5), 0.5);
        assert_eq!((exact.low.x.to_bits(), exact.high.x.to_bits()), {
            (1.0_f32.to_bits(), 2.0_f32.to_bits())
        });
    }
}
