//! What of a scene is too small beside its coordinates.

use super::Arithmetic;
use super::pairs::close_pairs;
use crate::scene::{Scene, Sphere};
use crate::viewpoint::Viewpoint;

/// A sphere by itself is seen true down to this share of the reach of its coordinates, in
/// `f32`. Miss distances are off by some u of the reach, in both directions; the area seen
/// changes by the square of their ratio to the radius.
const SMALLEST: f64 = 4e-6;

/// What touches something, sticks out of something or fills the picture must be larger
/// than this share of the reach, in `f32`: there, a shift by u of the reach changes what is
/// seen by its ratio to the size.
const FINEST: f64 = 1e-4;

/// How much finer `f64` is than `f32`.
const DOUBLE: f64 = 1.0 / (1 << 29) as f64;

/// What is too small, and the size from which on it would not be.
pub(super) enum Fault<'a> {
    /// A sphere by itself.
    Small { sphere: &'a Sphere, limit: f64 },
    /// A sphere beside another.
    Close { small: &'a Sphere, large: &'a Sphere, limit: f64 },
    /// The part of a sphere that another one does not hide.
    Hidden { small: &'a Sphere, large: &'a Sphere, limit: f64 },
    /// The field of view, in degrees.
    Narrow { degrees: f64, limit: f64 },
}

/// A scene, and what is to trace it.
pub(super) struct Judge<'a> {
    scene: &'a Scene,
    viewpoint: &'a Viewpoint,
    arithmetic: Arithmetic,
    /// Numbers of the spheres that hold the camera.
    inside: Vec<usize>,
}

impl<'a> Judge<'a> {
    pub(super) fn new(scene: &'a Scene, viewpoint: &'a Viewpoint, arithmetic: Arithmetic) -> Self {
        let sides = scene.spheres().iter().zip(viewpoint.inside());
        let inside = sides.filter_map(|(s, &inside)| inside.then_some(s.ordinal())).collect();
        Self { scene, viewpoint, arithmetic, inside }
    }

    /// The first fault: of spheres by themselves, then of pairs, then of the picture.
    pub(super) fn first(&self) -> Option<Fault<'a>> {
        self.too_small().or_else(|| self.first_pair()).or_else(|| self.too_narrow())
    }

    fn too_small(&self) -> Option<Fault<'a>> {
        let limit = |sphere| self.share(SMALLEST) * self.reach(sphere);
        let small = self.scene.spheres().iter().find(|sphere| sphere.radius() < limit(sphere))?;
        Some(Fault::Small { sphere: small, limit: limit(small) })
    }

    fn first_pair(&self) -> Option<Fault<'a>> {
        // Where two meet, neither's reach is more than some three times the other's.
        let margin = |sphere: &Sphere| 8.0 * self.share(FINEST) * self.reach(sphere);
        let pairs = close_pairs(self.scene.spheres(), margin).into_iter();
        let faults = pairs.filter_map(|(a, b)| {
            let (small, large) = if a.radius() <= b.radius() { (a, b) } else { (b, a) };
            self.judge_pair(small, large).map(|fault| (small.ordinal(), fault))
        });
        faults.min_by_key(|&(ordinal, _)| ordinal).map(|(_, fault)| fault)
    }

    /// Two spheres that touch, overlap or nearly do.
    fn judge_pair(&self, small: &'a Sphere, large: &'a Sphere) -> Option<Fault<'a>> {
        let limit = self.finest(small, large);
        let distance = small.center().distance(large.center());
        let sticks_out = distance - (large.radius() - small.radius());
        let sticks_in = large.radius() + small.radius() - distance;
        if small.radius() < limit {
            let apart = sticks_in < -limit || sticks_out < -limit;
            return (!apart).then_some(Fault::Close { small, large, limit });
        }
        // From inside, what is outside of the large one is the hidden part. What is hidden
        // altogether must be so by more than rounding.
        let inside = self.inside.contains(&large.ordinal());
        let shown = if inside { sticks_in } else { sticks_out };
        let hidden = -limit * (SMALLEST / FINEST);
        (hidden < shown && shown < limit).then_some(Fault::Hidden { small, large, limit })
    }

    /// A picture narrower than the finest detail would show what is beside it.
    fn too_narrow(&self) -> Option<Fault<'a>> {
        let camera = self.scene.camera();
        let (focus, extent) = (self.viewpoint.focus(), self.viewpoint.extent());
        let distance = camera.position().distance(focus).max(extent);
        let start = camera.position() + self.viewpoint.approach() * camera.forward();
        let reach = match self.arithmetic {
            Arithmetic::Single => extent + start.distance(focus),
            Arithmetic::Double => camera.position().length() + focus.length() + extent,
        };
        let finest = self.share(FINEST) * reach;
        let degrees = camera.vertical_fov().to_degrees();
        let limit = 2.0 * (finest / 2.0 / distance).atan().to_degrees();
        (degrees < limit).then_some(Fault::Narrow { degrees, limit })
    }

    /// Size of the coordinates that meet at a sphere, in scene units.
    fn reach(&self, sphere: &Sphere) -> f64 {
        let around = match self.arithmetic {
            Arithmetic::Single => {
                sphere.center().distance(self.viewpoint.focus()) + self.viewpoint.extent()
            }
            Arithmetic::Double => {
                sphere.center().length() + self.scene.camera().position().length()
            }
        };
        around + sphere.radius()
    }

    /// A share of the reach, given for `f32`.
    fn share(&self, single: f64) -> f64 {
        match self.arithmetic {
            Arithmetic::Single => single,
            Arithmetic::Double => single * DOUBLE,
        }
    }

    /// The finest detail that is resolved where two spheres meet. A device computes there
    /// around the smaller one; the twin's centre form loses digits to the larger.
    fn finest(&self, small: &Sphere, large: &Sphere) -> f64 {
        let reach = match self.arithmetic {
            Arithmetic::Single => self.reach(small),
            Arithmetic::Double => self.reach(small) + self.reach(large),
        };
        self.share(FINEST) * reach
    }
}
