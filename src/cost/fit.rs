//! Realised errors against what they must be: the slope of a weighted straight line through
//! logarithms, and the ratio to the stated error.

use super::interval::{CONFIDENCE, LogError, Measured, student};
use serde::Serialize;

/// What independent samples of finite variance give.
pub const EXPECTED: f64 = -0.5;

/// Confidence with which a slope must differ from -½, or a ratio from 1, before it is a
/// warning: one false alarm in a thousand.
pub const WARNING_CONFIDENCE: f64 = 0.999;

/// A slope that differs by less than this does not matter: the samples for a tenth of the
/// error, 10^(1/slope), change by less than a tenth.
pub const MATTERS: f64 = 0.01;

/// Realised errors whose ratio to the stated ones is off by less than this do not matter: the
/// time to an error changes by about a tenth.
pub const RATIO_MATTERS: f64 = 0.05;

/// Fewest points of a fit; the slope's interval then has two degrees of freedom.
const MIN_POINTS: usize = 4;

/// One point of a convergence curve.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Point {
    /// Samples of every pixel.
    pub samples: u64,
    /// Relative RMS error at that many samples.
    pub error: f64,
    /// Relative standard error of `error`.
    pub uncertainty: f64,
}

impl Point {
    /// The error with its 95 % interval.
    #[must_use]
    pub fn interval(&self) -> Measured {
        LogError::known(self.uncertainty).interval(self.error)
    }

    /// Logarithm of the error without its bias: ln √(χ²/k) is 1/(2k) = u² too small on
    /// average, where χ² has k degrees of freedom and its root the relative standard error u
    /// (Bartlett & Kendall 1946).
    fn log(&self) -> f64 {
        self.error.ln() + self.uncertainty.powi(2)
    }
}

/// A fitted slope of log error against log samples.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Slope {
    /// The slope and its 95 % interval.
    pub slope: Measured,
    /// Points that were fitted.
    pub points: usize,
    /// Whether the slope is certainly not -½, by enough to matter ([`MATTERS`]): its interval
    /// does not hold -½, and the points' own uncertainties rule it out at
    /// [`WARNING_CONFIDENCE`]. The first alone would be a false alarm in every twentieth fit;
    /// the second alone would trust uncertainties that residuals may contradict.
    pub suspect: bool,
}

/// Realised errors beside the stated ones.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Agreement {
    /// Realised over stated error, and its 95 % interval.
    pub ratio: Measured,
    /// Whether the ratio is certainly not 1 ([`WARNING_CONFIDENCE`]), by enough to matter
    /// ([`RATIO_MATTERS`]).
    pub suspect: bool,
}

/// The weighted mean of the ratio of `points` to the error √(variance/samples), on a log
/// scale. `None` without points.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "a count of samples")]
pub fn agreement(points: &[Point], variance: f64) -> Option<Agreement> {
    if points.is_empty() {
        return None;
    }
    let weights = points.iter().map(|point| point.uncertainty.powi(2).recip());
    let total: f64 = weights.clone().sum();
    let logs = points.iter().map(|p| p.log() - (variance / p.samples as f64).sqrt().ln());
    let mean = weights.zip(logs).map(|(weight, log)| weight * log).sum::<f64>() / total;
    let error = LogError::known(total.sqrt().recip());
    let certain = mean.abs() > student(error.freedom, WARNING_CONFIDENCE) * error.error;
    let ratio = error.interval(mean.exp());
    Some(Agreement { ratio, suspect: certain && (ratio.value - 1.0).abs() > RATIO_MATTERS })
}

