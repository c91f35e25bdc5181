//! The bias between two films of the same samples, where the random part cancels.

use super::normal::z_limit;
use crate::film::{Film, sums};

/// The bias of one film against another of the same samples, per channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paired {
    /// Difference of the image means, (a - b)/b, per channel.
    pub bias: [f64; 3],
    /// Its standard error, from the spread of the differences over pixels; infinite for
    /// one pixel.
    pub error: [f64; 3],
}

impl Paired {
    /// Whether a channel's bias is certainly larger than `limit`, at the two-sided
    /// level `alpha` for each channel.
    #[must_use]
    pub fn exceeds(&self, limit: f64, alpha: f64) -> bool {
        let z = z_limit(alpha);
        std::iter::zip(self.bias, self.error).any(|(bias, error)| bias.abs() - z * error > limit)
    }

    /// Whether every channel's bias is certainly within `limit`. Paths that differ on the
    /// two sides widen the error, so that this fails where [`Self::exceeds`] cannot tell.
    #[must_use]
    pub fn is_within(&self, limit: f64, alpha: f64) -> bool {
        let z = z_limit(alpha);
        std::iter::zip(self.bias, self.error).all(|(bias, error)| bias.abs() + z * error <= limit)
    }
}

/// Pairs two films of the same samples, `b` being the reference. A channel that is 0
/// everywhere in both has no bias; where only the reference is 0, it is infinite.
///
/// # Panics
/// If the films differ in size or samples.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "from exact sums to the nearest f64")]
pub fn pair(a: &Film, b: &Film) -> Paired {
    assert_eq!((a.size(), a.samples()), (b.size(), b.samples()), "films of the same samples");
    let pixels = a.pixels().len() as f64;
    let (mut reference, mut difference, mut squares) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for (ours, theirs) in std::iter::zip(a.pixels(), b.pixels()) {
        let (ours, theirs) = (sums(ours), sums(theirs));
        for c in 0..3 {
            let d = if ours[c] >= theirs[c] {
                (ours[c] - theirs[c]) as f64
            } else {
                -((theirs[c] - ours[c]) as f64)
            };
            reference[c] += theirs[c] as f64;
            difference[c] += d;
            squares[c] += d * d;
        }
    }
    let relative = |x: f64, c: usize| if x == 0.0 { 0.0 } else { x / reference[c] };
    Paired {
        bias: std::array::from_fn(|c| relative(difference[c], c)),
        error: std::array::from_fn(|c| {
            let mean = difference[c] / pixels;
            let spread = (squares[c] / pixels - mean * mean).max(0.0) * pixels / (pixels - 1.0);
            // One pixel shows no spread: what it is off by is all that is known.
            if pixels > 1.0 { relative((spread * pixels).sqrt(), c) } else { f64::INFINITY }
        }),
    }
}
