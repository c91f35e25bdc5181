//! What a film says about itself as it grows: the realised difference of halves, and the
//! variance of the new samples.
//!
//! The stated error divided by √N falls with slope -½ whatever the samples are. The halves
//! A and B of m samples have content: ((A - B)/2)², averaged over the pixels, estimates the
//! squared error of all m, from what the samples did and not from what they should do. Each
//! doubling of the film, from n samples to 2n, halves the new samples alone, so that the
//! points of a fit share none: a rare bright sample would lift all points after it.

use super::fit::Point;
use crate::estimate::estimate;
use crate::film::Film;

/// Points whose own standard error is larger say nothing on a log scale.
const MAX_UNCERTAINTY: f64 = 0.25;

/// Halves that agree better than this share of the stated error are not lucky but the same;
/// the logarithm stays finite, and the disagreement is found.
const LEAST_RATIO: f64 = 1e-3;

/// Mean luminance of a pixel, and its squared deviations Σ(Y - mean)².
#[derive(Debug, Clone, Copy)]
struct Pixel {
    mean: f64,
    deviations: f64,
}

/// A film at one count of samples, by luminance: 16 bytes per pixel.
#[derive(Debug)]
pub(super) struct Snapshot {
    pub samples: u64,
    pixels: Vec<Pixel>,
    /// Pixels that no sample has contributed to.
    pub unproven: u64,
    /// Effective number of samples that contributed to pixels that vary.
    pub hits: f64,
}

/// Bytes per pixel of a snapshot.
pub(super) const SNAPSHOT_BYTES: u64 = size_of::<Pixel>() as u64;

impl Snapshot {
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    pub fn of(film: &Film) -> Self {
        let samples = film.samples().count();
        let freedom = samples.saturating_sub(1) as f64;
        let (mut unproven, mut hits) = (0, 0.0);
        let pixels = film.pixels().iter().map(|words| {
            let pixel = estimate(film, words);
            let varies = samples >= 2 && pixel.variance > 0.0;
            unproven += u64::from(pixel.is_unproven());
            hits += if varies { pixel.hits(samples) } else { 0.0 };
            let deviations = if varies { pixel.variance * freedom } else { 0.0 };
            Pixel { mean: pixel.luminance, deviations }
        });
        let pixels = pixels.collect();
        Self { samples, pixels, unproven, hits }
    }

    /// Mean luminance of the picture.
    pub fn luminance(&self) -> f64 {
        self.average(|pixel| pixel.mean)
    }

    /// Variance of one sample's luminance, averaged over the pixels; at least two samples.
    #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
    pub fn variance(&self) -> f64 {
        self.average(|pixel| pixel.deviations) / (self.samples as f64 - 1.0)
    }

    /// Effective number of pixels that hold the noise: (Σσ²)²/Σσ⁴, with which the squares of
    /// normal deviations scatter; 0 where no pixel varies.
    pub fn varying_pixels(&self) -> f64 {
        let squares: f64 = self.pixels.iter().map(|pixel| pixel.deviations.powi(2)).sum();
        let sum: f64 = self.pixels.iter().map(|pixel| pixel.deviations).sum();
        if squares > 0.0 { sum * sum / squares } else { 0.0 }
    }

    fn average(&self, of: impl Fn(&Pixel) -> f64) -> f64 {
        self.pixels.iter().map(of).sum::<f64>() / self.count()
    }

    #[expect(clippy::cast_precision_loss, reason = "a count of pixels")]
    fn count(&self) -> f64 {
        self.pixels.len() as f64
    }
}

/// The samples by which one snapshot is ahead of another.
#[derive(Debug, Clone, Copy)]
pub(super) struct Batch {
    pub samples: u64,
    /// Variance of one of these samples, averaged over the pixels.
    pub variance: f64,
}