/// Fits a line to the logarithms of `points` with weights 1/uncertainty². The scale of the
/// residuals is estimated from them, so the interval is Student's with two degrees of
/// freedom less than there are points. `None` with fewer than four.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "counts of samples and points")]
pub fn fit(points: &[Point]) -> Option<Slope> {
    if points.len() < MIN_POINTS {
        return None;
    }
    let logs = points.iter().map(|point| {
        let weight = point.uncertainty.powi(2).recip();
        (weight, (point.samples as f64).ln(), point.log())
    });
    let total: f64 = logs.clone().map(|(w, _, _)| w).sum();
    let mean_x = logs.clone().map(|(w, x, _)| w * x).sum::<f64>() / total;
    let mean_y = logs.clone().map(|(w, _, y)| w * y).sum::<f64>() / total;
    let spread: f64 = logs.clone().map(|(w, x, _)| w * (x - mean_x).powi(2)).sum();
    let common: f64 = logs.clone().map(|(w, x, y)| w * (x - mean_x) * (y - mean_y)).sum();
    let slope = common / spread;
    let residuals: f64 =
        logs.map(|(w, x, y)| w * (y - mean_y - slope * (x - mean_x)).powi(2)).sum();
    let freedom = points.len() as f64 - 2.0;
    let error = (residuals / freedom / spread).sqrt();
    let off = (slope - EXPECTED).abs();
    Some(Slope {
        slope: Measured::around(slope, student(freedom, CONFIDENCE) * error),
        points: points.len(),
        suspect: off > MATTERS
            && off > student(freedom, CONFIDENCE) * error
            && off > student(f64::INFINITY, WARNING_CONFIDENCE) / spread.sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::{Point, agreement, fit};

    /// Independent uniform numbers (splitmix64, Steele et al. 2014).
    struct Uniform(u64);

    impl Uniform {
        #[expect(clippy::cast_precision_loss, reason = "53 bits fit")]
        fn next(&mut self) -> f64 {
            self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut z = self.0;
            z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            ((z ^ (z >> 31)) >> 11) as f64 / (1_u64 << 53) as f64
        }

        /// A standard normal number (Box & Muller 1958).
        fn normal(&mut self) -> f64 {
            let radius = (-2.0 * (1.0 - self.next()).ln()).sqrt();
            radius * (std::f64::consts::TAU * self.next()).cos()
        }
    }

    /// Errors 3·samples^slope at 2, 4, …, 256 samples, each with its own uncertainty and with
    /// the mean square that it must have.
    #[expect(clippy::cast_precision_loss, reason = "small counts")]
    fn points(random: &mut Uniform, slope: f64) -> Vec<Point> {
        let point = |k: u32| {
            let uncertainty = 0.01 + 0.01 * f64::from(k % 3);
            let samples = 1_u64 << k;
            let error = 3.0 * (samples as f64).powf(slope);
            let error = error * (uncertainty * (random.normal() - uncertainty)).exp();
            Point { samples, error, uncertainty }
        };
        (1..=8).map(point).collect()
    }

    /// Of 2000 fits, 95 % of the intervals cover the slope, give or take five standard
    /// errors of 0.5 % each. At most 2 false warnings are expected; more than 14 where 2 are
    /// expected have probability 1e-8 (Poisson). The ratio's interval covers as well.
    #[test]
    fn intervals_cover_and_warnings_are_rare() {
        let mut random = Uniform(1);
        let (mut covered, mut warned, mut ratios) = (0, 0, 0);
        for _ in 0..2000 {
            let points = points(&mut random, -0.5);
            let found = fit(&points).expect("eight points");
            covered += i32::from(found.slope.low <= -0.5 && -0.5 <= found.slope.high);
            warned += i32::from(found.suspect);
            let found = agreement(&points, 9.0).expect("eight points");
            ratios += i32::from(found.ratio.low <= 1.0 && 1.0 <= found.ratio.high);
            assert!(!found.suspect, "5 % are seven standard errors: {found:?}");
        }
        assert!((1900 - 49..=1900 + 49).contains(&covered), "{covered} of 2000 intervals");
        assert!((1900 - 49..=1900 + 49).contains(&ratios), "{ratios} of 2000 intervals");
        assert!(warned <= 14, "{warned} of 2000 fits");
    }

    /// The injected faults: a slope of -0.4, 25 standard errors off, and an error of 1.1
    /// times what is stated.
    #[test]
    fn a_wrong_slope_and_a_wrong_error_are_found() {
        let mut random = Uniform(2);
        for _ in 0..200 {
            assert!(fit(&points(&mut random, -0.4)).expect("eight points").suspect);
            let found = agreement(&points(&mut random, -0.5), 9.0 / 1.21).expect("eight points");
            assert!(found.suspect, "{found:?}");
        }
    }

    /// Roots of χ² with 8 degrees of freedom, all of them uncertain by 1/√16: their mean
    /// logarithm is off by -1/16, twice five standard errors of 2000 points.
    #[test]
    fn few_degrees_of_freedom_do_not_lower_the_ratio() {
        let mut random = Uniform(4);
        let points: Vec<Point> = (0..2000)
            .map(|_| {
                let squares: f64 = (0..8).map(|_| random.normal().powi(2)).sum();
                Point { samples: 1, error: (squares / 8.0).sqrt(), uncertainty: 0.25 }
            })
            .collect();
        let found = agreement(&points, 1.0).expect("points");
        let five_errors = 5.0 * 0.25 / 2000_f64.sqrt();
        assert!(found.ratio.value.ln().abs() < five_errors, "{found:?}");
    }

    #[test]
    fn three_points_are_no_fit() {
        let points = points(&mut Uniform(3), -0.5);
        assert!(fit(&points[..3]).is_none() && fit(&points[..4]).is_some());
        assert!(agreement(&[], 1.0).is_none());
    }
}
