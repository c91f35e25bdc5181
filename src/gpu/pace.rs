//! How much work goes into one dispatch: as much as fits a time budget measured on
//! this device.

use std::time::Duration;

/// A dispatch should take this long: short beside the two seconds after which a
/// graphics driver's watchdog ends it, long beside the cost of submitting it.
const BUDGET: Duration = Duration::from_millis(100);

/// Samples of the first dispatch, small enough for any device.
const FIRST: u64 = 1 << 16;

/// Samples of the largest dispatch; far more than any device traces in the budget.
const MOST: u64 = 1 << 30;

/// Samples per dispatch, learnt from the dispatches so far.
#[derive(Debug)]
pub(super) struct Pace {
    samples: u64,
}

impl Default for Pace {
    fn default() -> Self {
        Self { samples: FIRST }
    }
}

impl Pace {
    /// Samples that the next dispatch may trace.
    pub fn samples(&self) -> u64 {
        self.samples
    }

    /// Learns from a dispatch. It grows at most fourfold at a time, so that one lucky
    /// measurement cannot make a dispatch that a watchdog ends.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        clippy::cast_precision_loss,
        reason = "a guess at a rate"
    )]
    pub fn learn(&mut self, samples: u64, took: Duration) {
        let fitting = samples as f64 * BUDGET.as_secs_f64() / took.as_secs_f64().max(1e-6);
        // A dispatch that was cut small by the picture's end says nothing about more.
        if samples * 2 >= self.samples || (fitting as u64) < self.samples {
            let near = (fitting as u64).clamp(self.samples / 4, self.samples * 4);
            self.samples = near.clamp(1, MOST);
        }
    }
}