/// The realised error of `samples` new samples.
#[derive(Debug, Clone, Copy)]
struct Realised {
    samples: f64,
    /// ((A - B)/2)² of their halves, averaged over the pixels.
    squares: f64,
    /// The squares of that, averaged.
    fourths: f64,
}

/// A film under observation while it doubles.
#[derive(Debug)]
pub(super) struct Growth {
    /// At n samples, a power of two.
    whole: Snapshot,
    /// At 3n/2 samples, once they are there.
    middle: Option<Snapshot>,
    batches: Vec<Batch>,
    realised: Vec<Realised>,
    /// σ⁴ averaged over the pixels, as the product of two independent variances: those of
    /// the first n samples and of the next n.
    quartic: f64,
}

impl Growth {
    /// Starts with a film of one sample per pixel.
    pub fn new(film: &Film) -> Self {
        let (batches, realised) = (Vec::new(), Vec::new());
        Self { whole: Snapshot::of(film), middle: None, batches, realised, quartic: 0.0 }
    }

    /// Samples at which the film must be looked at next.
    pub fn next_look(&self) -> u64 {
        let n = self.whole.samples;
        if self.middle.is_some() || n == 1 { 2 * n } else { n + n / 2 }
    }

    /// Whether the latest look was at a power of two.
    pub fn is_doubled(&self) -> bool {
        self.middle.is_none()
    }

    /// Looks at the film; it must hold [`Self::next_look`] samples.
    pub fn look(&mut self, film: &Film) {
        let now = Snapshot::of(film);
        if now.samples != 2 * self.whole.samples {
            self.middle = Some(now);
            return;
        }
        self.realised.push(realised(&self.whole, self.middle.as_ref(), &now));
        if self.whole.samples >= 2 {
            let (batch, quartic) = between(&self.whole, &now);
            self.batches.push(batch);
            self.quartic = quartic;
        } else {
            self.batches.push(Batch { samples: now.samples, variance: now.variance() });
        }
        self.middle = None;
        self.whole = now;
    }

    /// The batches, together with what came since the latest doubling.
    pub fn batches(&self, end: &Snapshot) -> Vec<Batch> {
        let mut batches = self.batches.clone();
        if end.samples >= self.whole.samples + 2 && self.whole.samples >= 2 {
            batches.push(between(&self.whole, end).0);
        }
        batches
    }

    /// The realised errors that are known well enough, given the film at the end.
    ///
    /// The relative variance of a mean of squares d² over P pixels is Σ(E d⁴ - s⁴)/(Σs²)²,
    /// and E d⁴ = 3s⁴ + κ₄/m³ with s² = σ²/m and κ₄ the fourth cumulant of one sample: normal
    /// deviations give 2Σs⁴/(Σs²)², few hits give more. κ₄, averaged over
    /// the pixels, comes from all points together, so that a point's weight hardly depends on
    /// the point. Half of the relative error is that of the root.
    pub fn points(&self, end: &Snapshot) -> Vec<Point> {
        let inverse = |power: i32| self.realised.iter().map(move |r| r.samples.powi(-power));
        let excess = self
            .realised
            .iter()
            .map(|r| (r.fourths * r.samples.powi(2) - 3.0 * self.quartic) / r.samples);
        let cumulant = (excess.sum::<f64>() / inverse(2).sum::<f64>()).max(0.0);
        let points = self.realised.iter().filter_map(|r| {
            let scatter = 2.0 * self.quartic + cumulant / r.samples;
            let uncertainty = (scatter / end.count()).sqrt() / end.variance() / 2.0;
            let stated = (end.variance() / r.samples).sqrt();
            let error = r.squares.sqrt().max(LEAST_RATIO * stated) / end.luminance();
            let known = error > 0.0 && uncertainty > 0.0 && uncertainty <= MAX_UNCERTAINTY;
            #[expect(
                clippy::cast_possible_truncation,
                clippy::cast_sign_loss,
                reason = "a count of samples"
            )]
            known.then_some(Point { samples: r.samples as u64, error, uncertainty })
        });
        points.collect()
    }
}

