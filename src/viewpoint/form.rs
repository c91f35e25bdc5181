//! In which form a sphere is intersected.

use crate::scene::Sphere;
use glam::DVec3;

/// A sphere that rays start farther from than this many radii is small, whatever the
/// extent: the anchored discriminant is off by 3u(distance/R)², the factored miss distance
/// by 3u(distance/R) of the radius, and they meet near six radii.
const SMALL_FROM: f64 = 8.0;

/// How a sphere is intersected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// By centre and radius: spheres up to the scene's extent, and far ones.
    Factored,
    /// By curvature and gradient at the focus: larger ones.
    Anchored,
}

/// Whether a hierarchy may hold a sphere of a form: huge ones would be in every box, and those
/// seen from inside may be hit on their far side.
#[must_use]
pub fn is_small(form: Form, inside: bool) -> bool {
    form == Form::Factored && !inside
}

impl Form {
    /// The form of a sphere in a scene of this extent whose camera rays start at `start`.
    pub(super) fn of(sphere: &Sphere, extent: f64, start: DVec3) -> Self {
        let distance = start.distance(sphere.center());
        let small = sphere.radius() <= extent || distance > SMALL_FROM * sphere.radius();
        if small { Self::Factored } else { Self::Anchored }
    }
}
