//! How two spheres touch, overlap or nearly do, and whether that can be resolved.

use super::judge::{CLOSE, ERROR, FINEST, MOVED, SMALLEST};
use crate::scene::Sphere;
use glam::DVec3;

/// Share of the picture in which it may be rounding that says which of two surfaces is seen.
const UNRESOLVED: f64 = 1e-4;

/// Cosine of the angle from which on two walls are a corner, whose edge is a line like others.
const PARALLEL: f64 = 0.9;

/// What cannot be resolved, with the size from which on it could.
pub(super) enum Touch {
    /// The smaller sphere, where it meets the other.
    Close(f64),
    /// What shows of the smaller one.
    Hidden(f64),
    /// The gap between two surfaces side by side.
    Coincident(f64),
}

/// What is known of the coordinates.
pub(super) trait Coordinates {
    /// A share of the reach where two spheres meet at a point, in scene units.
    fn step(&self, share: f64, small: &Sphere, large: &Sphere, point: DVec3) -> f64;
    /// The middle of the scene.
    fn focus(&self) -> DVec3;
    /// Half of the scene's diagonal.
    fn extent(&self) -> f64;
    /// Width of the picture where the scene is, at most the extent.
    fn width(&self) -> f64;
}

/// What cannot be resolved of a pair; `inside` says which of the two hold the camera.
pub(super) fn touch(
    small: &Sphere,
    large: &Sphere,
    inside: [bool; 2],
    coordinates: &impl Coordinates,
) -> Option<Touch> {
    if small.radius() > coordinates.extent() && inside == [false, false] {
        return walls(small, large, coordinates);
    }
    let away = small.center() - large.center();
    let distance = away.length();
    let reaching = small.radius() * away.try_normalize().unwrap_or(DVec3::X);
    // How far the small one reaches out of the large one, and how far in.
    let out = distance - (large.radius() - small.radius());
    let into = large.radius() + small.radius() - distance;
    let (outermost, innermost) = (small.center() + reaching, small.center() - reaching);
    let limit = coordinates.step(CLOSE, small, large, outermost);
    if small.radius() < limit {
        let apart = into < -limit || out < -limit;
        return (!apart).then_some(Touch::Close(limit));
    }
    let least = coordinates.step(SMALLEST, small, large, outermost);
    let hidden_lamp = match inside {
        [false, false] => small.emits(),
        [true, true] => large.emits(),
        [true, false] | [false, true] => false,
    };
    if out.abs() < least
        && (hidden_lamp || is_patch_seen(small, large, out, coordinates, outermost))
    {
        return Some(Touch::Coincident(least));
    }
    // From inside, what is outside of the large one is the hidden part.
    let (shown, limit) = match inside {
        [_, true] => (into, coordinates.step(FINEST, small, large, innermost)),
        _ => (out, coordinates.step(FINEST, small, large, outermost)),
    };
    let from = if inside[1] && small.emits() { -least } else { least.min(limit) };
    let from = if inside[1] && !small.emits() { 0.0 } else { from };
    let is_hidden = from <= shown && shown < limit.min(small.radius());
    is_hidden.then_some(Touch::Hidden(limit))
}

/// Whether the patch around a point of inner tangency, in which the two surfaces are nearer
/// to each other than rounding, is more than a small share of the picture or of the sphere.
/// Surfaces part as ½Δκ·x² there.
fn is_patch_seen(
    small: &Sphere,
    large: &Sphere,
    out: f64,
    coordinates: &impl Coordinates,
    point: DVec3,
) -> bool {
    let parting = 1.0 / small.radius() - 1.0 / large.radius();
    let error = coordinates.step(ERROR, small, large, point).max(out);
    let size = small.radius().min(coordinates.width());
    // π·(2·error/Δκ) of 4π·size², or of the like in the picture.
    2.0 * error > UNRESOLVED * 4.0 * parting * size * size
}

/// Two spheres larger than the scene are seen as walls: where they run side by side through
/// it, nearly parallel, rounding says which is in front.
fn walls(small: &Sphere, large: &Sphere, coordinates: &impl Coordinates) -> Option<Touch> {
    let (focus, extent) = (coordinates.focus(), coordinates.extent());
    let seen = [small, large].map(|sphere| {
        let away = focus - sphere.center();
        (away.normalize_or_zero(), away.length() - sphere.radius())
    });
    let [(small_normal, small_height), (large_normal, large_height)] = seen;
    let far = small_height.abs().min(large_height.abs()) > 2.0 * extent;
    if far || small_normal.dot(large_normal) < PARALLEL {
        return None;
    }
    // By how much they come nearer or part through the scene.
    let parting = 1.0 / small.radius() - 1.0 / large.radius();
    let tilt = (small_normal - large_normal).length() + parting * extent;
    let error = coordinates.step(ERROR, small, large, focus);
    let gap = (small_height - large_height).abs() - tilt * extent;
    let nearest = coordinates.step(SMALLEST, small, large, focus);
    let parallel = error > MOVED * tilt * coordinates.width();
    (gap < nearest && parallel).then_some(Touch::Coincident(nearest))
}
