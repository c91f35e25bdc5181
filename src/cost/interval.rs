//! Measured values with their intervals, and how errors combine on a log scale.

use serde::Serialize;
use statrs::distribution::{ContinuousCDF, StudentsT};

/// Confidence of every interval that a study states.
pub const CONFIDENCE: f64 = 0.95;

/// A measured value with its two-sided 95 % interval.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Measured {
    /// The estimate.
    pub value: f64,
    /// Lower end of the interval.
    pub low: f64,
    /// Upper end of the interval.
    pub high: f64,
}

impl Measured {
    /// `value` ± `half_width`.
    #[must_use]
    pub fn around(value: f64, half_width: f64) -> Self {
        Self { value, low: value - half_width, high: value + half_width }
    }

    /// The median of some values, and the shortest interval between a k-th smallest and a k-th
    /// largest of them that holds the true median with at least 95 %, whatever their
    /// distribution: how many of them lie below it is binomial (Conover, *Practical
    /// Nonparametric Statistics*, section 3.2). None from fewer than six values, of which even
    /// the smallest and the largest hold it with less.
    #[must_use]
    pub fn median(values: &[f64]) -> Option<Self> {
        let mut sorted = values.to_vec();
        sorted.sort_by(f64::total_cmp);
        let count = sorted.len();
        let n = i32::try_from(count).ok()?;
        // P(B = k) and P(B < k) for B of n halves.
        let (mut chance, mut below, mut k) = (0.5_f64.powi(n), 0.0, 0);
        while 2.0 * (below + chance) <= 1.0 - CONFIDENCE {
            below += chance;
            k += 1;
            chance *= f64::from(n - k + 1) / f64::from(k);
        }
        let place = usize::try_from(k).ok()?.checked_sub(1)?;
        let value = f64::midpoint(sorted[(count - 1) / 2], sorted[count / 2]);
        Some(Self { value, low: sorted[place], high: sorted[count - 1 - place] })
    }

    /// All of it times a positive constant.
    #[must_use]
    pub fn scaled(self, factor: f64) -> Self {
        Self { value: self.value * factor, low: self.low * factor, high: self.high * factor }
    }

    /// Half the width of the interval, relative to the value.
    #[must_use]
    pub fn relative_half_width(&self) -> f64 {
        (self.high - self.low) / 2.0 / self.value
    }
}

/// Standard error of the logarithm of a positive value, and the degrees of freedom with
/// which it is known.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct LogError {
    pub error: f64,
    pub freedom: f64,
}

impl LogError {
    /// An error that is known, not estimated from a few values.
    pub fn known(error: f64) -> Self {
        Self { error, freedom: f64::INFINITY }
    }

    /// The error of the product of independent values: variances add, and so do their
    /// uncertainties (Welch 1947, Satterthwaite 1946).
    pub fn of_product(factors: &[Self]) -> Self {
        let variance: f64 = factors.iter().map(|f| f.error.powi(2)).sum();
        let doubt: f64 = factors.iter().map(|f| f.error.powi(4) / f.freedom).sum();
        let freedom = if doubt > 0.0 { variance.powi(2) / doubt } else { f64::INFINITY };
        Self { error: variance.sqrt(), freedom }
    }

    /// The interval of a value that has this error.
    pub fn interval(self, value: f64) -> Measured {
        let factor = (student(self.freedom, CONFIDENCE) * self.error).exp();
        Measured { value, low: value / factor, high: value * factor }
    }
}

/// Where Student's distribution is the normal one to six digits.
const NORMAL: f64 = 1e6;

/// The deviation that Student's t with `freedom` degrees of freedom exceeds, on either
/// side, with probability 1 - `confidence`.
///
/// # Panics
/// If there is less than no freedom.
pub(super) fn student(freedom: f64, confidence: f64) -> f64 {
    StudentsT::new(0.0, 1.0, freedom.min(NORMAL))
        .expect("a positive number of degrees of freedom")
        .inverse_cdf(0.5 + confidence / 2.0)
}

/// Mean and standard deviation (N - 1) of some values; at least two.
#[expect(clippy::cast_precision_loss, reason = "a handful of values")]
pub(super) fn mean_and_deviation(values: impl Iterator<Item = f64> + Clone) -> (f64, f64) {
    let count = values.clone().count() as f64;
    let mean = values.clone().sum::<f64>() / count;
    let squares: f64 = values.map(|value| (value - mean).powi(2)).sum();
    (mean, (squares / (count - 1.0)).sqrt())
}

#[cfg(test)]
mod tests {
    use super::{LogError, Measured, student};

    /// Table A.7 of Hahn & Meeker, *Statistical Intervals*: the ranks of 95 % intervals.
    #[test]
    fn intervals_of_a_median() {
        for (count, low, high) in [(6, 1.0, 6.0), (9, 2.0, 8.0), (15, 4.0, 12.0), (25, 8.0, 18.0)] {
            let values: Vec<f64> = (1..=count).rev().map(f64::from).collect();
            let median = f64::from(count + 1) / 2.0;
            assert_eq!(Measured::median(&values), Some(Measured { value: median, low, high }));
        }
        assert_eq!(Measured::median(&[1.0; 5]), None);
        assert_eq!(Measured::median(&[]), None);
    }

    /// Student's two-sided 95 % points from Fisher & Yates, table III.
    #[test]
    fn students_points() {
        for (freedom, t) in [(1.0, 12.706), (4.0, 2.776), (30.0, 2.042), (f64::INFINITY, 1.960)] {
            assert!((student(freedom, 0.95) - t).abs() < 6e-4, "{freedom}");
        }
    }

    /// Two equal errors with four degrees of freedom each: eight together, by hand.
    #[test]
    fn errors_of_a_product_combine() {
        let one = LogError { error: 0.3, freedom: 4.0 };
        let both = LogError::of_product(&[one, one]);
        assert!((both.error - 0.3 * 2.0_f64.sqrt()).abs() < 1e-12);
        assert!((both.freedom - 8.0).abs() < 1e-9);
        let exact = LogError::of_product(&[LogError::known(0.0)]);
        let interval = exact.interval(7.0);
        assert!(interval.low.to_bits() == interval.high.to_bits(), "{interval:?}");
    }
}
