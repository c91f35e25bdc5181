//! The range in which candor vouches for its numbers, checked before anything is traced.
//!
//! Positions round by u of their distance from the point around which they are computed,
//! u = 2⁻²⁴ on a device and 2⁻⁵³ in the twin. A scene is in range if nothing that shapes
//! its picture is so small that this could change the image mean by 0.1 %; DESIGN.md ("The
//! declared range") derives the limits and shows what was measured at them.

mod pairs;

use crate::scene::{Scene, Sphere};
use crate::viewpoint::Viewpoint;
use pairs::close_pairs;

/// A sphere by itself is seen true down to this share of the reach of its coordinates, in
/// `f32`. Miss distances are off by some u of the reach, in both directions; the area seen
/// changes by the square of their ratio to the radius.
const SMALLEST: f64 = 4e-6;

/// What touches something, sticks out of something or fills the picture must be larger
/// than this share of the reach, in `f32`: there, a shift by u of the reach changes what is
/// seen by its ratio to the size.
const FINEST: f64 = 1e-4;

/// How much finer `f64` is than `f32`.
const DOUBLE: f64 = 1.0 / (1_u64 << 29) as f64;

/// What positions are computed in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Arithmetic {
    /// A device: `f32` around the focus, huge spheres by their surfaces nearby.
    Single,
    /// The twin: `f64` in scene units, every sphere by centre and radius.
    Double,
}

/// What is outside of the range.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{what}; {allowed}")]
pub struct OutOfRange {
    /// Number of the sphere that it is about, counted from 1 in the order of the file;
    /// none where it is about the picture.
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
    let range = Range { scene, viewpoint, arithmetic };
    if let Some(small) = scene.spheres().iter().find(|s| range.is_too_small(s)) {
        return Err(range.too_small(small));
    }
    // Where two meet, neither's reach is more than some three times the other's.
    let margin = |s: &Sphere| 8.0 * range.share(FINEST) * range.reach(s);
    let pairs = close_pairs(scene.spheres(), margin).into_iter();
    match pairs.filter_map(|(a, b)| range.judge_pair(a, b)).min_by_key(|out| out.sphere) {
        Some(out) => Err(out),
        None => range.check_field(),
    }
}

struct Range<'a> {
    scene: &'a Scene,
    viewpoint: &'a Viewpoint,
    arithmetic: Arithmetic,
}

