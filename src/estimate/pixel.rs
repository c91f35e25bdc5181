//! The estimate of one pixel from its exact sums.

use crate::film::{Film, LUMINANCE_WEIGHTS, PixelWords, sums};

/// Mean radiance of a pixel and what is known of its error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PixelEstimate {
    /// Mean radiance per channel, linear Rec. 709.
    pub rgb: [f64; 3],
    /// Mean luminance.
    pub luminance: f64,
    /// Variance of one sample's luminance (unbiased, N - 1); NaN with fewer than two samples.
    pub variance: f64,
    /// Mean of the squared luminance, with what truncation may hide of it.
    pub mean_square: f64,
}

impl PixelEstimate {
    /// Standard error of the mean luminance after `samples` samples; NaN with fewer than two.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "at most 2^32 samples")]
    pub fn standard_error(&self, samples: u64) -> f64 {
        (self.variance / samples as f64).sqrt()
    }

    /// Effective number of the `samples` that contributed.
    #[must_use]
    #[expect(clippy::cast_precision_loss, reason = "at most 2^32 samples")]
    pub fn hits(&self, samples: u64) -> f64 {
        let n = samples as f64;
        effective_hits(self.luminance * n, self.mean_square * n)
    }

    /// Whether no sample has contributed yet, so that the error is unproven, not zero.
    #[must_use]
    pub fn is_unproven(&self) -> bool {
        self.luminance == 0.0
    }
}

/// Effective number of contributing samples, (ΣY)²/ΣY² (Kish 1965): the number of hits
/// where all hits are alike.
pub(super) fn effective_hits(sum: f64, squares: f64) -> f64 {
    if squares > 0.0 { sum * (sum / squares) } else { 0.0 }
}

/// Below this many film steps a pixel's mean is coarse: what truncation hides is no
/// longer small beside it.
pub(super) const COARSE: f64 = 1e6;

/// Estimates one pixel of a film from its words.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "from exact integers to the nearest f64")]
pub fn estimate(film: &Film, words: &PixelWords) -> PixelEstimate {
    let samples = film.samples().count();
    let [r, g, b, squares] = sums(words);
    let step = film.scale().step();
    let n = samples.max(1) as f64;
    // ΣY·2¹⁶, exact: the luminance of the sums.
    let weighted: u128 =
        [r, g, b].iter().zip(LUMINANCE_WEIGHTS).map(|(&sum, w)| sum * u128::from(w)).sum();
    let mean = weighted as f64 / 65_536.0 / n;
    let hidden = hidden(mean);
    PixelEstimate {
        rgb: [r, g, b].map(|sum| sum as f64 * step / n),
        luminance: mean * step,
        variance: (variance(samples, weighted, squares) + hidden) * step * step,
        mean_square: (squares as f64 * 4_294_967_296.0 / n + hidden) * step * step,
    }
}

/// What truncation may hide of a coarse pixel's mean square, in squared film steps: the
/// film sums ⌊Y²/2³²⌋ of a Y that is itself rounded down. Nothing is proven below that.
fn hidden(mean: f64) -> f64 {
    if mean > 0.0 && mean < COARSE { 4_294_967_296.0 + 2.0 * mean } else { 0.0 }
}

/// Sample variance in squared film steps: (N·ΣY² - (ΣY)²)/(N(N-1)), the difference
/// formed exactly, in 256 bits, so that a constant sample has variance exactly 0.
///
/// The film truncates Y and Y²/2³² downwards, so the difference can come out below
/// zero by less than N²·(2³² + 2Y) steps², which is then 0 (DESIGN.md, "The exact film").
#[expect(clippy::cast_precision_loss, reason = "after the exact difference")]
fn variance(samples: u64, weighted: u128, squares: u128) -> f64 {
    if samples < 2 {
        return f64::NAN;
    }
    // Both sides times 2³²: N·Σ⌊Y²/2³²⌋·2⁶⁴ and (ΣY·2¹⁶)².
    let (high, low) = multiply(squares, u128::from(samples));
    let minuend = ((high << 64) | (low >> 64), low << 64);
    let subtrahend = multiply(weighted, weighted);
    if minuend <= subtrahend {
        return 0.0;
    }
    let (low, borrow) = minuend.1.overflowing_sub(subtrahend.1);
    let high = minuend.0 - subtrahend.0 - u128::from(borrow);
    let difference = high as f64 * 2.0_f64.powi(128) + low as f64;
    let n = samples as f64;
    difference / 4_294_967_296.0 / (n * (n - 1.0))
}

/// The 256-bit product as (high, low).
fn multiply(a: u128, b: u128) -> (u128, u128) {
    const HALF: u128 = u64::MAX as u128;
    let (a1, a0, b1, b0) = (a >> 64, a & HALF, b >> 64, b & HALF);
    let middle = a1 * b0 + ((a0 * b0) >> 64);
    let cross = (middle & HALF) + a0 * b1;
    (a1 * b1 + (middle >> 64) + (cross >> 64), a.wrapping_mul(b))
}
