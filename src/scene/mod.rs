//! The validated scene: types that cannot hold an invalid value.
//!
//! Every type here is built by a constructor that refuses what candor cannot
//! render and says what is allowed; the fields are private, so a [`Scene`] that
//! exists is a scene that can be rendered. Lengths are in the scene's own unit,
//! angles in radians unless the name says degrees, radiance in the scene's own
//! unit of W·sr⁻¹·m⁻² per channel (linear, Rec. 709 primaries).

mod error;
mod file;
mod hash;

pub use error::{Diagnostic, SceneFileError};
pub use file::{load, parse};
pub use hash::SceneHash;

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

/// A pinhole camera with square pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct Camera {
    position: DVec3,
    forward: DVec3,
    right: DVec3,
    up: DVec3,
    vertical_fov: f64,
}

impl Camera {
    /// Looks from `position` towards `look_at`; `vertical_fov` in degrees, in (0, 180).
    ///
    /// # Errors
    /// If a coordinate is not finite or larger than [`MAX_LENGTH`], the camera looks
    /// at itself, `up` is zero or along the view direction, or the angle is out of range.
    pub fn new(
        position: DVec3,
        look_at: DVec3,
        up: DVec3,
        vertical_fov: f64,
    ) -> Result<Self, Invalid> {
        check_point(position)?;
        check_point(look_at)?;
        check_point(up)?;
        if !(vertical_fov > 0.0 && vertical_fov < 180.0) {
            return refuse("an angle in degrees, greater than 0 and less than 180");
        }
        let Some(forward) = (look_at - position).try_normalize() else {
            return refuse("a point other than the camera's position");
        };
        // |forward × up| is the sine of the angle between the two; below 1e-9 the
        // picture's roll would be decided by rounding.
        let right = match up.try_normalize().map(|up| forward.cross(up)) {
            Some(right) if right.length() > 1e-9 => right.normalize(),
            _ => return refuse("a direction that is not zero and not along the view direction"),
        };
        Ok(Self {
            position,
            forward,
            right,
            up: right.cross(forward),
            vertical_fov: vertical_fov.to_radians(),
        })
    }

    /// Where the rays start.
    #[must_use]
    pub fn position(&self) -> DVec3 {
        self.position
    }

    /// Unit view direction.
    #[must_use]
    pub fn forward(&self) -> DVec3 {
        self.forward
    }

    /// Unit vector towards the right of the picture.
    #[must_use]
    pub fn right(&self) -> DVec3 {
        self.right
    }

    /// Unit vector towards the top of the picture.
    #[must_use]
    pub fn up(&self) -> DVec3 {
        self.up
    }

    /// Full vertical field of view, in radians.
    #[must_use]
    pub fn vertical_fov(&self) -> f64 {
        self.vertical_fov
    }
}

/// Width and height of a picture, in pixels; each in 1..=[`MAX_SIDE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct ImageSize {
    width: u32,
    height: u32,
}

impl ImageSize {
    /// # Errors
    /// If a side is zero or larger than [`MAX_SIDE`].
    pub fn new(width: u32, height: u32) -> Result<Self, Invalid> {
        let allowed = 1..=MAX_SIDE;
        if !allowed.contains(&width) || !allowed.contains(&height) {
            return refuse(format!("a whole number from 1 to {MAX_SIDE}"));
        }
        Ok(Self { width, height })
    }

    /// Pixels in a row.
    #[must_use]
    pub fn width(self) -> u32 {
        self.width
    }

    /// Rows.
    #[must_use]
    pub fn height(self) -> u32 {
        self.height
    }

    /// Number of pixels; less than 2³².
    #[must_use]
    pub fn pixels(self) -> u32 {
        self.width * self.height
    }
}

/// Reflectance ρ per channel, each in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Albedo(DVec3);

impl Albedo {
    /// # Errors
    /// If a channel is outside [0, 1] or NaN.
    pub fn new(rho: DVec3) -> Result<Self, Invalid> {
        if rho.to_array().iter().all(|c| (0.0..=1.0).contains(c)) {
            Ok(Self(rho))
        } else {
            refuse("an albedo per channel, each from 0 to 1")
        }
    }

    /// The three channels.
    #[must_use]
    pub fn rgb(self) -> DVec3 {
        self.0
    }
}

/// Emitted radiance per channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Radiance(DVec3);

impl Radiance {
    /// # Errors
    /// If a channel is negative, not finite or above [`MAX_RADIANCE`], or the brightest
    /// is below [`MIN_RADIANCE`].
    pub fn new(rgb: DVec3) -> Result<Self, Invalid> {
        let in_range = rgb.to_array().iter().all(|c| (0.0..=MAX_RADIANCE).contains(c));
        if in_range && rgb.max_element() >= MIN_RADIANCE {
            Ok(Self(rgb))
        } else {
            refuse(format!(
                "a radiance per channel, each from 0 to {MAX_RADIANCE:e}, the largest at least {MIN_RADIANCE:e}"
            ))
        }
    }

