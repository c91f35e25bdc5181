//! How large a picture's error may be: an upper confidence bound on the realised error.
//!
//! The realised error of a picture of P pixels is √Q/μ, with Q the mean over pixels of (x̄ − m)²,
//! where m is a pixel's true mean luminance, and μ the mean of those. After N samples per
//! pixel, with V the mean of the pixels' unbiased variances s²,
//!
//! ```text
//! N·Q = V + W,   W = 1/P Σ (N(x̄ − m)² − s²) = 1/(P(N−1)) Σ Σ_{i≠j} (x_i − m)(x_j − m).
//! ```
//!
//! The naive estimate V is off by a W whose mean is exactly 0 and whose variance is exactly
//! 2N/(N−1)·Σσ⁴/P², however the samples are distributed. (DESIGN.md, "Stopping at a stated
//! error", has the derivation, and says what of the bound is proven.)

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
    /// With L = ln(1/δ): W from the tail of a Gaussian chaos, (2√L·√Σσ⁴ + 2L·max σ²)/P (Laurent &
    /// Massart, Ann. Statist. 28(5), 2000, lemma 1), where s stands for σ with what light that
    /// was not found yet may add; the mean from Bernstein's inequality; the variance in
    /// that one from Maurer & Pontil (COLT 2009, theorem 10), pooled over pixels.
    #[must_use]
    pub fn ceiling(&self, samples: u64) -> f64 {
        self.ceiling_at(samples, (EVENTS * f64::from(MOST_LOOKS) / (1.0 - CONFIDENCE)).ln())
    }

    /// The same where each event may happen with probability exp(−`l`).
    fn ceiling_at(&self, samples: u64, l: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "at most 2^32 samples")]
        let n = samples as f64;
        let (all, bound) = (n * self.pixels, self.sample_bound);

        let unseen = l * bound * bound / n;
        let deviation = self.largest.sqrt() + (unseen / 2.0).sqrt();
        let chaos = 2.0 * l.sqrt() * (self.squares.sqrt() + unseen) + 2.0 * l * deviation.powi(2);
        let mean_square = (self.variance + chaos) / all;

        let variance = self.variance_bound(samples, l);
        let below = (2.0 * l * variance / all).sqrt() + l * bound / (3.0 * all);
        let mean = self.luminance() - below;
        // A variance of fewer than two samples is NaN, and so is then the mean.
        if mean > 0.0 { mean_square.sqrt() / mean } else { f64::INFINITY }
    }

    /// The variance's bound, wrong with probability exp(−`l`).
    fn variance_bound(&self, samples: u64, l: f64) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "at most 2^32 samples")]
        let degrees = self.pixels * (samples as f64 - 1.0);
        let slack = l * self.sample_bound * self.sample_bound / (2.0 * degrees);
        ((self.variance() + slack).sqrt() + slack.sqrt()).powi(2)
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

#[cfg(test)]
#[expect(clippy::cast_precision_loss, reason = "counts of samples and pictures")]
mod tests {
    use super::{PixelEstimate, Spread};
    use crate::scene::MAX_SPP;

    const SAMPLES: u64 = 10_000;
    /// Each of the three events may happen with this probability, where it can be measured.
    const DELTA: f64 = 0.1;
    const PICTURES: u32 = 2000;

    /// Independent uniform numbers (splitmix64, Steele et al. 2014).
    struct Uniform(u64);

    impl Uniform {
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        }

