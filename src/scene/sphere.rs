//! Spheres and what their surfaces do with light.

use super::error::{printable, quoted};
use super::{Invalid, MAX_EXPONENT, MAX_RADIANCE, MIN_RADIANCE, check_point, check_radius, refuse};
use glam::DVec3;
use std::sync::Arc;

/// Reflectance ρ per channel, each in [0, 1].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Albedo(DVec3);

impl Albedo {
    /// # Errors
    /// If a channel is outside [0, 1] or NaN.
    pub fn new(rho: DVec3) -> Result<Self, Invalid> {
        if rho.to_array().iter().all(|c| (0.0..=1.0).contains(c)) {
            Ok(Self(without_minus_zero(rho)))
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
            Ok(Self(without_minus_zero(rgb)))
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
    origin: Origin,
    ordinal: usize,
    center: DVec3,
    radius: f64,
    surface: Surface,
}

/// Where a sphere comes from, for messages. A million spheres share the name of their file.
#[derive(Debug, Clone, PartialEq)]
enum Origin {
    /// A part of the scene file without a name.
    Nameless,
    /// A part of the scene file with a name.
    Named(Box<str>),
    /// A data file and the number of a line of it, counted from 1.
    Row(Arc<str>, u32),
}

impl Sphere {
    /// # Errors
    /// If the centre has a coordinate that is not finite or above [`MAX_LENGTH`](super::MAX_LENGTH), or
    /// the radius is outside [[`MIN_RADIUS`](super::MIN_RADIUS), [`MAX_LENGTH`](super::MAX_LENGTH)].
    pub fn new(center: DVec3, radius: f64, surface: Surface) -> Result<Self, Invalid> {
        check_point(center)?;
        check_radius(radius)?;
        Ok(Self { origin: Origin::Nameless, ordinal: 0, center, radius, surface })
    }

    /// Names the sphere for messages.
    #[must_use]
    pub fn named(mut self, name: impl Into<Box<str>>) -> Self {
        self.origin = Origin::Named(name.into());
        self
    }

    /// Says for messages that the sphere is that of a line of a data file, counted from 1.
    pub(super) fn at_row(mut self, file: &Arc<str>, line: usize) -> Self {
        self.origin = Origin::Row(Arc::clone(file), u32::try_from(line).unwrap_or(u32::MAX));
        self
    }

    /// The name given in the scene file.
    #[must_use]
    pub fn name(&self) -> Option<&str> {
        match &self.origin {
            Origin::Named(name) => Some(name),
            Origin::Nameless | Origin::Row(..) => None,
        }
    }

    /// Its number in the scene, counted from 1 in the order of the file, in which the rows of
    /// data files follow the spheres of the scene file; 0 before it is part
    /// of one.
    #[must_use]
    pub fn ordinal(&self) -> usize {
        self.ordinal
    }

    pub(super) fn set_ordinal(&mut self, ordinal: usize) {
        self.ordinal = ordinal;
    }

    /// What messages call it: `sphere 3`, with its name or its row if it has one.
    #[must_use]
    pub fn title(&self) -> String {
        match &self.origin {
            Origin::Row(..) => format!("sphere {} ({})", self.ordinal, self.label()),
            Origin::Nameless | Origin::Named(_) => title(self.ordinal, self.name()),
        }
    }

    /// What a table calls it: its name, made printable, its row, or `sphere 3`.
    #[must_use]
    pub fn label(&self) -> String {
        match &self.origin {
            Origin::Nameless => title(self.ordinal, None),
            Origin::Named(name) => printable(name),
            Origin::Row(file, line) => format!("{}, line {line}", printable(file)),
        }
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

    /// Whether it is a light.
    #[must_use]
    pub fn emits(&self) -> bool {
        matches!(self.surface, Surface::Emitter(_))
    }
}

/// What messages call a sphere, by its number and its name.
pub(super) fn title(ordinal: usize, name: Option<&str>) -> String {
    match name {
        Some(name) => format!("sphere {ordinal} ({})", quoted(name)),
        None => format!("sphere {ordinal}"),
    }
}

/// A sample of -0.0 would look negative to the film, which compares bit patterns.
fn without_minus_zero(rgb: DVec3) -> DVec3 {
    rgb + DVec3::ZERO
}
