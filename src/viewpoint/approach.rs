//! How far before a far camera its rays may start.
//!
//! A ray through the scene from 1e6 extents away would be one of a coarse grid: `f32`
//! directions are 6e-8 apart. Nothing stands between the camera and the first surface in
//! its field, so rays may as well start on a plane there, at places that the host computes.

use crate::scene::{Camera, Scene, Sphere};

/// Widens the field by more than the rounding of `f32` directions.
const WIDER: f64 = 1.0 + 1e-6;

/// Distance from the camera, along its axis, of a plane before all that it sees; 0 where
/// there is no use in one. `inside` says which spheres hold the camera, `extent` is the
/// scene's: the plane stays so far before the first surface.
pub(super) fn approach(scene: &Scene, inside: &[bool], extent: f64) -> f64 {
    let half_angle = WIDER * corner_angle(scene);
    let spheres = scene.spheres().iter().zip(inside);
    let nearest = spheres
        .filter_map(|(sphere, &inside)| distance_within(scene.camera(), half_angle, sphere, inside))
        .fold(f64::INFINITY, f64::min);
    if nearest.is_finite() { (half_angle.cos() * nearest - extent).max(0.0) } else { 0.0 }
}

/// The angle between the view axis and the picture's corners, in radians.
#[must_use]
pub fn corner_angle(scene: &Scene) -> f64 {
    let half_height = (scene.camera().vertical_fov() / 2.0).tan();
    let size = scene.size();
    let half_width = half_height * f64::from(size.width()) / f64::from(size.height());
    half_height.hypot(half_width).atan()
}

/// Smallest distance of a sphere along rays within `half_angle` of the view axis; nothing
/// where they all miss it. From outside, the nearer a ray points to the centre the sooner
/// it hits; from inside, the later.
fn distance_within(camera: &Camera, half_angle: f64, sphere: &Sphere, inside: bool) -> Option<f64> {
    let to_center = sphere.center() - camera.position();
    let distance = to_center.length();
    if distance == 0.0 {
        return Some(sphere.radius());
    }
    // |a × b| and a·b keep their precision at small angles, which an arc cosine does not.
    let off_axis =
        camera.forward().cross(to_center).length().atan2(camera.forward().dot(to_center));
    let off = if inside {
        (off_axis + half_angle).min(std::f64::consts::PI)
    } else {
        (off_axis - half_angle).max(0.0)
    };
    let (sine, cosine) = off.sin_cos();
    // Of radius and miss distance, neither squared: the difference may be small beside both.
    let miss = distance * sine;
    let squared = (sphere.radius() - miss) * (sphere.radius() + miss);
    let half_chord = squared.max(0.0).sqrt();
    if inside {
        Some((distance * cosine + half_chord).max(0.0))
    } else if squared < 0.0 || cosine < 0.0 {
        None
    } else {
        Some((distance * cosine - half_chord).max(0.0))
    }
}
