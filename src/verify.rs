//! A device against the f64 twin: do they show the same picture?

use crate::estimate::{Comparison, Paired, compare, pair};
use crate::film::Film;

/// Family-wise probability of a false alarm.
pub const ALPHA: f64 = 1e-6;

/// Each of the channels may give it.
const CHANNELS: f64 = 3.0;

/// Bias of the image mean that a device may have, relative, from rounding to `f32`.
pub const MAX_BIAS: f64 = 1e-3;

/// What a comparison found.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict {
    /// Independent samples: tiles and image.
    pub independent: Comparison,
    /// The same samples on both: the bias of the image mean.
    pub paired: Paired,
}

impl Verdict {
    /// Whether device and twin show the same picture, as far as these samples tell.
    #[must_use]
    pub fn agrees(&self) -> bool {
        self.independent.conclusive
            && !self.disagrees()
            && self.paired.is_within(MAX_BIAS, ALPHA / CHANNELS)
    }

    /// Whether they certainly do not. Where neither holds, there are too few samples to
    /// tell, or too many paths that differ.
    #[must_use]
    pub fn disagrees(&self) -> bool {
        self.independent.disagrees(ALPHA / 2.0)
            || self.paired.exceeds(MAX_BIAS, ALPHA / 2.0 / CHANNELS)
    }
}

/// Judges three films: of the device, of the twin with the same samples, and of the
/// device with another seed.
///
/// # Panics
/// If the films are of different sizes, or the first two of different samples.
#[must_use]
pub fn judge(device: &Film, twin: &Film, other: &Film) -> Verdict {
    Verdict { independent: compare(other, twin), paired: pair(device, twin) }
}
