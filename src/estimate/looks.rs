//! At which sample counts a render that stops at a stated error may look at the error.
//!
//! The counts are fixed before the first sample is traced: those of at most five
//! significant bits, 16 to an octave from 16 samples to 2³². The confidence is spread over
//! all of them, so any of them may be left out or taken for whatever the picture shows so
//! far; and as they are counts, not times, the samples that a render ends with do not depend
//! on the machine's speed.

use crate::scene::MAX_SPP;

/// The first look: fewer samples show nothing of their own scatter.
pub const FIRST_LOOK: u64 = 16;

/// Significant bits of a count at which a look may happen.
const BITS: u32 = 5;

/// How many looks there can be: each count from 16 to 2³², and the last one where a limit
/// ends the render at a count of its own.
pub(super) const MOST_LOOKS: u32 = 28 * 16 + 1 + 1;

/// Whether a count is one of those at which a look may happen.
#[must_use]
pub fn is_look(samples: u64) -> bool {
    samples >= FIRST_LOOK && round_up(samples) == samples
}

/// The look after the one at `samples`, where `needed` samples are predicted to do: the first
/// possible one that has them, and no later than the next power of two, so that a prediction
/// from few hits is put right soon.
#[must_use]
pub fn next_look(samples: u64, needed: Option<u64>) -> u64 {
    let next = samples + 1;
    let planned = round_up(needed.unwrap_or(MAX_SPP).clamp(next, MAX_SPP.max(next)));
    planned.min(next.next_power_of_two()).max(FIRST_LOOK)
}

/// The smallest count of at most five significant bits that is not below this one.
fn round_up(samples: u64) -> u64 {
    let bits = u64::BITS - samples.leading_zeros();
    let low = bits.saturating_sub(BITS);
    samples.div_ceil(1 << low) << low
}

#[cfg(test)]
mod tests {
    use super::{FIRST_LOOK, MOST_LOOKS, is_look, next_look};
    use crate::scene::MAX_SPP;

    /// All looks that there are: the confidence is spread over as many, and the last is one
    /// at a limit.
    #[test]
    fn the_looks_are_as_many_as_the_confidence_is_spread_over() {
        let (mut count, mut at) = (1, FIRST_LOOK);
        while at < MAX_SPP {
            let next = next_look(at, Some(0));
            assert!(next > at && is_look(next), "{next} after {at}");
            // A waste of at most a sixteenth of the samples.
            assert!((next - at) * 16 <= at, "{next} after {at}");
            at = next;
            count += 1;
        }
        assert_eq!((at, count + 1), (MAX_SPP, MOST_LOOKS));
    }

    #[test]
    fn looks_are_planned_and_never_later_than_the_next_power_of_two() {
        let table = [
            (0, None, 16),
            (16, None, 32),
            (16, Some(1000), 32),
            (512, Some(601), 608),
            (512, Some(608), 608),
            (512, Some(100), 544),
            (608, Some(610), 640),
            (608, None, 1024),
            (992, Some(1000), 1024),
        ];
        for (at, needed, next) in table {
            assert_eq!(next_look(at, needed), next, "after {at} for {needed:?}");
        }
        assert!([15, 33, 609].iter().all(|&count| !is_look(count)));
    }
}
