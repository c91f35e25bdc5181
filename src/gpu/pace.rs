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
    most: u64,
    budget: Duration,
}

impl Pace {
    /// For a device that was lost so often with no step forward since: everything is a quarter
    /// of what it was the time before, in case that dispatches were too long for its watchdog.
    pub fn after(losses: u32) -> Self {
        let share = 4_u32.saturating_pow(losses);
        let part = |samples: u64| (samples / u64::from(share)).max(1);
        Self { samples: part(FIRST), most: part(MOST), budget: BUDGET / share }
    }

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
        let fitting = samples as f64 * self.budget.as_secs_f64() / took.as_secs_f64().max(1e-6);
        // A dispatch that was cut small by the picture's end says nothing about more.
        if samples * 2 >= self.samples || (fitting as u64) < self.samples {
            let near = (fitting as u64).clamp(self.samples / 4, self.samples * 4);
            self.samples = near.clamp(1, self.most);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Samples that a pace settles at on a device of `rate` samples per second.
    fn settled(mut pace: Pace, rate: f64) -> u64 {
        for _ in 0..20 {
            #[expect(clippy::cast_precision_loss, reason = "a count of samples")]
            let took = Duration::from_secs_f64(pace.samples() as f64 / rate);
            pace.learn(pace.samples(), took);
        }
        pace.samples()
    }

    #[test]
    fn every_loss_makes_dispatches_a_quarter_of_what_they_were() {
        for (losses, share) in [(0, 1), (1, 4), (2, 16), (5, 1024)] {
            assert_eq!(Pace::after(losses).samples(), FIRST / share);
            // 2^24 samples in a second are 2^24 / 10 in the budget.
            let expected = (1 << 24) / 10 / share;
            assert!(settled(Pace::after(losses), f64::from(1 << 24)).abs_diff(expected) <= 2);
            assert_eq!(settled(Pace::after(losses), 1e30), MOST / share);
        }
        // However many, a dispatch traces something.
        assert_eq!(Pace::after(u32::MAX).samples(), 1);
        assert_eq!(settled(Pace::after(u32::MAX), 1e6), 1);
    }
}
