//! Measurements in turns, and medians with intervals that assume nothing of the noise.

#![allow(dead_code, reason = "each benchmark uses some of them")]

use candor::cost::Measured;
use std::fmt;

/// A median with its interval.
#[derive(Debug, Clone, Copy)]
pub struct Middle {
    pub median: f64,
    pub low: f64,
    pub high: f64,
}

impl Middle {
    /// The median of some values, with an interval that holds the true one with at least 95 %.
    ///
    /// # Panics
    /// With fewer than six values, from which no such interval can be made.
    pub fn of(values: &[f64]) -> Self {
        let middle =
            Measured::median(values).expect("an interval of 95 % needs six rounds or more");
        Self { median: middle.value, low: middle.low, high: middle.high }
    }

    /// What it says of an extra cost.
    pub fn verdict(&self) -> &'static str {
        match (self.low > 0.0, self.high < 0.0) {
            (true, _) => "costs",
            (_, true) => "saves",
            _ => "free",
        }
    }
}

impl fmt::Display for Middle {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.pad(&format!("{:.2} ({:.2}..{:.2})", self.median, self.low, self.high))
    }
}

fn sorted(values: &[f64]) -> Vec<f64> {
    let mut sorted = values.to_vec();
    sorted.sort_by(f64::total_cmp);
    sorted
}

pub fn median(values: &[f64]) -> f64 {
    let sorted = sorted(values);
    let n = sorted.len();
    f64::midpoint(sorted[(n - 1) / 2], sorted[n / 2])
}

/// Something that is measured once a round; it gets the round's number.
pub type Measure<'a> = Box<dyn FnMut(u64) -> f64 + 'a>;

/// Measures everything in turns, each round from another one on, so that a machine that
/// slows down slows all of them alike. The results are in the order of `rows`.
pub fn take(rounds: u64, rows: &mut [Measure]) -> Vec<Vec<f64>> {
    let mut values = vec![Vec::new(); rows.len()];
    for round in 0..rounds {
        let first = usize::try_from(round).expect("a handful of rounds") % rows.len();
        for at in (first..rows.len()).chain(0..first) {
            values[at].push(rows[at](round));
        }
    }
    values
}

/// What `values` has above `reference`, round by round.
pub fn extra(values: &[f64], reference: &[f64]) -> Middle {
    let above: Vec<f64> = std::iter::zip(values, reference).map(|(a, b)| a - b).collect();
    Middle::of(&above)
}

/// What a rung takes above the first one and what that is called; nothing for the first.
pub fn above(row: &[f64], first: &[f64]) -> String {
    if std::ptr::eq(row, first) {
        return String::new();
    }
    let extra = extra(row, first);
    format!(" {extra:>25} {}", extra.verdict())
}
