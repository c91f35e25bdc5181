//! What is known of the mean of a group of pixels, and blocks of pixels as groups.

use super::pixel::effective_hits;
use crate::scene::ImageSize;

/// Sums over a group of pixels of one picture, by their luminance.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Group {
    /// Sum of the pixels' means.
    pub mean: f64,
    /// Variance of that sum.
    pub variance: f64,
    /// Sum of all samples, ΣY.
    pub sum: f64,
    /// Sum of their squares, ΣY².
    pub squares: f64,
    /// Whether the error of any of its pixels is known.
    pub proven: bool,
}

impl Group {
    pub fn add(&mut self, other: &Self) {
        self.mean += other.mean;
        self.variance += other.variance;
        self.sum += other.sum;
        self.squares += other.squares;
        self.proven |= other.proven;
    }

    /// Effective number of samples that contributed.
    pub fn hits(&self) -> f64 {
        effective_hits(self.sum, self.squares)
    }
}

/// The same pixels in two pictures.
pub(super) type Sides = [Group; 2];

pub(super) fn add(to: &mut Sides, other: &Sides) {
    for (to, other) in to.iter_mut().zip(other) {
        to.add(other);
    }
}

/// Gathers pixels, row by row, into blocks of `length`², smaller at the right and lower
/// edge; the blocks come in the order of their first pixels.
pub(super) fn blocks(
    size: ImageSize,
    length: usize,
    pixels: impl Iterator<Item = Sides>,
) -> Vec<Sides> {
    let width = size.width() as usize;
    let columns = width.div_ceil(length);
    let rows = (size.height() as usize).div_ceil(length);
    let mut blocks = vec![Sides::default(); columns * rows];
    for (i, pixel) in pixels.enumerate() {
        add(&mut blocks[i / width / length * columns + i % width / length], &pixel);
    }
    blocks
}

/// The difference of the means in standard errors. `rounding` is a relative error of the
/// means, which is all there is where they have no variance.
pub(super) fn z([a, b]: &Sides, rounding: f64) -> f64 {
    let difference = a.mean - b.mean;
    let rounding = rounding * f64::max(a.mean.abs(), b.mean.abs());
    let error = (a.variance + b.variance + rounding * rounding).sqrt();
    if difference == 0.0 { 0.0 } else { difference / error }
}
