//! The range in which candor vouches for its numbers, checked before anything is traced.
//!
//! Positions round by u of their distance from the point around which they are computed,
//! u = 2⁻²⁴ on a device and 2⁻⁵³ in the twin. A scene is in range if nothing that shapes
//! its picture is so small that this could change the image mean by 0.1 %; DESIGN.md ("The
//! declared range") derives the limits and shows what was measured at them.

mod judge;
mod pairs;
mod touch;

use crate::scene::Scene;
use crate::viewpoint::Viewpoint;
use judge::{Fault, Judge};

/// What positions are computed in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// A device: `f32` around the focus, huge spheres by their surfaces nearby.
    Single,
    /// The twin: `f64` in scene units, every sphere by centre and radius.
    Double,
}

impl Arithmetic {
    /// Where one gives up, the other may not: the twin has more digits, and a device has no
    /// trouble with huge spheres.
    fn other(self) -> (Self, &'static str) {
        match self {
            Self::Single => (Self::Double, "`candor render --device cpu` takes this scene"),
            Self::Double => (Self::Single, "`candor render` takes this scene on a device"),
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Single => "the single precision of a device",
            Self::Double => "double precision",
        }
    }
}

/// What is outside of the range.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{what}; {allowed}")]
pub struct OutOfRange {
    /// Number of the sphere that it is about, counted from 1 in the order of the file;
    /// none where it is about the field of view.
    pub sphere: Option<usize>,
    /// What is wrong.
    pub what: String,
    /// What is allowed, and what to do.
    pub allowed: String,
}

/// Checks that a scene can be traced to within 0.1 % of its image mean.
///
/// # Errors
/// With the first sphere, in the order of the file, that is too small or too nearly hidden
/// for this arithmetic, or the picture if its field of view is too narrow.
pub fn check(
    scene: &Scene,
    viewpoint: &Viewpoint,
    arithmetic: Arithmetic,
) -> Result<(), OutOfRange> {
    let Some(fault) = Judge::new(scene, viewpoint, arithmetic).first() else {
        return Ok(());
    };
    let mut out = explain(&fault, arithmetic);
    let (other, advice) = arithmetic.other();
    if !matches!(fault, Fault::Crowded { .. })
        && Judge::new(scene, viewpoint, other).first().is_none()
    {
        out.allowed = format!("{} ({advice})", out.allowed);
    }
    Err(out)
}

fn explain(fault: &Fault<'_>, arithmetic: Arithmetic) -> OutOfRange {
    let precision = arithmetic.name();
    let (sphere, what, allowed) = match *fault {
        Fault::Small { sphere, limit } => (
            Some(sphere),
            format!("is too small for {precision}"),
            format!(
                "its radius is {}; here it takes {} or more",
                short(sphere.radius()),
                short(limit)
            ),
        ),
        Fault::Close { small, large, limit } => (
            Some(small),
            format!("is too small, so near to {}, for {precision}", large.title()),
            format!(
                "its radius is {}; here it takes {} or more, or a gap of that size",
                short(small.radius()),
                short(limit)
            ),
        ),
        Fault::Hidden { small, large, limit } => (
            Some(small),
            format!("is hidden by {} but for a part too small for {precision}", large.title()),
            format!("move it through that surface, either way, by more than {}", short(limit)),
        ),
        Fault::Coincident { small, large, limit } => (
            Some(small),
            format!(
                "lies so close to the surface of {} that {precision} cannot tell which is seen",
                large.title()
            ),
            format!("they must be {} or more apart", short(limit)),
        ),
        Fault::Near { sphere, height, limit } => (
            Some(sphere),
            format!("is too near to the camera for {precision}"),
            format!(
                "the camera is {} above it; here it takes {} or more",
                short(height.max(0.0)),
                short(limit)
            ),
        ),
        Fault::Crowded { sphere } => (
            Some(sphere),
            "is one of too many spheres that overlap".to_owned(),
            "it takes some ten thousand that all overlap each other, or more that do not"
                .to_owned(),
        ),
        Fault::Narrow { degrees, limit } => (
            None,
            format!("the field of view is too narrow for {precision}"),
            format!("it is {} degrees; here it takes {} or more", short(degrees), short(limit)),
        ),
    };
    OutOfRange {
        sphere: sphere.map(crate::scene::Sphere::ordinal),
        what: sphere.map_or(what.clone(), |sphere| format!("{} {what}", sphere.title())),
        allowed,
    }
}

/// Three digits, without an exponent where it reads well.
fn short(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    if (1e-3..1e6).contains(&rounded) { format!("{rounded}") } else { format!("{rounded:e}") }
}
