//! What of a scene is too small, too near or too nearly the same beside its coordinates.

use super::Arithmetic;
use super::pairs::first_close_pair;
use super::touch::{Coordinates, Touch, touch};
use crate::hierarchy::TooManyPairs;
use crate::scene::{Scene, Sphere};
use crate::viewpoint::{Viewpoint, corner_angle};
use glam::DVec3;
use std::sync::{Mutex, PoisonError};

/// A sphere by itself is seen true down to this share of the reach of its coordinates, in
/// `f32`. Miss distances are off by some u of the reach, in both directions; the area seen
/// changes by the square of their ratio to the radius.
pub(super) const SMALLEST: f64 = 4e-6;

/// A sphere that touches another, or nearly, must be larger than this share of the reach, in
/// `f32`: a shift by u of the reach changes what one throws on the other by its ratio to the
/// size.
pub(super) const CLOSE: f64 = 4e-5;

/// What sticks out of something or fills the picture must be larger than this share.
pub(super) const FINEST: f64 = 1e-4;

/// How far two positions together are off, of the reach, in `f32`: 2u.
pub(super) const ERROR: f64 = 1.2e-7;

/// Share of the picture by which a rim may be seen off.
pub(super) const MOVED: f64 = 5e-4;

/// What is smaller than this share of the picture, or of the distance from a light, is a speck.
const SPECK: f64 = 0.01;

/// Share of the picture that all specks together may show wrong.
const OVERLOOKED: f64 = 1e-4;

/// Among more lights no speck is looked for.
const MOST_LIGHTS: usize = 1000;

/// A rim for which this field of view would be too narrow, in radians, is one of a sphere
/// that is too near.
const NARROW: f64 = 0.1;

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
    /// The gap between two surfaces that lie side by side.
    Coincident { small: &'a Sphere, large: &'a Sphere, limit: f64 },
    /// The camera's height over a sphere.
    Near { sphere: &'a Sphere, height: f64, limit: f64 },
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
    /// Numbers of the spheres that hold the camera, ascending.
    inside: Vec<usize>,
    /// Those that emit.
    lights: Vec<&'a Sphere>,
    /// How far from the focus rays may start: the extent, where those of the camera do, or the
    /// far side of the smallest wall around it.
    rays_from: f64,
}

impl<'a> Judge<'a> {
    pub(super) fn new(scene: &'a Scene, viewpoint: &'a Viewpoint, arithmetic: Arithmetic) -> Self {
        let sides = scene.spheres().iter().zip(viewpoint.inside());
        let around = || sides.clone().filter_map(|(s, &inside)| inside.then_some(s));
        let enclosing = around()
            .filter(|sphere| !sphere.emits())
            .map(|sphere| sphere.center().distance(viewpoint.focus()) + sphere.radius())
            .reduce(f64::min);
        let start = viewpoint.ray_start(scene.camera());
        let camera = start.distance(viewpoint.focus()).max(viewpoint.extent());
        Self {
            scene,
            viewpoint,
            arithmetic,
            inside: around().map(Sphere::ordinal).collect(),
            lights: scene.spheres().iter().filter(|sphere| sphere.emits()).collect(),
            rays_from: enclosing.unwrap_or(0.0).max(camera),
        }
    }

