//! Boxes while a tree is built: in registers of four lanes, which minima and maxima take at
//! once.

use super::bounds::Bounds;
use glam::{DVec3, Vec3A};

/// An axis-parallel box.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wide {
    pub(super) low: Vec3A,
    pub(super) high: Vec3A,
}

impl Wide {
    /// Holds nothing, and joined with any box leaves that.
    pub(super) const EMPTY: Self =
        Self { low: Vec3A::splat(f32::INFINITY), high: Vec3A::splat(f32::NEG_INFINITY) };

    /// The smallest box that holds both.
    pub(super) fn join(self, other: Self) -> Self {
        Self { low: self.low.min(other.low), high: self.high.max(other.high) }
    }

    /// The smallest box that holds this one and a point.
    pub(super) fn with(self, point: Vec3A) -> Self {
        Self { low: self.low.min(point), high: self.high.max(point) }
    }

    /// Half of the surface's area, in `f64`, where no scene's lengths overflow; nothing for
    /// a box that holds nothing.
    pub(super) fn half_area(self) -> f64 {
        let sides = (self.high.as_dvec3() - self.low.as_dvec3()).max(DVec3::ZERO);
        sides.x * sides.y + sides.y * sides.z + sides.z * sides.x
    }

    /// Twice the middle, which is as good for comparisons and needs no rounding rule.
    pub(super) fn twice_middle(self) -> Vec3A {
        self.low + self.high
    }
}

impl From<Bounds> for Wide {
    fn from(bounds: Bounds) -> Self {
        Self { low: bounds.low.into(), high: bounds.high.into() }
    }
}

impl From<Wide> for Bounds {
    fn from(wide: Wide) -> Self {
        Self { low: wide.low.into(), high: wide.high.into() }
    }
}
