//! The path of one sample on a device beside that of the twin: where do they part?

use crate::trail::{Segment, Trail};
use crate::viewpoint::Viewpoint;
use glam::DVec3;

/// Paths part where they differ by more than this: positions relative to the scene's extent or
/// their distance from its focus, the rest relative to its own size. It is the bias that a
/// device may have ([`crate::verify::MAX_BIAS`]), far above the rounding of one segment, which
/// grows from vertex to vertex where surfaces are curved.
pub const TOLERANCE: f64 = 1e-3;

/// Where two paths part.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Parting {
    /// Number of the vertex; the camera is 0, what it sees 1.
    pub vertex: usize,
    /// What differs there.
    pub cause: Cause,
}

/// What differs where two paths part; of several differences the first of this list.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Cause {
    /// They hit different spheres, or only one hits anything.
    Sphere,
    /// The place of the vertex.
    Position,
    /// The normal.
    Normal,
    /// Which light is sampled.
    Light,
    /// Whether the sampled light is seen.
    Visibility,
    /// The radiance brought so far.
    Radiance,
    /// The weight of the scattering.
    Weight,
    /// One goes on, or they end in different ways.
    Ending,
    /// The direction in which they go on.
    Direction,
}

/// Where the device's path first leaves that of the twin; `None` if they are the same path up
/// to rounding.
#[must_use]
pub fn parting(device: &Trail, twin: &Trail, viewpoint: &Viewpoint) -> Option<Parting> {
    let first = [device, twin].map(|trail| trail.segments.first());
    if let [Some(ours), Some(theirs)] = first
        && are_apart(ours.direction, theirs.direction)
    {
        return Some(Parting { vertex: 0, cause: Cause::Direction });
    }
    let longest = device.segments.len().max(twin.segments.len());
    (0..longest).find_map(|i| {
        let cause = match (device.segments.get(i), twin.segments.get(i)) {
            (Some(ours), Some(theirs)) => {
                at_vertex(ours, theirs, viewpoint).or_else(|| onwards(device, twin, i))
            }
            _ => Some(Cause::Ending),
        };
        cause.map(|cause| Parting { vertex: i + 1, cause })
    })
}

/// What differs where two segments end.
fn at_vertex(ours: &Segment, theirs: &Segment, viewpoint: &Viewpoint) -> Option<Cause> {
    match (ours.vertex, theirs.vertex) {
        (None, None) => {}
        (Some(a), Some(b)) if a.sphere == b.sphere => {
            let size = viewpoint.extent().max(b.position.distance(viewpoint.focus()));
            let is_near = a.position.distance(b.position) <= TOLERANCE * size;
            if !is_near {
                return Some(Cause::Position);
            }
            if are_apart(a.normal, b.normal) {
                return Some(Cause::Normal);
            }
        }
        _ => return Some(Cause::Sphere),
    }
    let [a, b] = [ours.connection, theirs.connection];
    if a.map(|a| a.light) != b.map(|b| b.light) {
        return Some(Cause::Light);
    }
    if a != b {
        return Some(Cause::Visibility);
    }
    if are_apart(ours.radiance, theirs.radiance) {
        return Some(Cause::Radiance);
    }
    are_apart(ours.weight, theirs.weight).then_some(Cause::Weight)
}

/// What differs in how two paths leave the vertex at the end of segment `i`.
fn onwards(device: &Trail, twin: &Trail, i: usize) -> Option<Cause> {
    match (device.segments.get(i + 1), twin.segments.get(i + 1)) {
        (Some(ours), Some(theirs)) => {
            are_apart(ours.direction, theirs.direction).then_some(Cause::Direction)
        }
        (None, None) => (device.ending != twin.ending).then_some(Cause::Ending),
        _ => Some(Cause::Ending),
    }
}

/// Whether two values differ by more than the tolerance, or one is not finite.
fn are_apart(a: DVec3, b: DVec3) -> bool {
    let size = a.abs().max_element().max(b.abs().max_element());
    let is_near = (a - b).abs().max_element() <= TOLERANCE * size;
    !(a.is_finite() && b.is_finite() && is_near)
}
