//! The error of a whole picture, without a reference.

use super::ceiling::Spread;
use super::pixel::{COARSE, estimate};
use crate::film::Film;

/// What a film says about its picture as a whole.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Summary {
    /// Samples per pixel.
    pub samples: u64,
    /// Mean luminance of the picture.
    pub luminance: f64,
    /// Relative RMS error: √(mean over pixels of σ²/n) ÷ mean luminance. `None` with
    /// fewer than two samples, or where every pixel is black and that is not proven.
    pub relative_error: Option<f64>,
    /// Upper confidence bound on the realised error, which [`Self::relative_error`] estimates:
    /// 99 % for all looks of a render together, see [`Spread::ceiling`]. `None` where nothing
    /// is proven yet.
    pub error_bound: Option<f64>,
    /// Standard error of the mean luminance.
    pub luminance_error: Option<f64>,
    /// Pixels to which no sample has contributed yet: their error is unproven, not zero.
    pub unproven_pixels: u64,
    /// Pixels whose film step exceeds 1e-6 of their mean.
    pub coarse_pixels: u64,
    /// What the bound is made of, to ask it about other counts.
    pub spread: Spread,
}

impl Summary {
    /// The summary of a scene without lights: exactly zero, and proven.
    #[must_use]
    pub fn of_darkness(samples: u64) -> Self {
        Self {
            samples,
            luminance: 0.0,
            relative_error: Some(0.0),
            error_bound: Some(0.0),
            luminance_error: Some(0.0),
            unproven_pixels: 0,
            coarse_pixels: 0,
            spread: Spread::new(0.0),
        }
    }
}

/// Summarizes a film of a scene that has lights.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "counts of pixels and samples")]
pub fn summarize(film: &Film) -> Summary {
    let samples = film.samples().count();
    let pixels = film.pixels().len() as f64;
    let mut spread = Spread::new(film.scale().bound().into());
    let (mut unproven_pixels, mut coarse_pixels) = (0, 0);
    for words in film.pixels() {
        let pixel = estimate(film, words);
        spread.add(&pixel);
        unproven_pixels += u64::from(pixel.is_unproven());
        let coarse = pixel.luminance < COARSE * film.scale().step();
        coarse_pixels += u64::from(coarse && !pixel.is_unproven());
    }
    let (luminance, variance) = (spread.luminance(), spread.variance() / samples as f64);
    let measured = samples >= 2 && luminance > 0.0;
    Summary {
        samples,
        luminance,
        relative_error: measured.then(|| variance.sqrt() / luminance),
        error_bound: Some(spread.ceiling(samples)).filter(|bound| bound.is_finite()),
        luminance_error: measured.then(|| (variance / pixels).sqrt()),
        unproven_pixels,
        coarse_pixels,
        spread,
    }
}
