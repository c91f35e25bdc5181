//! What the twin traces: the validated scene in its own units, with what a path asks
//! for laid out for it. It shares no packing with the kernel, so that a mistake in
//! `src/kernel` cannot hide in both.

use super::tree::Tree;
use crate::effects::{Effect, Effects};
use crate::light_tree::{LightTree, places};
use crate::scene::{Estimator, Scene, Surface};
use crate::viewpoint::{Viewpoint, is_small};
use glam::DVec3;

/// From so many spheres on, a hierarchy finds hits sooner than a loop over all of them.
const HIERARCHY_FROM: usize = 16;

/// How hits are found. Both ways find the same ones, to the bit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Search {
    /// In a loop over all spheres.
    Loop,
    /// In a hierarchy of boxes.
    Hierarchy,
}

impl Search {
    /// The faster way for a scene.
    #[must_use]
    pub fn of(scene: &Scene) -> Self {
        if scene.spheres().len() < HIERARCHY_FROM { Self::Loop } else { Self::Hierarchy }
    }
}

/// A scene ready to be traced.
#[derive(Debug, Clone)]
pub struct PreparedScene {
    pub(super) camera: Pinhole,
    pub(super) bounces: u32,
    pub(super) estimator: Estimator,
    pub(super) seed: u32,
    /// In the order of the scene file.
    pub(super) spheres: Vec<PreparedSphere>,
    /// Places of the emitters among them.
    pub(super) lights: Vec<usize>,
    /// A tree over them, where there are too many to scan.
    pub(super) light_tree: Option<LightTree>,
    /// None where hits are found in a loop.
    pub(super) tree: Option<Tree>,
}

/// The camera: `right` and `up` reach from the picture's centre to its edges on the
/// plane at distance 1.
#[derive(Debug, Clone)]
pub(super) struct Pinhole {
    pub(super) origin: DVec3,
    pub(super) forward: DVec3,
    pub(super) right: DVec3,
    pub(super) up: DVec3,
    pub(super) width: u32,
    pub(super) height: u32,
}

/// A sphere and the side from which it is seen.
#[derive(Debug, Clone)]
pub(super) struct PreparedSphere {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// Whether paths see only its inner side.
    pub(super) inside: bool,
    pub(super) surface: Surface,
}

impl PreparedScene {
    /// Prepares a scene; of many spheres on the threads of the pool that it is called in.
    #[must_use]
    pub fn new(scene: &Scene) -> Self {
        Self::searched(scene, Search::of(scene))
    }

    /// Prepares a scene, with a way to find hits.
    #[must_use]
    pub fn searched(scene: &Scene, search: Search) -> Self {
        let viewpoint = Viewpoint::of(scene);
        let sides = scene.spheres().iter().zip(viewpoint.inside());
        let spheres: Vec<PreparedSphere> = sides
            .map(|(sphere, &inside)| PreparedSphere {
                center: sphere.center(),
                radius: sphere.radius(),
                inside,
                surface: sphere.surface(),
            })
            .collect();
        Self {
            camera: Pinhole::of(scene),
            bounces: scene.settings().bounces(),
            estimator: scene.settings().estimator(),
            lights: places(scene).collect(),
            light_tree: Effects::of(scene, &viewpoint)
                .has(Effect::LightTree)
                .then(|| LightTree::of(scene, &viewpoint)),
            seed: scene.settings().seed(),
            tree: (search == Search::Hierarchy).then(|| {
                let is_small = |i: usize| is_small(viewpoint.forms()[i], spheres[i].inside);
                Tree::over(&spheres, viewpoint.focus(), is_small)
            }),
            spheres,
        }
    }
}

impl Pinhole {
    fn of(scene: &Scene) -> Self {
        let (camera, size) = (scene.camera(), scene.size());
        let half_height = (camera.vertical_fov() / 2.0).tan();
        let half_width = half_height * f64::from(size.width()) / f64::from(size.height());
        Self {
            origin: camera.position(),
            forward: camera.forward(),
            right: half_width * camera.right(),
            up: half_height * camera.up(),
            width: size.width(),
            height: size.height(),
        }
    }
}
