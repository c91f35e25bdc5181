//! What stands in a table's cells, on the terminal and in `cost.html` alike.

use crate::cost::{EstimatorCost, Measured, Rung, Study};
use crate::units::{rounded_percent, significant};

/// A value with half the width of its interval, relative.
pub(crate) fn relative(measured: &Measured, value: &str) -> String {
    format!("{value} ± {}", rounded_percent(measured.relative_half_width(), 2))
}

/// The relative variance of one sample.
pub(crate) fn variance(cost: &EstimatorCost) -> String {
    match cost.noise {
        None => "unproven".to_owned(),
        Some(_) if cost.is_noiseless() => "none".to_owned(),
        Some(noise) => relative(&noise.variance, &significant(noise.variance.value, 3)),
    }
}

/// The efficiency, with what its number is followed by.
pub(crate) fn efficiency(cost: &EstimatorCost, unit: &str) -> String {
    cost.noise.and_then(|noise| noise.efficiency).map_or_else(
        || unpredicted(cost).to_owned(),
        |efficiency| relative(&efficiency, &format!("{:.2e}{unit}", efficiency.value)),
    )
}

/// What stands for predictions that there are none of.
pub(crate) fn unpredicted(cost: &EstimatorCost) -> &'static str {
    if cost.is_noiseless() { "no noise" } else { "unproven" }
}

/// The light that a rung misses beside the deepest one.
pub(crate) fn missing_light(rung: &Rung, study: &Study) -> String {
    match rung.missing {
        Some(missing) if missing.low > 0.0 => {
            let half = (missing.high - missing.low) / 2.0;
            format!("{:.3} ± {:.3} %", 100.0 * missing.value, 100.0 * half)
        }
        Some(_) => "none measurable".to_owned(),
        None if study.ladder.iter().any(|rung| rung.missing.is_some()) => "the measure".to_owned(),
        None => "unproven".to_owned(),
    }
}
