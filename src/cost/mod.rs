//! What accuracy costs on this device: speed, variance and time to a given error for every
//! estimator, the price of the bounce limit, and f32 on the device against the f64 twin.
//!
//! A [`study`] measures; it prints and writes nothing. It needs no reference picture: errors
//! come from the samples' own variance and from the realised differences of a film's halves.

mod estimators;
mod fit;
mod halves;
mod interval;
mod ladder;
mod plan;
mod race;
mod stopwatch;
mod strip;
mod study;
mod twin;

pub use estimators::{EstimatorCost, MIN_VARYING, Noise, Prediction, TARGETS};
pub use fit::{
    Agreement, EXPECTED, MATTERS, Point, RATIO_MATTERS, Slope, WARNING_CONFIDENCE, agreement, fit,
};
pub use interval::{CONFIDENCE, Measured};
pub use ladder::{RUNGS, Rung};
pub use plan::{MIN_BUDGET, Phase, Plan};
pub use race::affordable;
pub use strip::{STRIP_COUNTS, STRIP_SIDE, Strip, StripPicture};
pub use study::{LeftOut, Study, resolvable, study};
pub use twin::TwinCost;

use crate::film::BYTES_PER_PIXEL;
use crate::scene::Scene;
use crate::tracer::{TraceError, Tracer};
use crate::watch::{self, Interrupted};
use halves::SNAPSHOT_BYTES;
use std::time::Duration;

/// Makes tracers of scenes.
pub type MakeTracer<'a> = &'a dyn Fn(&Scene) -> Result<Box<dyn Tracer>, TraceError>;

/// What traces in a study.
#[derive(Clone, Copy)]
pub struct Tracers<'a> {
    /// On the device that is studied.
    pub device: MakeTracer<'a>,
    /// In `f64` on this machine's processor; none where that is the device itself.
    pub twin: Option<MakeTracer<'a>>,
}

/// Why a study has no result.
#[derive(Debug, thiserror::Error)]
pub enum CostError {
    /// A tracer gave up.
    #[error(transparent)]
    Trace(#[from] TraceError),
    /// The budget is too short for a few samples of every pixel.
    #[error(
        "the budget is too short for this picture on this device; it takes at least {}s, or a \
         smaller picture", needed.as_secs_f64().ceil()
    )]
    Short {
        /// The shortest budget that would do.
        needed: Duration,
    },
    /// Samples were invalid, so that no number means what it says.
    #[error("{count} of the samples with the {estimator} estimator were invalid")]
    Invalid {
        /// How many.
        count: u64,
        /// Name of the estimator.
        estimator: &'static str,
    },
    /// Interrupted from outside.
    #[error("interrupted")]
    Interrupted,
}

impl From<Interrupted> for CostError {
    fn from(_: Interrupted) -> Self {
        Self::Interrupted
    }
}

/// Who looks on.
pub type Watch<'a> = watch::Watch<'a, Phase>;

/// Bytes of this machine's memory that a study takes for each pixel: the pilot's four films
/// and their snapshots, or the ladder's films, each with one more on its way. The films are
/// here where the device is this machine's processor; elsewhere this is an upper bound.
#[must_use]
pub fn bytes_per_pixel() -> u64 {
    let pilot = 4 * (BYTES_PER_PIXEL + 2 * SNAPSHOT_BYTES) + SNAPSHOT_BYTES;
    let ladder = (RUNGS.len() as u64 + 1) * BYTES_PER_PIXEL;
    pilot.max(ladder) + BYTES_PER_PIXEL
}
