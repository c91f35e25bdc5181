//! What the samples of a film depend on besides their addresses.

use super::{Difference, SampleScale};
use crate::scene::{Estimator, ImageSize, Scene, SceneHash};

/// Version of the numbers. It is raised with every change that gives the sample of some pixel,
/// index and seed another value, so that films from before and after are never added.
pub const NUMBERS: u32 = 1;

/// Hexadecimal digits of a scene's hash that tell two scenes apart in a message.
const SHOWN_DIGITS: usize = 16;

/// What must agree before two films are added, or one is continued.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Identity {
    /// [`NUMBERS`] of the program that made it.
    pub numbers: u32,
    /// Width and height in pixels.
    pub size: ImageSize,
    /// Hash of camera, size and spheres.
    pub scene: SceneHash,
    /// Estimator.
    pub estimator: Estimator,
    /// Most scatterings of one path.
    pub bounces: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// How samples become integers.
    pub scale: SampleScale,
}

impl Identity {
    /// That of a scene which this program renders at this scale.
    #[must_use]
    pub fn of(scene: &Scene, scale: SampleScale) -> Self {
        let settings = scene.settings();
        Self {
            numbers: NUMBERS,
            size: scene.size(),
            scene: scene.hash(),
            estimator: settings.estimator(),
            bounces: settings.bounces(),
            seed: settings.seed(),
            scale,
        }
    }

    /// Checks that another film has the same samples at the same addresses.
    ///
    /// # Errors
    /// The first field that differs. The size comes before the scene, whose hash covers it.
    pub fn check(&self, other: &Self) -> Result<(), Difference> {
        let pairs = std::iter::zip(self.fields(), other.fields());
        let different = pairs.into_iter().find(|((_, ours), (_, theirs))| ours != theirs);
        different
            .map_or(Ok(()), |((field, ours), (_, theirs))| Err(Difference { field, ours, theirs }))
    }

    fn fields(&self) -> [(&'static str, String); 7] {
        let hash = &self.scene.to_string()[..SHOWN_DIGITS];
        [
            ("version of the numbers", self.numbers.to_string()),
            ("size", self.size.to_string()),
            ("scene", format!("{hash}…")),
            ("estimator", self.estimator.name().to_owned()),
            ("number of bounces", self.bounces.to_string()),
            ("seed", self.seed.to_string()),
            ("scale", self.scale.to_string()),
        ]
    }
}
