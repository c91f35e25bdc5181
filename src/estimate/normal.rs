//! Tails of the distributions that the tests stand on.

use statrs::function::erf::{erfc, erfc_inv};
use statrs::function::gamma::checked_gamma_ur;

/// Two-sided p-value of a standard normal deviate.
#[must_use]
pub fn p_value(z: f64) -> f64 {
    erfc(z.abs() / std::f64::consts::SQRT_2)
}

/// The deviate that a standard normal exceeds, on either side, with probability `p`.
#[must_use]
pub fn z_limit(p: f64) -> f64 {
    std::f64::consts::SQRT_2 * erfc_inv(p)
}

/// Probability that the squares of `count` standard normal deviates add up to more than
/// `sum`: the upper tail of χ² with `count` degrees of freedom.
pub(super) fn p_of_squares(sum: f64, count: f64) -> f64 {
    // Outside its domain stand the ends: no square at all, and an infinite one.
    checked_gamma_ur(count / 2.0, sum / 2.0).unwrap_or(if sum > 0.0 { 0.0 } else { 1.0 })
}
