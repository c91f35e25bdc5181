//! A stored picture as the tests need it: means and error bars, without the sums.

use super::group::{Group, Sides};
use crate::film::LUMINANCE_WEIGHTS;
use crate::scene::ImageSize;

/// A picture and what is known of its error; rows from the top.
#[derive(Debug, Clone, Copy)]
pub struct Measured<'a> {
    /// Width and height in pixels.
    pub size: ImageSize,
    /// Mean radiance per channel, linear Rec. 709; finite.
    pub rgb: &'a [[f32; 3]],
    /// Error bars; without them the means are taken as exact.
    pub bars: Option<Bars<'a>>,
    /// Relative rounding of the stored means.
    pub rounding: f64,
}

/// How well the pixels are known.
#[derive(Debug, Clone, Copy)]
pub struct Bars<'a> {
    /// Standard error of the mean luminance; infinite where it is unproven, which only
    /// black pixels are.
    pub luminance_error: &'a [f32],
    /// Samples per pixel, at least 1.
    pub samples: u64,
}

impl Bars<'_> {
    /// Number of pixels whose error is unproven.
    #[must_use]
    pub fn unproven_pixels(&self) -> usize {
        self.luminance_error.iter().filter(|error| error.is_infinite()).count()
    }
}

impl Measured<'_> {
    /// The pixels of two pictures.
    ///
    /// # Panics
    /// If the pictures differ in size.
    pub(super) fn side_by_side(a: &Self, b: &Self) -> impl Iterator<Item = Sides> {
        assert_eq!(a.size, b.size, "pictures of one size");
        (0..a.rgb.len()).map(|i| [a.pixel(i), b.pixel(i)])
    }

    /// What is known of a pixel. The sums over its samples follow from mean, error and
    /// count: with s² = N·error² the unbiased variance, ΣY² = (N-1)·s² + N·mean².
    ///
    /// An unproven pixel counts with variance 0. That is the unbiased estimate which its
    /// samples, all 0, give; the tile's hits tell whether the tile's sum can be trusted.
    #[expect(clippy::cast_precision_loss, reason = "at most 2^32 samples")]
    fn pixel(&self, i: usize) -> Group {
        let mean = luminance(self.rgb[i]);
        let Some(bars) = self.bars else { return Group { mean, ..Group::default() } };
        let error = f64::from(bars.luminance_error[i]);
        let proven = error.is_finite();
        let variance = if proven { error * error } else { 0.0 };
        let n = bars.samples as f64;
        let squares = n * ((n - 1.0) * variance + mean * mean);
        Group { mean, variance, sum: n * mean, squares, proven }
    }
}

/// Luminance by the film's weights.
pub(super) fn luminance(rgb: [f32; 3]) -> f64 {
    let terms = std::iter::zip(rgb, LUMINANCE_WEIGHTS).map(|(x, w)| f64::from(x) * f64::from(w));
    terms.sum::<f64>() / 65_536.0
}