impl Range<'_> {
    /// Size of the coordinates that meet at a sphere, in scene units.
    fn reach(&self, sphere: &Sphere) -> f64 {
        match self.arithmetic {
            Arithmetic::Single => {
                sphere.center().distance(self.viewpoint.focus())
                    + sphere.radius()
                    + self.viewpoint.extent()
            }
            Arithmetic::Double => {
                sphere.center().length() + sphere.radius() + self.scene.camera().position().length()
            }
        }
    }

    /// Share of the reach, for a share in `f32`.
    fn share(&self, single: f64) -> f64 {
        match self.arithmetic {
            Arithmetic::Single => single,
            Arithmetic::Double => single * DOUBLE,
        }
    }

    /// The finest detail that is resolved where two spheres meet. A device computes there
    /// around the smaller one; the twin's centre form loses digits to the larger.
    fn finest(&self, a: &Sphere, b: &Sphere) -> f64 {
        let (small, large) = if a.radius() <= b.radius() { (a, b) } else { (b, a) };
        let reach = match self.arithmetic {
            Arithmetic::Single => self.reach(small),
            Arithmetic::Double => self.reach(small) + self.reach(large),
        };
        self.share(FINEST) * reach
    }

    fn is_too_small(&self, sphere: &Sphere) -> bool {
        sphere.radius() < self.share(SMALLEST) * self.reach(sphere)
    }

    fn too_small(&self, sphere: &Sphere) -> OutOfRange {
        let limit = self.share(SMALLEST) * self.reach(sphere);
        self.out(
            sphere,
            format!("is too small to be traced in {}", self.digits()),
            format!("its radius is {:.2e}; here it takes {limit:.2e} or more", sphere.radius()),
        )
    }

    /// Two spheres that touch, overlap or nearly do.
    fn judge_pair(&self, a: &Sphere, b: &Sphere) -> Option<OutOfRange> {
        let (small, large) = if a.radius() <= b.radius() { (a, b) } else { (b, a) };
        let finest = self.finest(a, b);
        let distance = small.center().distance(large.center());
        let sticks_out = distance - (large.radius() - small.radius());
        let sticks_in = large.radius() + small.radius() - distance;
        // From inside, what is outside of the large one is the hidden part.
        let shown = if self.is_inside(large) { sticks_in } else { sticks_out };
        if shown.abs() < finest {
            return Some(self.nearly_hidden(small, large, finest));
        }
        let apart = sticks_in < -finest || sticks_out < -finest;
        (!apart && small.radius() < finest).then(|| self.too_close(small, large, finest))
    }

    fn is_inside(&self, sphere: &Sphere) -> bool {
        let spheres = self.scene.spheres().iter().zip(self.viewpoint.inside());
        spheres.into_iter().any(|(s, &inside)| inside && s.ordinal() == sphere.ordinal())
    }

    fn nearly_hidden(&self, small: &Sphere, large: &Sphere, finest: f64) -> OutOfRange {
        self.out(
            small,
            format!("is hidden by {} but for a part too small for {}", large.title(), self.digits()),
            format!("move it out of that surface, or into it, by more than {finest:.2e}"),
        )
    }

    fn too_close(&self, small: &Sphere, large: &Sphere, finest: f64) -> OutOfRange {
        self.out(
            small,
            format!("is too small, where it meets {}, for {}", large.title(), self.digits()),
            format!(
                "its radius is {:.2e}; here it takes {finest:.2e} or more, or a gap of that size",
                small.radius()
            ),
        )
    }

    /// A picture narrower than the finest detail would show what is beside it.
    fn check_field(&self) -> Result<(), OutOfRange> {
        let camera = self.scene.camera();
        let (focus, extent) = (self.viewpoint.focus(), self.viewpoint.extent());
        let distance = camera.position().distance(focus).max(extent);
        let start = camera.position() + self.viewpoint.approach() * camera.forward();
        let reach = match self.arithmetic {
            Arithmetic::Single => extent + start.distance(focus),
            Arithmetic::Double => camera.position().length() + focus.length() + extent,
        };
        let width = 2.0 * (camera.vertical_fov() / 2.0).tan() * distance;
        let limit = self.share(FINEST) * reach;
        if width >= limit {
            return Ok(());
        }
        let limit = (2.0 * (limit / 2.0 / distance).atan()).to_degrees();
        Err(OutOfRange {
            sphere: None,
            what: format!("the camera's field of view is too narrow for {}", self.digits()),
            allowed: self.advised(format!(
                "it is {:.2e} degrees; here it takes {limit:.2e} or more",
                camera.vertical_fov().to_degrees()
            )),
        })
    }

    fn digits(&self) -> &'static str {
        match self.arithmetic {
            Arithmetic::Single => "the single precision of a device",
            Arithmetic::Double => "double precision",
        }
    }

    fn out(&self, sphere: &Sphere, what: String, allowed: String) -> OutOfRange {
        OutOfRange {
            sphere: Some(sphere.ordinal()),
            what: format!("{} {what}", sphere.title()),
            allowed: self.advised(allowed),
        }
    }

    /// Where a device gives up, the twin may not.
    fn advised(&self, allowed: String) -> String {
        let twin = self.arithmetic == Arithmetic::Single
            && check(self.scene, self.viewpoint, Arithmetic::Double).is_ok();
        if twin { format!("{allowed} (--device cpu takes this scene)") } else { allowed }
    }
}