/// The halves of what is new between n and 2n samples. With the means M of the first n, 3n/2
/// and 2n samples, A = 3M₁.₅ - 2M₁ and B = 4M₂ - 3M₁.₅; the first two samples, of which one
/// is not new, are a pair of halves too, with (A - B)/2 = M₁ - M₂.
#[expect(clippy::cast_precision_loss, reason = "a count of samples")]
fn realised(whole: &Snapshot, middle: Option<&Snapshot>, now: &Snapshot) -> Realised {
    let (mut squares, mut fourths) = (0.0, 0.0);
    for (pixel, (old, all)) in whole.pixels.iter().zip(&now.pixels).enumerate() {
        let half_difference = match middle {
            Some(middle) => 3.0 * middle.pixels[pixel].mean - old.mean - 2.0 * all.mean,
            None => old.mean - all.mean,
        };
        squares += half_difference.powi(2);
        fourths += half_difference.powi(4);
    }
    let samples = if middle.is_some() { whole.samples } else { now.samples };
    let count = now.count();
    Realised { samples: samples as f64, squares: squares / count, fourths: fourths / count }
}

/// The samples between two snapshots of one film of at least two samples, and the product of
/// the pixels' variances before and between, averaged.
///
/// The sum of squared deviations splits into those within the old samples, those within the
/// new ones, and n·m/(m - n)·(A - M)² between them, with A the mean of the first n and M of
/// all m.
#[expect(clippy::cast_precision_loss, reason = "counts of samples")]
fn between(earlier: &Snapshot, later: &Snapshot) -> (Batch, f64) {
    let (n, m) = (earlier.samples as f64, later.samples as f64);
    let (mut sum, mut products) = (0.0, 0.0);
    for (old, all) in earlier.pixels.iter().zip(&later.pixels) {
        let apart = n * m / (m - n) * (old.mean - all.mean).powi(2);
        let within = (all.deviations - old.deviations - apart).max(0.0);
        sum += within;
        products += within * old.deviations;
    }
    let freedom = m - n - 1.0;
    let samples = later.samples - earlier.samples;
    let variance = sum / later.count() / freedom;
    (Batch { samples, variance }, products / later.count() / freedom / (n - 1.0))
}

#[cfg(test)]
mod tests {
    use super::{Growth, Snapshot};
    use crate::cost::fit::{Agreement, Point, Slope, agreement, fit};
    use crate::film::{Film, PixelSums, SampleScale};
    use crate::scene::ImageSize;

    /// A number in [0, 1) that depends on all of its arguments (splitmix64).
    #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
    fn uniform(seed: u64, pixel: u64, sample: u64) -> f64 {
        let mut z = (seed << 48 | pixel << 24 | sample).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        for _ in 0..2 {
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        }
        ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
    }

    const HIT: f64 = 0.05;

    /// (1 - p)/p, the relative variance of hits with chance p.
    const VARIANCE: f64 = (1.0 - HIT) / HIT;

    /// Watches a film of 32² pixels grow to `end` samples. Sample i of a pixel hits a light
    /// with chance [`HIT`], by the random number that `index` gives it.
    fn watch(seed: u64, end: u64, index: impl Fn(u64) -> u64) -> Vec<Point> {
        let size = ImageSize::new(32, 32).expect("a size");
        let scale = SampleScale::from_bound(64.0);
        let mut film = Film::new(size, scale);
        let mut growth: Option<Growth> = None;
        for sample in 0..end {
            film.claim(sample..sample + 1).expect("a new sample");
            for (pixel, words) in (0..).zip(film.pixels_mut()) {
                let hit = uniform(seed, pixel, index(sample)) < HIT;
                let mut sums = PixelSums::of(words);
                sums.add([if hit { 8.0 } else { 0.0 }; 3], scale);
                *words = sums.words();
            }
            match &mut growth {
                None => growth = Some(Growth::new(&film)),
                Some(growth) if growth.next_look() == sample + 1 => growth.look(&film),
                Some(_) => {}
            }
        }
        growth.expect("at least one sample").points(&Snapshot::of(&film))
    }

