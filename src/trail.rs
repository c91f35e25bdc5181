//! What one path did, vertex by vertex, in the scene's units: what a device and the twin record
//! when they trace one sample again.

use crate::scene::{Estimator, Surface};
use crate::tracer::InvalidReason;
use glam::DVec3;

/// One path, from the camera to its end.
#[derive(Debug, Clone, PartialEq)]
pub struct Trail {
    /// Its segments, that from the camera first; at least one, at most one more than bounces.
    pub segments: Vec<Segment>,
    /// How it ended.
    pub ending: Ending,
    /// The sample's radiance as it goes into the film, in the scene's unit.
    pub radiance: [f32; 3],
}

impl Trail {
    /// A path that is over. Light from beyond an absorbing surface counts for nothing.
    pub(crate) fn ended(mut segments: Vec<Segment>, ending: Ending, radiance: [f32; 3]) -> Self {
        if let (Ending::Absorbed, Some(last)) = (ending, segments.last_mut()) {
            last.weight = DVec3::ZERO;
        }
        Self { segments, ending, radiance }
    }

    /// Why the sample would not enter a film with this bound, if so.
    #[must_use]
    pub fn invalid(&self, bound: f32) -> Option<InvalidReason> {
        if self.ending == Ending::Unfinished {
            return Some(InvalidReason::Unfinished);
        }
        InvalidReason::of(self.radiance, bound)
    }
}

/// One ray and what happened where it ended.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Segment {
    /// Where the ray starts.
    pub origin: DVec3,
    /// Unit vector along it.
    pub direction: DVec3,
    /// What it hit; `None` where it escaped or the search was cut short.
    pub vertex: Option<Vertex>,
    /// The light that was sampled from the vertex, under the estimators that do so.
    pub connection: Option<Connection>,
    /// Product of the weights of the scatterings so far, that at the vertex included: what
    /// light from further on counts for. 0 where the path was absorbed.
    pub weight: DVec3,
    /// Radiance that the path has brought so far.
    pub radiance: DVec3,
}

/// A point where a path met a surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Vertex {
    /// Place of the sphere among the scene's.
    pub sphere: usize,
    /// Length of the segment.
    pub distance: f64,
    /// The point.
    pub position: DVec3,
    /// Unit normal on the side that the path came from.
    pub normal: DVec3,
}

/// A sampled light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Connection {
    /// Place of the light among the scene's spheres.
    pub light: usize,
    /// Whether nothing stands before the point that was sampled on it.
    pub visible: bool,
}

/// How a path ended.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Ending {
    /// On a light.
    Light,
    /// It met nothing.
    Escaped,
    /// At the limit of bounces; also where what is left could only find light that was
    /// sampled before.
    Limit,
    /// A scattering had weight 0: its direction lies under the surface.
    Absorbed,
    /// The driver cut a loop short.
    Unfinished,
}

impl Ending {
    /// Why a path of at most `bounces` scatterings does not go on after `bounce` of them, from
    /// a surface or, without one, from nowhere.
    pub(crate) fn at(
        surface: Option<Surface>,
        bounce: u32,
        bounces: u32,
        estimator: Estimator,
    ) -> Self {
        match surface {
            None => Self::Escaped,
            Some(Surface::Emitter(_)) => Self::Light,
            Some(_) if bounce >= bounces => Self::Limit,
            // One scattering is left, which could only find a light that was sampled here.
            Some(Surface::Diffuse(_)) if estimator == Estimator::Explicit => Self::Limit,
            Some(_) => Self::Absorbed,
        }
    }
}
