//! Where the scene is and from which side its spheres are seen.
//!
//! Two decisions that everything downstream shares, made once in `f64`. The *focus*
//! and *extent* say around which point and at which scale the kernel computes. The
//! *sides* say which spheres are seen from inside: surfaces are opaque and reflect to
//! the side that the light came from, so a path never crosses one and sees each sphere
//! from the side that the camera is on.

use crate::scene::{Camera, Scene, Sphere};
use glam::DVec3;

/// A camera within this fraction of the extent of a surface stands on it: 16 units of
/// `f32` rounding, the error of a hit point in either form (DESIGN.md, "Hits").
const ON_SURFACE: f64 = 1.0 / (1 << 20) as f64;

/// A camera farther away than this many extents does not move the focus: the digits
/// are spent where the surfaces are.
const FAR_CAMERA: f64 = 64.0;

/// Focus, extent and sides of a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Viewpoint {
    focus: DVec3,
    extent: f64,
    inside: Vec<bool>,
}

impl Viewpoint {
    /// Looks at a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        let (low, high) = bounds(scene);
        let extent = ((high - low).length() / 2.0).max(f64::MIN_POSITIVE);
        let camera = scene.camera();
        let near = extent * ON_SURFACE;
        Self {
            focus: low.midpoint(high),
            extent,
            inside: scene.spheres().iter().map(|s| sees_inside(camera, s, near)).collect(),
        }
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
fn sees_inside(camera: &Camera, sphere: &Sphere, near: f64) -> bool {
    let height = height(camera, sphere);
    if height.abs() <= near {
        camera.forward().dot(camera.position() - sphere.center()) < 0.0
    } else {
        height < 0.0
    }
}

/// The box of what light can reach. Spheres enter in the order of their radii; one
/// that is larger than the distances met so far is a wall, of which only the surface
/// nearest to the rest counts, so that the far side of a huge sphere does not. The
/// smallest has no rest to be large beside, only the camera.
fn bounds(scene: &Scene) -> (DVec3, DVec3) {
    let camera = scene.camera().position();
    let mut spheres: Vec<&Sphere> = scene.spheres().iter().collect();
    spheres.sort_by(|a, b| a.radius().total_cmp(&b.radius()));
    let Some((smallest, rest)) = spheres.split_first() else {
        return (camera, camera);
    };
    let (mut low, mut high) = counted(smallest, camera, 0.0);
    for sphere in rest {
        let (l, h) = counted(sphere, low.midpoint(high), (high - low).length() / 2.0);
        (low, high) = (low.min(l), high.max(h));
    }
    let extent = (high - low).length() / 2.0;
    if extent == 0.0 || camera.distance(low.midpoint(high)) <= FAR_CAMERA * extent {
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
