//! Where the scene is and from which side its spheres are seen.
//!
//! Three decisions that everything downstream shares, made once in `f64`. The *focus*
//! and *extent* say around which point and at which scale the kernel computes. The
//! *sides* say which spheres are seen from inside: surfaces are opaque and reflect to
//! the side that the light came from, so a path never crosses one and sees each sphere
//! from the side that the camera is on. The *forms* say which spheres are huge.

mod approach;
mod form;

pub use approach::corner_angle;
pub use form::{Form, is_small};

use crate::scene::{Camera, Scene, Sphere};
use glam::DVec3;

/// A camera nearer to a surface than this many units of `f64` rounding stands on it: its
/// side cannot be told from its place. (An `f32` origin that rounds to the wrong side needs
/// no tolerance, see `shaders/sphere.wgsl`.)
const ON_SURFACE: f64 = 16.0 * f64::EPSILON;

/// What is farther from the camera than this many times the median sphere is scenery, a
/// sky or a sun; what is farther from the scenery is a far camera. Neither moves the focus:
/// the digits are spent where the scene is, and far things keep their relative precision.
const FAR: f64 = 64.0;

/// Focus, extent, sides and forms of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewpoint {
    focus: DVec3,
    extent: f64,
    inside: Vec<bool>,
    approach: f64,
    forms: Vec<Form>,
}

impl Viewpoint {
    /// Looks at a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let (low, high) = bounds(scene);
        let half_diagonal = (high - low).length() / 2.0;
        // Where there is no sphere, any length will do.
        let extent = if half_diagonal > 0.0 { half_diagonal } else { 1.0 };
        let (camera, focus) = (scene.camera(), low.midpoint(high));
        let inside: Vec<bool> = scene.spheres().iter().map(|s| sees_inside(camera, s)).collect();
        let is_far = camera.position().distance(focus) > FAR * extent;
        let approach = if is_far { approach::approach(scene, &inside, extent) } else { 0.0 };
        let start = camera.position() + approach * camera.forward();
        let forms = scene.spheres().iter().map(|s| Form::of(s, extent, start)).collect();
        Self { focus, extent, inside, approach, forms }
    }

    /// The point around which the kernel computes.
    #[must_use]
    pub fn focus(&self) -> DVec3 {
        self.focus
    }

    /// Half the diagonal of the box that holds what light can reach, in scene units;
    /// positive.
    #[must_use]
    pub fn extent(&self) -> f64 {
        self.extent
    }

    /// How far before the camera rays start, along its axis, in scene units: 0, unless the
    /// camera is so far away that `f32` directions from there would be a coarse grid.
    #[must_use]
    pub fn approach(&self) -> f64 {
        self.approach
    }

    /// Where the rays of the scene's camera start, on its axis: at the camera, or
    /// [`approach`](Self::approach) before it.
    #[must_use]
    pub fn ray_start(&self, camera: &Camera) -> DVec3 {
        camera.position() + self.approach * camera.forward()
    }

    /// For every sphere, how it is intersected on a device.
    #[must_use]
    pub fn forms(&self) -> &[Form] {
        &self.forms
    }

    /// For every sphere, whether paths see its inner side.
    #[must_use]
    pub fn inside(&self) -> &[bool] {
        &self.inside
    }
}

/// Signed distance of the camera from the surface, negative inside.
fn height(camera: &Camera, sphere: &Sphere) -> f64 {
    camera.position().distance(sphere.center()) - sphere.radius()
}

/// A camera on the surface is on the side that it looks to.
fn sees_inside(camera: &Camera, sphere: &Sphere) -> bool {
    let height = height(camera, sphere);
    let (position, center) = (camera.position(), sphere.center());
    let near = ON_SURFACE * (position.length() + center.length() + sphere.radius());
    if height.abs() <= near { camera.forward().dot(position - center) < 0.0 } else { height < 0.0 }
}

/// The spheres that are not scenery, in the order of their radii.
fn near_spheres(scene: &Scene) -> Vec<&Sphere> {
    let distance = |s: &Sphere| height(scene.camera(), s).abs();
    let mut distances: Vec<f64> = scene.spheres().iter().map(distance).collect();
    distances.sort_by(f64::total_cmp);
    // The lower median; a camera that stands on a surface has distance 0, which is no scale.
    let before = distances.len().saturating_sub(1) / 2;
    let median = distances.iter().skip(before).find(|&&distance| distance > 0.0);
    let limit = median.map_or(f64::INFINITY, |median| FAR * median);
    let mut near: Vec<&Sphere> = scene.spheres().iter().filter(|s| distance(s) <= limit).collect();
    near.sort_by(|a, b| a.radius().total_cmp(&b.radius()));
    near
}

/// The box of what light can reach nearby. Spheres enter in the order of their radii; one
/// that is larger than the distances met so far is a wall, of which only the surface
/// nearest to the rest counts, so that the far side of a huge sphere does not. The
/// smallest has no rest to be large beside, only the camera.
fn bounds(scene: &Scene) -> (DVec3, DVec3) {
    let camera = scene.camera().position();
    let spheres = near_spheres(scene);
    let Some((smallest, rest)) = spheres.split_first() else {
        return (camera, camera);
    };
    let (mut low, mut high) = counted(smallest, camera, 0.0);
    for sphere in rest {
        let (l, h) = counted(sphere, low.midpoint(high), (high - low).length() / 2.0);
        (low, high) = (low.min(l), high.max(h));
    }
    let extent = (high - low).length() / 2.0;
    if extent == 0.0 || camera.distance(low.midpoint(high)) <= FAR * extent {
        (low, high) = (low.min(camera), high.max(camera));
    }
    // A camera on the only sphere, or on the very points that count, has no distance yet.
    if low == high { whole(smallest) } else { (low, high) }
}

/// What counts of a sphere beside a box of half diagonal `extent` around `middle`.
fn counted(sphere: &Sphere, middle: DVec3, extent: f64) -> (DVec3, DVec3) {
    let outward = (middle - sphere.center()).try_normalize().unwrap_or(DVec3::X);
    let surface = sphere.center() + sphere.radius() * outward;
    let reach = extent + surface.distance(middle);
    if sphere.radius() <= 2.0 * reach { whole(sphere) } else { (surface, surface) }
}

fn whole(sphere: &Sphere) -> (DVec3, DVec3) {
    (sphere.center() - sphere.radius(), sphere.center() + sphere.radius())
}
