//! How large a picture's error may be: an upper confidence bound on the realised error.
//!
//! The realised error of a picture of P pixels is R = √Q/μ, with Q the mean over pixels of
//! (x̄ − μ_p)² and μ the mean of the true pixel means μ_p. After N samples per pixel, with V the
//! mean of the pixels' unbiased variances s²,
//!
//!   N·Q = V + W,  W = 1/P Σ (N(x̄ − μ_p)² − s²) = 1/(P(N−1)) Σ_p Σ_{i≠j} (x_i − μ_p)(x_j − μ_p):
//!
//! the naive estimate is off by a W whose mean is exactly 0 and whose variance is exactly
//! 2N/(N−1)·Σσ⁴/P², whatever the samples' distribution. (DESIGN.md, "Stopping at a stated
//! error", has the derivation, and says what of it is proven.)

use super::looks::MOST_LOOKS;
use super::pixel::PixelEstimate;
use crate::scene::MAX_SPP;

/// The bounds of one render hold together with this probability.
const CONFIDENCE: f64 = 0.99;

/// What can go wrong at one look: W, the variance or the mean.
const EVENTS: f64 = 3.0;

/// What the pixels of one film say together about its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    pixels: f64,
    /// Largest luminance that one sample can have, M.
    sample_bound: f64,
    /// Sum of the pixels' mean luminances.
    luminance: f64,
    /// Sum of the pixels' variances, Σs².
    variance: f64,
    /// Sum of their squares, Σs⁴.
    squares: f64,
    /// The largest of them.
    largest: f64,
}

impl Spread {
    /// Of no pixels yet, for samples of at most `sample_bound` in each channel.
    pub(super) fn new(sample_bound: f64) -> Self {
        let (pixels, luminance, variance, squares, largest) = (0.0, 0.0, 0.0, 0.0, 0.0);
        Self { pixels, sample_bound, luminance, variance, squares, largest }
    }

    pub(super) fn add(&mut self, pixel: &PixelEstimate) {
        self.pixels += 1.0;
        self.luminance += pixel.luminance;
        self.variance += pixel.variance;
        self.squares += pixel.variance * pixel.variance;
        self.largest = self.largest.max(pixel.variance);
    }

    /// Mean luminance of the picture.
    pub(super) fn luminance(&self) -> f64 {
        self.luminance / self.pixels
    }

    /// Mean variance of the pixels.
    pub(super) fn variance(&self) -> f64 {
        self.variance / self.pixels
    }

    /// Upper confidence bound on the realised relative RMS error of a picture of `samples`
    /// samples per pixel whose means and variances are these: 99 % over all looks of a render
    /// together. Infinite where that proves nothing, as for a picture that is black so far.
    ///
    /// With L = ln(1/δ): W from the tail of a Gaussian chaos, 2√L·‖σ²‖₂/P + 2L·σ²_max/P (Laurent &
    /// Massart, Ann. Statist. 28(5), 2000, lemma 1), where what light that was not found
    /// yet may add is put on top of s; the mean from Bernstein's inequality; the variance in
    /// that one from Maurer & Pontil (COLT 2009, theorem 10), pooled over pixels.
    #[must_use]
    pub fn ceiling(&self, samples: u64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "at most 2^32 samples")]
        let n = samples as f64;
        let (all, bound) = (n * self.pixels, self.sample_bound);
        let l = (EVENTS * f64::from(MOST_LOOKS) / (1.0 - CONFIDENCE)).ln();

        let unseen = l * bound * bound / n;
        let deviation = self.largest.sqrt() + (unseen / 2.0).sqrt();
        let chaos = 2.0 * l.sqrt() * (self.squares.sqrt() + unseen) + 2.0 * l * deviation.powi(2);
        let mean_square = (self.variance + chaos) / all;

        let slack = l * bound * bound / (2.0 * self.pixels * (n - 1.0));
        let variance = ((self.variance() + slack).sqrt() + slack.sqrt()).powi(2);
        let below = (2.0 * l * variance / all).sqrt() + l * bound / (3.0 * all);
        let mean = self.luminance() - below;
        // A variance of fewer than two samples is NaN, and so is then the mean.
        if mean > 0.0 { mean_square.sqrt() / mean } else { f64::INFINITY }
    }

    /// The count of samples per pixel from which on the bound is at or below `target`, as the
    /// means and variances stand; `None` if no film can hold so many.
    #[must_use]
    pub fn samples_to(&self, target: f64) -> Option<u64> {
        let reached = |samples| self.ceiling(samples) <= target;
        let (mut below, mut above) = (1, MAX_SPP);
        if !reached(above) {
            return None;
        }
        // The bound falls with the count.
        while above - below > 1 {
            let middle = below.midpoint(above);
            *(if reached(middle) { &mut above } else { &mut below }) = middle;
        }
        Some(above)
    }
}
