//! The block of invocations that a workgroup traces.

use crate::scene::ImageSize;

/// The block of invocations of one workgroup: columns, rows and samples; 64 in all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tile {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples of each pixel.
    pub samples: u32,
}

impl Tile {
    /// Invocations of a workgroup.
    pub const INVOCATIONS: u32 = 64;

    /// A tile of 8×8 pixels and one sample; where the picture is narrower or lower than
    /// that, samples take the place of the missing pixels.
    #[must_use]
    pub fn of(size: ImageSize) -> Self {
        let width = size.width().next_power_of_two().min(8);
        let height = size.height().next_power_of_two().min(8);
        Self { width, height, samples: Self::INVOCATIONS / (width * height) }
    }
}
