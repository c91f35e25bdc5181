//! Judges a film against the truth: exactly where nothing is random, otherwise with
//! an error that the film itself proves.

#![expect(clippy::cast_precision_loss, reason = "sums and counts become statistics")]

use candor::film::{Film, luminance, square, sums, to_fixed};
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Chance that a correct renderer fails anywhere in one table.
pub const FAMILY: f64 = 1e-6;

/// A detectable effect is missed with the chance that a normal deviate passes this.
const POWER: f64 = 4.0;

/// What is read from a pixel's sums.
#[derive(Debug, Clone, Copy)]
pub enum Quantity {
    /// Mean of one channel.
    Channel(usize),
    /// Mean of the squared luminance.
    SquaredLuminance,
}

/// A mean with its standard error.
#[derive(Debug, Clone, Copy)]
pub struct Estimate {
    /// The mean.
    pub mean: f64,
    /// Its standard error.
    pub standard_error: f64,
    /// Number of pixels that it was made from, less one.
    pub freedom: f64,
}

impl Estimate {
    /// Takes the pixels, which must all show the same truth, as so many independent
    /// batches: the scatter of their exact sums is the error, of any quantity.
    pub fn of(film: &Film, quantity: Quantity) -> Self {
        let step = film.scale().step();
        let samples = film.samples().count() as f64;
        let value = |words| match (quantity, sums(words)) {
            (Quantity::Channel(c), sums) => sums[c] as f64 * step / samples,
            // The film holds Σ⌊Y²/2³²⌋.
            (Quantity::SquaredLuminance, sums) => {
                sums[3] as f64 * (step * f64::from(1 << 16)).powi(2) / samples
            }
        };
        let values: Vec<f64> = film.pixels().iter().map(value).collect();
        let count = values.len() as f64;
        let mean = values.iter().sum::<f64>() / count;
        let scatter = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (count - 1.0);
        Self { mean, standard_error: (scatter / count).sqrt(), freedom: count - 1.0 }
    }
}

/// How many standard errors a correct renderer may be off, on either side, in a table
/// of `claims` (Šidák).
pub fn limit(claims: usize, freedom: f64) -> f64 {
    let each = -(-FAMILY).ln_1p() / claims as f64;
    let deviate = StudentsT::new(0.0, 1.0, freedom).expect("a distribution");
    -deviate.inverse_cdf(each / 2.0)
}

/// How far an estimate is from a truth, in standard errors and beyond what is known to
/// be off: `bias`, relative to the truth.
pub fn deviation(estimate: Estimate, truth: f64, bias: f64) -> f64 {
    let off = estimate.mean - truth;
    let excess = (off.abs() - bias * truth).max(0.0);
    // An estimate without any error may be exactly right.
    if excess == 0.0 { 0.0 } else { excess.copysign(off) / estimate.standard_error }
}

/// The smallest relative error that the judge all but certainly rejects.
pub fn detectable(estimate: Estimate, truth: f64, bias: f64, limit: f64) -> f64 {
    (limit + POWER) * estimate.standard_error / truth + bias
}

/// Whether every sample of every pixel is this very radiance: the sums are those of
/// one integer, and so the variance is exactly zero.
pub fn is_exactly(film: &Film, radiance: [f32; 3], samples: u64) -> bool {
    let n = u128::from(samples);
    let channels = radiance.map(|x| to_fixed(x, film.scale().shift()));
    let [r, g, b] = channels.map(|x| n * u128::from(x));
    let expected = [r, g, b, n * square(luminance(channels))];
    film.pixels().iter().all(|words| sums(words) == expected)
}
