//! What a scene calls for, decided once; the kernel is composed of nothing else.

use crate::scene::{Scene, Surface};
use crate::viewpoint::Viewpoint;

/// The effects that a scene calls for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effects {
    /// Some surface is diffuse.
    pub diffuse: bool,
    /// Some surface is glossy.
    pub glossy: bool,
    /// The camera is inside a sphere, whose inner side is then seen.
    pub interior: bool,
}

impl Effects {
    /// Every effect there is: what the general kernel is composed of.
    pub const ALL: Self = Self { diffuse: true, glossy: true, interior: true };

    /// Derives the effects from a scene.
    #[must_use]
    pub fn of(scene: &Scene, viewpoint: &Viewpoint) -> Self {
        let any =
            |wanted: fn(&Surface) -> bool| scene.spheres().iter().any(|s| wanted(&s.surface()));
        Self {
            diffuse: any(|s| matches!(s, Surface::Diffuse(_))),
            glossy: any(|s| matches!(s, Surface::Glossy(..))),
            interior: viewpoint.inside().contains(&true),
        }
    }
}