        /// Hits of brightness 1, `expected` on average: a Poisson number of them, which is
        /// what rare hits are.
        fn hits(&mut self, expected: f64) -> f64 {
            let mut passed = 0.0;
            let draws = std::iter::repeat_with(|| {
                passed -= (1.0 - self.next()).ln();
                passed
            });
            draws.take_while(|&passed| passed < expected).count() as f64
        }
    }

    fn pixel(hits: f64) -> PixelEstimate {
        let n = SAMPLES as f64;
        let mean = hits / n;
        let variance = mean * (1.0 - mean) * n / (n - 1.0);
        PixelEstimate { rgb: [mean; 3], luminance: mean, variance, mean_square: mean }
    }

    fn spread(pixels: impl IntoIterator<Item = PixelEstimate>) -> Spread {
        let mut spread = Spread::new(1.0);
        pixels.into_iter().for_each(|pixel| spread.add(&pixel));
        spread
    }

    /// How often the realised error exceeds the bound, and how often the naive estimate, where
    /// the pixels have so many hits on average.
    fn exceeded(expected: &[f64], seed: u64) -> [f64; 2] {
        let mut random = Uniform(seed);
        let count = expected.len() as f64;
        let mean = expected.iter().sum::<f64>() / count / SAMPLES as f64;
        let mut exceeded = [0.0; 2];
        for _ in 0..PICTURES {
            let hits: Vec<f64> = expected.iter().map(|&e| random.hits(e)).collect();
            let squares = hits.iter().zip(expected).map(|(h, e)| (h - e).powi(2)).sum::<f64>();
            let realised = (squares / count).sqrt() / SAMPLES as f64 / mean;
            let spread = spread(hits.into_iter().map(pixel));
            let naive = (spread.variance() / SAMPLES as f64).sqrt() / spread.luminance();
            exceeded[0] += f64::from(u8::from(realised > spread.ceiling_at(SAMPLES, -DELTA.ln())));
            exceeded[1] += f64::from(u8::from(naive.is_nan() || realised > naive));
        }
        exceeded.map(|count| count / f64::from(PICTURES))
    }

    /// Pictures of rare and frequent hits, even and uneven: the bound is exceeded less often
    /// than by any one of its events, and the naive estimate, the injected fault, in at
    /// least three pictures of ten wherever there are ten hits or more.
    #[test]
    fn the_bound_holds_as_often_as_it_says() {
        let mixed = |a: &[f64], b: &[f64]| [a, b].concat();
        let pictures = [
            vec![0.1; 1],
            vec![3.0; 1],
            vec![300.0; 1],
            vec![0.01; 100],
            vec![1.0; 100],
            vec![30.0; 100],
            mixed(&[300.0], &[1.0; 99]),
            mixed(&[3.0], &[30.0; 99]),
            mixed(&[100.0; 3], &[0.03; 97]),
        ];
        for (seed, expected) in (0..).zip(&pictures) {
            let [bound, naive] = exceeded(expected, seed);
            let hits = expected.iter().sum::<f64>();
            println!("{} pixels, {hits:.1} hits: {bound} and {naive}", expected.len());
            assert!(bound <= DELTA, "{hits} hits: {bound}");
            assert!(naive >= 0.3 || hits < 10.0, "{hits} hits: {naive}");
        }
    }

    /// With so many samples that only the tail of W is left, alike in all P pixels, the square
    /// of the bound is that of the estimate times 1 + 2√(L/P) + 2L/P.
    #[test]
    fn many_samples_leave_the_tail_of_the_chaos() {
        let (l, pixels) = (9.0, 400.0);
        let spread = spread(vec![pixel(SAMPLES as f64 / 2.0); 400]);
        let n = MAX_SPP as f64;
        let estimate = (spread.variance() / n).sqrt() / spread.luminance();
        let factor = (1.0 + 2.0 * f64::sqrt(l / pixels) + 2.0 * l / pixels).sqrt();
        let off = spread.ceiling_at(MAX_SPP, l) / estimate / factor - 1.0;
        // What is left of the samples' bound falls with √N.
        assert!(off > 0.0 && off < 1e-4, "{off}");
    }

    #[test]
    fn darkness_and_single_samples_prove_nothing() {
        let dark = spread(vec![pixel(0.0); 4]);
        assert!(dark.ceiling(MAX_SPP).is_infinite() && dark.samples_to(1.0).is_none());
        let lit = spread(vec![pixel(5000.0); 4]);
        assert!(lit.ceiling(1).is_infinite());
        let unknown = spread([PixelEstimate { variance: f64::NAN, ..pixel(1.0) }]);
        assert!(unknown.ceiling(MAX_SPP).is_infinite());
    }

    /// The prediction is the first count at which the bound is low enough.
    #[test]
    fn the_bound_is_met_where_it_is_predicted() {
        let lit = spread(vec![pixel(700.0); 30]);
        for target in [0.5, 0.01, 1e-4] {
            let needed = lit.samples_to(target).expect("within reach");
            assert!(lit.ceiling(needed) <= target && lit.ceiling(needed - 1) > target, "{target}");
        }
        assert_eq!(lit.samples_to(1e-9), None);
    }
}
