//! What is said of two kernels' times, and of their films.

use crate::cost::Measured;
use crate::estimate::pair;
use crate::film::Film;
use crate::verify::{ALPHA, MAX_BIAS};
use serde::Serialize;

/// What the specialised kernel saves of the general one's time.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(rename_all = "snake_case", tag = "verdict", content = "share")]
pub enum Saving {
    /// Nothing that the noise does not hide.
    None,
    /// A share of the time, with its 95 % interval.
    Saves(Measured),
    /// It takes longer, by a share of the time with its 95 % interval.
    Costs(Measured),
}

impl Saving {
    /// Judges a ratio of times, specialised over general: where its interval holds 1, nothing is
    /// saved, whatever the ratio is.
    #[must_use]
    pub fn of(ratio: Measured) -> Self {
        let Measured { value, low, high } = ratio;
        if high < 1.0 {
            Self::Saves(Measured { value: 1.0 - value, low: 1.0 - high, high: 1.0 - low })
        } else if low > 1.0 {
            Self::Costs(Measured { value: value - 1.0, low: low - 1.0, high: high - 1.0 })
        } else {
            Self::None
        }
    }
}

/// How the two kernels' films of the same samples compare.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Agreement {
    /// Bit by bit the same sums.
    SameBits,
    /// Other bits, as a hardware driver that contracts `a*b + c` differently makes them, but
    /// no more than [`MAX_BIAS`] of bias.
    UpToRounding,
    /// One of them is wrong.
    Differ,
}

impl Agreement {
    /// Compares two films of the same samples. On software Vulkan the same arithmetic gives the
    /// same bits; there, nothing else will do.
    ///
    /// # Panics
    /// If the films differ in size or samples.
    #[must_use]
    pub fn of(specialised: &Film, general: &Film, software: bool) -> Self {
        if specialised.pixels() == general.pixels() {
            Self::SameBits
        } else if software || pair(specialised, general).exceeds(MAX_BIAS, ALPHA) {
            Self::Differ
        } else {
            Self::UpToRounding
        }
    }
}
