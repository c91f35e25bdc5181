//! What of a scene is too small beside its coordinates.

use super::Arithmetic;
use super::pairs::{TooManyPairs, visit_close_pairs};
use crate::scene::{Scene, Sphere, Surface};
use crate::viewpoint::Viewpoint;
use glam::DVec3;

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

/// Spheres are tangent if they are so up to this share of their distance and radius.
const TANGENT: f64 = 16.0 * f64::EPSILON;

/// What is too small, and the size from which on it would not be.
pub(super) enum Fault<'a> {
    /// A sphere by itself.
    Small { sphere: &'a Sphere, limit: f64 },
    /// A sphere beside another.
    Close { small: &'a Sphere, large: &'a Sphere, limit: f64 },
    /// The part of a sphere that another one does not hide.
    Hidden { small: &'a Sphere, large: &'a Sphere, limit: f64 },
    /// Too many spheres overlap for all pairs to be looked at.
    Crowded { sphere: &'a Sphere },
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
        let mut first: Option<(usize, Fault<'a>)> = None;
        let visited = visit_close_pairs(self.scene.spheres(), margin, |a, b| {
            let (small, large) = if a.radius() <= b.radius() { (a, b) } else { (b, a) };
            let is_first = first.as_ref().is_none_or(|&(ordinal, _)| small.ordinal() < ordinal);
            if let Some(fault) = is_first.then(|| self.judge_pair(small, large)).flatten() {
                first = Some((small.ordinal(), fault));
            }
        });
        match visited {
            Ok(()) => first.map(|(_, fault)| fault),
            Err(TooManyPairs) => {
                self.scene.spheres().first().map(|sphere| Fault::Crowded { sphere })
            }
        }
    }

    /// Two spheres that touch, overlap or nearly do.
    fn judge_pair(&self, small: &'a Sphere, large: &'a Sphere) -> Option<Fault<'a>> {
        let away = small.center() - large.center();
        let distance = away.length();
        let outermost = small.radius() / distance.max(f64::MIN_POSITIVE) * away;
        // How far the small one reaches out of the large one, and how far in; and how fine
        // that is resolved where it does.
        let out = distance - (large.radius() - small.radius());
        let into = large.radius() + small.radius() - distance;
        let out_limit = self.finest(small, large, small.center() + outermost);
        let in_limit = self.finest(small, large, small.center() - outermost);
        let limit = out_limit.max(in_limit);
        if small.radius() < limit {
            let apart = into < -limit || out < -limit;
            return (!apart).then_some(Fault::Close { small, large, limit });
        }
        // From inside, what is outside of the large one is the hidden part. A lamp that is
        // hidden altogether must be so by more than rounding, or it would shine through.
        let inside = self.inside.contains(&large.ordinal());
        let (shown, limit) = if inside { (into, in_limit) } else { (out, out_limit) };
        let hidden = match small.surface() {
            Surface::Emitter(_) => -limit * (SMALLEST / FINEST),
            _ => TANGENT * (distance + large.radius()),
        };
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

    /// The finest detail that is resolved at a point where two spheres meet. A device computes
    /// with that point; the twin's centre form loses digits to both spheres.
    fn finest(&self, small: &Sphere, large: &Sphere, point: DVec3) -> f64 {
        let reach = match self.arithmetic {
            Arithmetic::Single => {
                let extent = self.viewpoint.extent();
                point.distance(self.viewpoint.focus()) + extent + small.radius().min(extent)
            }
            Arithmetic::Double => self.reach(small) + self.reach(large),
        };
        self.share(FINEST) * reach
    }
}
