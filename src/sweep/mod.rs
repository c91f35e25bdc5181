//! The scale sweep: how far the device's image mean is from the twin's where renderers
//! go wrong.

mod cases;

pub use cases::{Case, cases};

use crate::estimate::{Paired, pair};
use crate::scene::{Estimator, ImageSize, Scene};
use crate::tracer::{TraceError, Tracer};
use crate::verify::{ALPHA, MAX_BIAS};
use std::sync::atomic::{AtomicBool, Ordering};

/// The standard error of a bias at which it counts as measured, relative.
pub const RESOLVED: f64 = 2.5e-4;

/// Samples per pixel of the first look and the most that are spent on a row.
const FIRST: u64 = 256;
const MOST: u64 = 1 << 16;

/// Level of one channel at one of the nine looks of a row.
const LEVEL: f64 = ALPHA / 27.0;

/// Pixels along a side of the pictures.
const SIDE: u32 = 64;

/// What was found of one case under one estimator.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// Samples per pixel.
    pub samples: u64,
    /// Device against twin, same random numbers.
    pub paired: Paired,
    /// Invalid samples on both together.
    pub invalid: u64,
}

impl Row {
    /// Samples on each side.
    #[must_use]
    pub fn paths(&self) -> u64 {
        self.samples * u64::from(SIDE * SIDE)
    }

    /// Bias and standard error of the channel that is off most.
    #[must_use]
    pub fn worst(&self) -> (f64, f64) {
        let channels = std::iter::zip(self.paired.bias, self.paired.error);
        channels.max_by(|a, b| a.0.abs().total_cmp(&b.0.abs())).unwrap_or_default()
    }

    /// Whether the bias is known as well as the sweep asks for.
    #[must_use]
    pub fn is_resolved(&self) -> bool {
        self.paired.error.iter().all(|&error| error <= RESOLVED)
    }

    /// Whether the bias is within its limit, and no sample was invalid.
    #[must_use]
    pub fn is_right(&self) -> bool {
        self.invalid == 0 && self.is_resolved() && self.paired.is_within(MAX_BIAS, LEVEL)
    }

    /// Whether it certainly is not.
    #[must_use]
    pub fn is_wrong(&self) -> bool {
        self.invalid > 0 || self.paired.exceeds(MAX_BIAS, LEVEL)
    }
}

/// How tracers are made.
pub type Open<'a> = &'a dyn Fn(&Scene) -> Result<Box<dyn Tracer>, TraceError>;

/// Traces the same samples on both until it is known whether the device is right; nothing
/// if it was interrupted before.
///
/// # Errors
/// If a tracer fails.
///
/// # Panics
/// Never: the size is a picture's.
pub fn measure(
    case: &Case,
    estimator: Estimator,
    device: Open<'_>,
    twin: Open<'_>,
    interrupt: &AtomicBool,
) -> Result<Option<Row>, TraceError> {
    let size = ImageSize::new(SIDE, SIDE).expect("a picture");
    let with = |scene: &Scene| {
        let settings = scene.settings().with_estimator(estimator);
        scene.clone().with_settings(settings).with_size(size)
    };
    let mut device = device(&with(&case.scene))?;
    let mut twin = twin(&with(&case.reference))?;
    let (mut from, mut to) = (0, FIRST);
    loop {
        for tracer in [&mut device, &mut twin] {
            if interrupt.load(Ordering::Relaxed) {
                return Ok(None);
            }
            tracer.add_samples(from..to)?;
        }
        let paired = pair(&device.film()?, &twin.film()?);
        let invalid = device.ledger()?.count + twin.ledger()?.count;
        let row = Row { samples: to, paired, invalid };
        if row.is_right() || row.is_wrong() || to == MOST {
            return Ok(Some(row));
        }
        (from, to) = (to, 2 * to);
    }
}
