//! Which samples of every pixel a film holds: disjoint half-open ranges.

use crate::scene::MAX_SPP;
use std::fmt;
use std::ops::Range;
use std::str::FromStr;

/// Sample indices lie below this: the random numbers have 56 bits for them.
pub const MAX_SAMPLE_INDEX: u64 = 1 << 56;

/// Why a film cannot take some samples.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum RangeError {
    /// They would be counted twice.
    #[error("samples {}..{} are already in the film", .0.start, .0.end)]
    Overlap(Range<u64>),
    /// The sums have no room for so many.
    #[error("a film holds at most {MAX_SPP} samples per pixel, these would be {0}")]
    TooMany(u64),
    /// There are no random numbers for them.
    #[error("sample indices lie below 2^56, this range ends at {0}")]
    TooFar(u64),
}

/// Disjoint half-open ranges in ascending order, joined where they touch.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct SampleRanges(Vec<Range<u64>>);

impl SampleRanges {
    /// Number of samples.
    #[must_use]
    pub fn count(&self) -> u64 {
        self.0.iter().map(|r| r.end - r.start).sum()
    }

    /// The ranges, ascending.
    #[must_use]
    pub fn as_slice(&self) -> &[Range<u64>] {
        &self.0
    }

    /// Adds a range.
    ///
    /// # Errors
    /// If a sample of it is already there, or there would be too many; the ranges are
    /// then unchanged.
    pub fn insert(&mut self, range: Range<u64>) -> Result<(), RangeError> {
        if range.is_empty() {
            return Ok(());
        }
        if range.end > MAX_SAMPLE_INDEX {
            return Err(RangeError::TooFar(range.end));
        }
        let total = self.count() + (range.end - range.start);
        if total > MAX_SPP {
            return Err(RangeError::TooMany(total));
        }
        let at = self.0.partition_point(|r| r.start < range.start);
        let before = at.checked_sub(1).map(|i| &self.0[i]).filter(|r| r.end > range.start);
        if let Some(other) = before.or(self.0.get(at).filter(|r| r.start < range.end)) {
            let shared = other.start.max(range.start)..other.end.min(range.end);
            return Err(RangeError::Overlap(shared));
        }
        self.0.insert(at, range);
        join(&mut self.0);
        Ok(())
    }

    /// Both sets of ranges together.
    ///
    /// # Errors
    /// If they share a sample, or are too many together.
    pub fn union(&self, other: &Self) -> Result<Self, RangeError> {
        if let Some(shared) = self.shared(other) {
            return Err(RangeError::Overlap(shared));
        }
        let mut all = [self.as_slice(), other.as_slice()].concat();
        all.sort_unstable_by_key(|range| range.start);
        Self::ascending(all)
    }

    /// Of disjoint ranges in ascending order.
    fn ascending(mut ranges: Vec<Range<u64>>) -> Result<Self, RangeError> {
        join(&mut ranges);
        let all = Self(ranges);
        if all.count() > MAX_SPP {
            return Err(RangeError::TooMany(all.count()));
        }
        Ok(all)
    }

    /// The samples of `wanted` that are not there, ascending.
    #[must_use]
    pub fn missing(&self, wanted: &Range<u64>) -> Self {
        let mut missing = Vec::new();
        let mut from = wanted.start;
        for there in self.0.iter().filter(|r| r.end > wanted.start && r.start < wanted.end) {
            missing.push(from..there.start);
            from = there.end;
        }
        missing.push(from..wanted.end);
        missing.retain(|range| range.start < range.end);
        Self(missing)
    }

    /// Whether every sample of the other is there.
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        other.0.iter().all(|range| {
            let at = self.0.partition_point(|ours| ours.end < range.end);
            self.0.get(at).is_some_and(|ours| ours.start <= range.start)
        })
    }

    /// Samples that both hold: one run of them, if there are any.
    #[must_use]
    pub fn shared(&self, other: &Self) -> Option<Range<u64>> {
        let (mut ours, mut theirs) = (self.0.iter().peekable(), other.0.iter().peekable());
        while let (Some(a), Some(b)) = (ours.peek(), theirs.peek()) {
            let both = a.start.max(b.start)..a.end.min(b.end);
            if !both.is_empty() {
                return Some(both);
            }
            if a.end < b.end {
                ours.next()
            } else {
                theirs.next()
            };
        }
        None
    }
}

/// Joins ranges that touch.
fn join(ranges: &mut Vec<Range<u64>>) {
    ranges.dedup_by(|next, last| {
        let touch = last.end == next.start;
        if touch {
            last.end = next.end;
        }
        touch
    });
}

/// Reads what `Display` writes, such as `0..256,512..768`.
impl FromStr for SampleRanges {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let mut ranges: Vec<Range<u64>> = Vec::new();
        for part in text.split(',') {
            let ends = part.split_once("..");
            let range = ends.and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
            let from = ranges.last().map_or(0, |last| last.end);
            match range {
                Some(range) if range.end > MAX_SAMPLE_INDEX => {
                    return Err(RangeError::TooFar(range.end).to_string());
                }
                Some(range) if from <= range.start && range.start < range.end => ranges.push(range),
                _ => {
                    let expected = "expected ascending ranges such as 0..256,512..768";
                    return Err(format!("{expected}, not \"{part}\""));
                }
            }
        }
        Self::ascending(ranges).map_err(|error| error.to_string())
    }
}

impl fmt::Display for SampleRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (i, range) in self.0.iter().enumerate() {
            let comma = if i > 0 { "," } else { "" };
            write!(f, "{comma}{}..{}", range.start, range.end)?;
        }
        Ok(())
    }
}
