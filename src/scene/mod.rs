//! The validated scene: types that cannot hold an invalid value.
//!
//! Every type here is built by a constructor that refuses what candor cannot
//! render and says what is allowed; the fields are private, so a [`Scene`] that
//! exists is a scene that can be rendered. Lengths are in the scene's own unit,
//! angles in radians unless the name says degrees, radiance in the scene's own
//! unit of W·sr⁻¹·m⁻² per channel (linear, Rec. 709 primaries).

mod camera;
mod cloud;
mod coincident;
mod error;
mod file;
mod hash;
mod settings;
mod spelling;
mod sphere;

use coincident::drop_hidden;

pub use camera::{Camera, ImageSize};
pub use error::{Diagnostic, SceneFileError};
pub use file::{Source, load, load_with_source, parse};
pub use hash::SceneHash;
pub use settings::{Estimator, RenderSettings};
pub use sphere::{Albedo, Exponent, Radiance, Sphere, Surface};

use glam::DVec3;

/// Largest magnitude of a coordinate or radius, in scene units.
pub const MAX_LENGTH: f64 = 1e15;
/// Smallest radius, in scene units.
pub const MIN_RADIUS: f64 = 1e-15;
/// Largest radiance of an emitter, per channel.
pub const MAX_RADIANCE: f64 = 1e15;
/// Smallest radiance that an emitter's brightest channel may have.
///
/// The film resolves 2⁻⁶⁴ of the largest sample; from here up that step stays a
/// normal `f32`, so a device that flushes subnormals loses nothing.
pub const MIN_RADIANCE: f64 = 1e-15;
/// Largest Phong exponent: beyond it the lobe is narrower than the spacing of
/// `f32` direction components (6e-8 against a lobe width of 1/√n).
pub const MAX_EXPONENT: f64 = 1e10;
/// Most scatterings of one path.
pub const MAX_BOUNCES: u32 = 64;
/// Most samples per pixel that one film can hold.
pub const MAX_SPP: u64 = 1 << 32;
/// Largest width and height of a picture, in pixels.
pub const MAX_SIDE: u32 = 65_535;

/// Why a value was refused: what is allowed, as the second half of a sentence.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[error("{0}")]
pub struct Invalid(pub String);

fn refuse<T>(allowed: impl Into<String>) -> Result<T, Invalid> {
    Err(Invalid(allowed.into()))
}

/// Checks one point or vector of the scene file.
///
/// # Errors
/// If a coordinate is not finite or larger than [`MAX_LENGTH`].
pub fn check_point(p: DVec3) -> Result<(), Invalid> {
    if p.to_array().iter().all(|c| c.abs() <= MAX_LENGTH) {
        Ok(())
    } else {
        refuse(format!("three finite numbers, each from -{MAX_LENGTH:e} to {MAX_LENGTH:e}"))
    }
}

/// Checks a radius.
///
/// # Errors
/// If it is outside [[`MIN_RADIUS`], [`MAX_LENGTH`]] or NaN.
pub fn check_radius(radius: f64) -> Result<(), Invalid> {
    if (MIN_RADIUS..=MAX_LENGTH).contains(&radius) {
        Ok(())
    } else {
        refuse(format!("a radius from {MIN_RADIUS:e} to {MAX_LENGTH:e}"))
    }
}

/// A scene that can be rendered.
#[derive(Debug, Clone, PartialEq)]
pub struct Scene {
    camera: Camera,
    size: ImageSize,
    settings: RenderSettings,
    spheres: Vec<Sphere>,
}

impl Scene {
    /// Puts checked parts together; any combination of them is a scene.
    ///
    /// Of spheres with the same centre and radius only the first can ever be seen, from
    /// either side; the others are left out.
    #[must_use]
    pub fn new(
        camera: Camera,
        size: ImageSize,
        settings: RenderSettings,
        mut spheres: Vec<Sphere>,
    ) -> Self {
        for (ordinal, sphere) in (1..).zip(&mut spheres) {
            sphere.set_ordinal(ordinal);
        }
        drop_hidden(&mut spheres);
        Self { camera, size, settings, spheres }
    }

    /// The camera.
    #[must_use]
    pub fn camera(&self) -> &Camera {
        &self.camera
    }

    /// The picture's size.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// The settings of the `[render]` table.
    #[must_use]
    pub fn settings(&self) -> RenderSettings {
        self.settings
    }

    /// The spheres in the order of the file; where two are hit at the same distance,
    /// the first wins.
    #[must_use]
    pub fn spheres(&self) -> &[Sphere] {
        &self.spheres
    }

    /// The same scene at another size.
    #[must_use]
    pub fn with_size(mut self, size: ImageSize) -> Self {
        self.size = size;
        self
    }

    /// The same scene with other settings.
    #[must_use]
    pub fn with_settings(mut self, settings: RenderSettings) -> Self {
        self.settings = settings;
        self
    }

    /// Whether any sphere emits; without one the picture is exactly zero.
    #[must_use]
    pub fn has_lights(&self) -> bool {
        self.spheres.iter().any(Sphere::emits)
    }
}
