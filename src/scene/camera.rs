//! The camera and the picture that it takes.

use super::{Invalid, MAX_SIDE, check_point, refuse};
use glam::DVec3;

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
    /// If a coordinate is not finite or larger than [`MAX_LENGTH`](super::MAX_LENGTH), the camera looks
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

/// `640x480`.
impl std::fmt::Display for ImageSize {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}x{}", self.width, self.height)
    }
}