    /// The first fault: of spheres by themselves, then of pairs, then of the camera.
    pub(super) fn first(&self) -> Option<Fault<'a>> {
        self.too_small()
            .or_else(|| self.first_pair())
            .or_else(|| self.too_near())
            .or_else(|| self.too_narrow())
    }

    fn too_small(&self) -> Option<Fault<'a>> {
        let limit = |sphere: &Sphere| {
            let reach = match self.arithmetic {
                Arithmetic::Single => self.reach(sphere).max(self.rays_from),
                Arithmetic::Double => self.reach(sphere),
            };
            self.share(SMALLEST) * reach
        };
        let small = self.scene.spheres().iter().find(|sphere| sphere.radius() < limit(sphere))?;
        Some(Fault::Small { sphere: small, limit: limit(small) })
    }

    fn first_pair(&self) -> Option<Fault<'a>> {
        // Where two meet, neither's reach is more than some three times the other's.
        let margin = |sphere: &Sphere| 8.0 * self.share(FINEST) * self.reach(sphere);
        let overlooked = Mutex::new(0.0);
        let pairs = |judge: &(dyn Fn(&'a Sphere, &'a Sphere) -> Option<Fault<'a>> + Sync)| {
            first_close_pair(self.scene.spheres(), self.viewpoint.focus(), margin, judge)
        };
        let first = pairs(&|small, large| {
            let fault = self.judge_pair(small, large)?;
            let Some(share) = self.speck(small, large, &fault) else { return Some(fault) };
            *overlooked.lock().unwrap_or_else(PoisonError::into_inner) += share;
            None
        });
        let overlooked = overlooked.into_inner().unwrap_or_else(PoisonError::into_inner);
        let first = match first {
            Ok(None) if overlooked > OVERLOOKED => {
                pairs(&|small, large| self.judge_pair(small, large))
            }
            first => first,
        };
        match first {
            Ok(first) => first,
            Err(TooManyPairs) => {
                self.scene.spheres().first().map(|sphere| Fault::Crowded { sphere })
            }
        }
    }

    /// Two spheres that touch, overlap or nearly do. Of two with the same surface, but for lights,
    /// which are sampled one by one, it is all one which is seen.
    fn judge_pair(&self, small: &'a Sphere, large: &'a Sphere) -> Option<Fault<'a>> {
        let inside = [small, large].map(|sphere| self.is_inside(sphere));
        let alike = small.surface() == large.surface() && inside[0] == inside[1] && !small.emits();
        match touch(small, large, inside, self)? {
            Touch::Close(limit) => Some(Fault::Close { small, large, limit }),
            _ if alike => None,
            Touch::Hidden(limit) => Some(Fault::Hidden { small, large, limit }),
            Touch::Coincident(limit) => Some(Fault::Coincident { small, large, limit }),
        }
    }

    /// The share of the picture that is shown wrong of a sphere that is nearly hidden in another
    /// one, where that may be overlooked: neither emits, and it is a speck as seen by the camera
    /// and by every light. Where a million spheres lie at random, some nearly hide others.
    fn speck(&self, small: &Sphere, large: &Sphere, fault: &Fault<'_>) -> Option<f64> {
        if !matches!(fault, Fault::Hidden { .. }) || small.emits() || large.emits() {
            return None;
        }
        let (camera, radius) = (self.scene.camera(), small.radius());
        let distance = (camera.position().distance(small.center()) - radius).max(0.0);
        let width = 2.0 * (camera.vertical_fov() / 2.0).tan() * distance;
        let height = |light: &Sphere| {
            (light.center().distance(small.center()) - light.radius()).abs() - radius
        };
        let is_speck = radius <= SPECK * width
            && self.lights.len() <= MOST_LIGHTS
            && self.lights.iter().all(|light| radius <= SPECK * height(light));
        let error = self.step(ERROR, small, large, small.center());
        is_speck.then_some(std::f64::consts::TAU * radius * error / (width * width))
    }

    /// The rim of a sphere in the picture is seen off by the error δ of the camera's place over
    /// the rim's distance, √(h(h + 2r)) at the height h. At no height at all, where the rim is
    /// the horizon, it dips by √(2δ/r).
    fn too_near(&self) -> Option<Fault<'a>> {
        if self.viewpoint.approach() > 0.0 {
            return None;
        }
        self.scene.spheres().iter().filter(|s| self.shows_rim(s)).find_map(|s| self.rim_fault(s))
    }

    fn rim_fault(&self, sphere: &'a Sphere) -> Option<Fault<'a>> {
        let camera = self.scene.camera();
        let (fov, radius) = (camera.vertical_fov(), sphere.radius());
        let height = camera.position().distance(sphere.center()) - radius;
        let reach = match self.arithmetic {
            Arithmetic::Single => self.reach_at(camera.position()),
            Arithmetic::Double => self.reach(sphere),
        };
        let error = self.share(ERROR) * reach;
        let at_least = height.max(error / 4.0);
        let rim = (at_least * (at_least + 2.0 * radius)).sqrt();
        let needed = error / (MOVED * rim);
        if fov >= needed {
            return None;
        }
        if needed < NARROW {
            return Some(Fault::Narrow { degrees: fov.to_degrees(), limit: needed.to_degrees() });
        }
        let rim = error / (MOVED * fov);
        let limit = rim * rim / (radius.hypot(rim) + radius);
        Some(Fault::Near { sphere, height, limit })
    }

    fn is_inside(&self, sphere: &Sphere) -> bool {
        self.inside.binary_search(&sphere.ordinal()).is_ok()
    }

    /// Whether the camera is outside of the sphere and its rim crosses the picture.
    fn shows_rim(&self, sphere: &Sphere) -> bool {
        let camera = self.scene.camera();
        let to_center = sphere.center() - camera.position();
        let off_axis = to_center.angle_between(camera.forward());
        let rim = (sphere.radius() / to_center.length()).min(1.0).asin();
        !self.is_inside(sphere) && (off_axis - rim).abs() <= corner_angle(self.scene)
    }

    /// A picture narrower than the finest detail would show what is beside it.
    fn too_narrow(&self) -> Option<Fault<'a>> {
        let camera = self.scene.camera();
        let (focus, extent) = (self.viewpoint.focus(), self.viewpoint.extent());
        let distance = camera.position().distance(focus).max(extent);
        let start = self.viewpoint.ray_start(camera);
        let reach = match self.arithmetic {
            Arithmetic::Single => self.reach_at(start),
            Arithmetic::Double => camera.position().length() + focus.length() + extent,
        };
        let finest = self.share(FINEST) * reach;
        let degrees = camera.vertical_fov().to_degrees();
        let limit = 2.0 * (finest / 2.0 / distance).atan().to_degrees();
        (degrees < limit).then_some(Fault::Narrow { degrees, limit })
    }

    /// Size of the coordinates that meet at a point, on a device.
    fn reach_at(&self, point: DVec3) -> f64 {
        point.distance(self.viewpoint.focus()) + self.viewpoint.extent()
    }

    /// Size of the coordinates that meet at a sphere, in scene units.
    fn reach(&self, sphere: &Sphere) -> f64 {
        let around = match self.arithmetic {
            Arithmetic::Single => self.reach_at(sphere.center()),
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
}

impl Coordinates for Judge<'_> {
    fn step(&self, share: f64, small: &Sphere, large: &Sphere, point: DVec3) -> f64 {
        // A device computes with the point itself; the twin's centre form loses digits to
        // both spheres.
        let reach = match self.arithmetic {
            Arithmetic::Single => {
                self.reach_at(point) + small.radius().min(self.viewpoint.extent())
            }
            Arithmetic::Double => self.reach(small) + self.reach(large),
        };
        self.share(share) * reach
    }

    fn focus(&self) -> DVec3 {
        self.viewpoint.focus()
    }

    fn extent(&self) -> f64 {
        self.viewpoint.extent()
    }

    fn width(&self) -> f64 {
        let camera = self.scene.camera();
        let distance = camera.position().distance(self.focus()).max(self.extent());
        (2.0 * (camera.vertical_fov() / 2.0).tan() * distance).min(self.extent())
    }
}