    /// The three channels.
    #[must_use]
    pub fn rgb(self) -> DVec3 {
        self.0
    }
}

/// Phong exponent n, in [0, [`MAX_EXPONENT`]].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Exponent(f64);

impl Exponent {
    /// # Errors
    /// If `n` is outside the range or NaN.
    pub fn new(n: f64) -> Result<Self, Invalid> {
        if (0.0..=MAX_EXPONENT).contains(&n) {
            Ok(Self(n))
        } else {
            refuse(format!("a Phong exponent from 0 to {MAX_EXPONENT:e}"))
        }
    }

    /// The exponent.
    #[must_use]
    pub fn get(self) -> f64 {
        self.0
    }
}

/// What a sphere's surface does with light.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Surface {
    /// Emits on both sides, reflects nothing, ends the path.
    Emitter(Radiance),
    /// Lambertian: `f_r` = ρ/π.
    Diffuse(Albedo),
    /// Phong lobe about the mirror direction: `f_r` = ρ(n+1)cosⁿα/2π.
    Glossy(Albedo, Exponent),
}

/// A sphere with its surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Sphere {
    name: Option<String>,
    center: DVec3,
    radius: f64,
    surface: Surface,
}

impl Sphere {
    /// # Errors
    /// If the centre has a coordinate that is not finite or above [`MAX_LENGTH`], or
    /// the radius is outside [[`MIN_RADIUS`], [`MAX_LENGTH`]].
    pub fn new(center: DVec3, radius: f64, surface: Surface) -> Result<Self, Invalid> {
        check_point(center)?;
        check_radius(radius)?;
        Ok(Self { name: None, center, radius, surface })
    }

    /// Names the sphere for messages.
    #[must_use]
    pub fn named(mut self, name: impl Into<String>) -> Self {
        self.name = Some(name.into());
        self
    }

    /// The name given in the scene file.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        self.name.as_deref()
    }

    /// Centre.
    #[must_use]
    pub fn center(&self) -> DVec3 {
        self.center
    }

    /// Radius, positive.
    #[must_use]
    pub fn radius(&self) -> f64 {
        self.radius
    }

    /// What the surface does with light.
    #[must_use]
    pub fn surface(&self) -> Surface {
        self.surface
    }
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

/// How paths are built; each estimator has the same mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// The source's: uniform hemisphere at diffuse surfaces, Phong lobe at glossy
    /// ones, light counted only where a path hits it by itself.
    #[default]
    Implicit,
}

impl Estimator {
    /// The name used in scene files, on the command line and in film headers.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Implicit => "implicit",
        }
    }
}

impl std::str::FromStr for Estimator {
    type Err = Invalid;

    fn from_str(name: &str) -> Result<Self, Invalid> {
        match name {
            "implicit" => Ok(Self::Implicit),
            _ => refuse("an estimator; this version has \"implicit\""),
        }
    }
}

/// The `[render]` table: what a render does unless the command line says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RenderSettings {
    spp: u64,
    bounces: u32,
    estimator: Estimator,
    seed: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self { spp: 256, bounces: 2, estimator: Estimator::Implicit, seed: 0 }
    }
}

impl RenderSettings {
    /// Replaces the samples per pixel.
    ///
    /// # Errors
    /// If `spp` is outside 1..=[`MAX_SPP`].
    pub fn with_spp(mut self, spp: u64) -> Result<Self, Invalid> {
        if !(1..=MAX_SPP).contains(&spp) {
            return refuse(format!("a whole number from 1 to {MAX_SPP}"));
        }
        self.spp = spp;
        Ok(self)
    }

    /// Replaces the most scatterings of one path.
    ///
    /// # Errors
    /// If `bounces` is above [`MAX_BOUNCES`].
    pub fn with_bounces(mut self, bounces: u32) -> Result<Self, Invalid> {
        if bounces > MAX_BOUNCES {
            return refuse(format!("a whole number from 0 to {MAX_BOUNCES}"));
        }
        self.bounces = bounces;
        Ok(self)
    }

    /// Replaces the estimator.
    #[must_use]
    pub fn with_estimator(mut self, estimator: Estimator) -> Self {
        self.estimator = estimator;
        self
    }

    /// Replaces the seed of the random numbers.
    #[must_use]
    pub fn with_seed(mut self, seed: u32) -> Self {
        self.seed = seed;
        self
    }

    /// Samples per pixel.
    #[must_use]
    pub fn spp(self) -> u64 {
        self.spp
    }

    /// Most scatterings of one path.
    #[must_use]
    pub fn bounces(self) -> u32 {
        self.bounces
    }

    /// The estimator.
    #[must_use]
    pub fn estimator(self) -> Estimator {
        self.estimator
    }

    /// Seed of the random numbers.
    #[must_use]
    pub fn seed(self) -> u32 {
        self.seed
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
    #[must_use]
    pub fn new(
        camera: Camera,
        size: ImageSize,
        settings: RenderSettings,
        spheres: Vec<Sphere>,
    ) -> Self {
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
        self.spheres.iter().any(|s| matches!(s.surface, Surface::Emitter(_)))
    }
}