    fn judge(points: &[Point]) -> (Slope, Agreement) {
        (fit(points).expect("enough points"), agreement(points, VARIANCE).expect("points"))
    }

    /// The deviations of the points' logarithms from the known error, in units of their
    /// uncertainty, are standard normal: over 24 films of 7 points the mean of their squares
    /// has standard error √(2/168) = 0.11 and the mean one of 0.077; five of each, and for the
    /// mean half the largest uncertainty, by which a logarithm is off.
    #[test]
    fn points_are_as_sure_as_they_say() {
        let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
        for seed in 0..24 {
            for point in watch(seed, 150, |i| i) {
                #[expect(clippy::cast_precision_loss, reason = "a small count")]
                let expected = (VARIANCE / point.samples as f64).sqrt();
                let z = (point.error / expected).ln() / point.uncertainty;
                count += 1.0;
                sum += z;
                squares += z * z;
            }
        }
        assert!(count >= 168.0, "{count} points");
        assert!((sum / count).abs() < 5.0 * 0.077 + 0.1, "mean {}", sum / count);
        assert!((squares / count - 1.0).abs() < 5.0 * 0.11, "mean square {}", squares / count);
    }

    #[test]
    fn independent_samples_are_not_suspected() {
        let (slope, agreement) = judge(&watch(100, 600, |i| i));
        assert!(!slope.suspect && !agreement.suspect, "{slope:?} {agreement:?}");
    }

    /// The injected faults: every sample twice, so that errors are √2 of what is stated; 4
    /// samples again and again, so that halves agree exactly; and from the 8th on every sample
    /// twice, from the 64th on three times, so that errors fall too slowly.
    #[test]
    fn dependent_samples_are_found() {
        let (_, twice) = judge(&watch(1, 600, |i| i / 2));
        assert!(twice.suspect, "{twice:?}");
        let (_, again) = judge(&watch(2, 600, |i| i % 4));
        assert!(again.suspect, "{again:?}");
        let fewer = |i: u64| {
            let new = |octave: u32| (1 << octave) + i % (1 << octave) / u64::from(1 + octave / 3);
            i.checked_ilog2().map_or(0, new)
        };
        let (slower, _) = judge(&watch(3, 600, fewer));
        assert!(slower.suspect, "{slower:?}");
    }

    /// Variances of batches by hand: samples 1, 3 | 2, 6 of one pixel have 2 and 8.
    #[test]
    fn batches_have_their_own_variance() {
        let size = ImageSize::new(1, 1).expect("a size");
        let scale = SampleScale::from_bound(64.0);
        let mut film = Film::new(size, scale);
        let mut growth: Option<Growth> = None;
        for (sample, value) in (0..).zip([1.0, 3.0, 2.0, 6.0]) {
            film.claim(sample..sample + 1).expect("a new sample");
            let words = &mut film.pixels_mut()[0];
            let mut sums = PixelSums::of(words);
            sums.add([value; 3], scale);
            *words = sums.words();
            match &mut growth {
                None => growth = Some(Growth::new(&film)),
                Some(growth) => growth.look(&film),
            }
        }
        let end = Snapshot::of(&film);
        assert!((end.varying_pixels() - 1.0).abs() < 1e-12, "{}", end.varying_pixels());
        let batches = growth.expect("four samples").batches(&end);
        let found: Vec<_> = batches.iter().map(|b| (b.samples, b.variance)).collect();
        assert_eq!(found.len(), 2);
        for ((samples, variance), expected) in found.into_iter().zip([2.0, 8.0]) {
            assert!(samples == 2 && (variance - expected).abs() < 1e-9, "{variance}");
        }
    }
}
