//! How much two stored pictures differ, as numbers and place by place.

use super::compare::rounding;
use super::group::{Group, blocks, z};
use super::measured::{Measured, luminance};
use crate::scene::ImageSize;

/// ε of the relative MSE, in units of the reference's squared mean luminance, so that it
/// does not depend on the unit of radiance. For a picture of mean 1 it is the customary 0.01.
pub const RELATIVE_MSE_EPSILON: f64 = 0.01;

/// A block of the map needs this many effective hits on average: from some hundred on, its
/// error bar means what it says.
const MAP_HITS: f64 = 100.0;

/// Largest side of a block of the map, in pixels.
const MAX_BLOCK: usize = 16;

/// Differences of two pictures over all pixels; the second is the reference.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Mean luminance of each.
    pub luminance: [f64; 2],
    /// Root mean square difference of luminance.
    pub rmse: f64,
    /// What `rmse` would be if the error bars were all the difference (its mean square is
    /// the mean of both variances); `None` where neither picture has bars.
    pub expected_rmse: Option<f64>,
    /// Root mean square difference over pixels and channels.
    pub channel_rmse: f64,
    /// Mean over pixels and channels of (a - b)²/(b² + ε), see [`RELATIVE_MSE_EPSILON`];
    /// `None` where the mean luminance of b is not positive.
    pub relative_mse: Option<f64>,
}

/// Measures the differences.
///
/// # Panics
/// If the pictures differ in size.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "a count of pixels")]
pub fn difference(a: &Measured<'_>, b: &Measured<'_>) -> Difference {
    let pixels = a.rgb.len() as f64;
    let (mut means, mut squares, mut variance) = ([0.0; 2], 0.0, 0.0);
    for [a, b] in Measured::side_by_side(a, b) {
        means = [means[0] + a.mean / pixels, means[1] + b.mean / pixels];
        squares += (a.mean - b.mean).powi(2) / pixels;
        variance += (a.variance + b.variance) / pixels;
    }
    let floor = RELATIVE_MSE_EPSILON * means[1] * means[1];
    let (mut channel_squares, mut relative) = (0.0, 0.0);
    for (&x, &y) in std::iter::zip(a.rgb.as_flattened(), b.rgb.as_flattened()) {
        let (x, y) = (f64::from(x), f64::from(y));
        let square = (x - y).powi(2) / (3.0 * pixels);
        channel_squares += square;
        relative += square / (y * y + floor);
    }
    Difference {
        luminance: means,
        rmse: squares.sqrt(),
        expected_rmse: (a.bars.is_some() || b.bars.is_some()).then(|| variance.sqrt()),
        channel_rmse: channel_squares.sqrt(),
        relative_mse: (means[1] > 0.0).then_some(relative),
    }
}

/// Where two pictures differ: one value for each block of pixels.
#[derive(Debug, Clone, PartialEq)]
pub struct DifferenceMap {
    /// Size of the pictures.
    pub size: ImageSize,
    /// Side of a block in pixels, a power of two up to 16.
    pub block: usize,
    /// The blocks, row by row from the top; NaN where nothing is known of the error.
    pub values: Vec<f32>,
    /// What the values mean.
    pub unit: MapUnit,
}

/// What one unit of a difference is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MapUnit {
    /// A standard error of the difference.
    StandardErrors,
    /// A tenth of √(b² + ε), with ε as in the relative MSE: neither picture has bars.
    Tenths,
}

/// Maps the signed differences a - b of luminance: in standard errors of blocks just large
/// enough to have hits, or relative to `b` where there are no error bars.
///
/// # Panics
/// If the pictures differ in size.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "colours need few digits")]
pub fn difference_map(a: &Measured<'_>, b: &Measured<'_>) -> DifferenceMap {
    let size = a.size;
    if a.bars.is_none() && b.bars.is_none() {
        let scale = difference(a, b).luminance[1].powi(2) * RELATIVE_MSE_EPSILON;
        let values = std::iter::zip(a.rgb, b.rgb).map(|(&x, &y)| {
            let (difference, y) = (luminance(x) - luminance(y), luminance(y));
            let tenths = 10.0 * difference / (y * y + scale).sqrt();
            if difference == 0.0 { 0.0 } else { tenths as f32 }
        });
        return DifferenceMap { size, block: 1, values: values.collect(), unit: MapUnit::Tenths };
    }
    let block = block_side(a, b);
    let rounding = rounding(a, b);
    let values = blocks(size, block, Measured::side_by_side(a, b)).into_iter().map(|sides| {
        let known = sides.iter().any(|side: &Group| side.proven);
        if known { z(&sides, rounding) as f32 } else { f32::NAN }
    });
    DifferenceMap { size, block, values: values.collect(), unit: MapUnit::StandardErrors }
}

/// The smallest side at which blocks have enough hits on average in one of the pictures.
#[expect(clippy::cast_precision_loss, reason = "counts of pixels")]
fn block_side(a: &Measured<'_>, b: &Measured<'_>) -> usize {
    let mut hits = [0.0; 2];
    for pixel in Measured::side_by_side(a, b) {
        hits = std::array::from_fn(|i| hits[i] + pixel[i].hits());
    }
    let per_pixel = f64::max(hits[0], hits[1]) / a.rgb.len() as f64;
    let mut length = 1;
    while length < MAX_BLOCK && per_pixel * (length * length) as f64 <= MAP_HITS {
        length *= 2;
    }
    length
}
