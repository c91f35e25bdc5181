//! The progressive loop: drives a tracer through a range of samples until it is done,
//! out of time or interrupted.

use crate::estimate::{Summary, summarize};
use crate::tracer::{TraceError, Tracer};
use std::ops::Range;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// One call of the tracer should take this long: often enough for progress and
/// Ctrl-C, seldom enough not to matter.
const ROUND: Duration = Duration::from_millis(200);

/// Looking at the error may take this share of the render's time.
const LOOK_SHARE: f64 = 0.01;

/// What to render.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Plan {
    /// Samples of every pixel.
    pub samples: Range<u64>,
    /// Stop after this long, with whatever samples there are; at least one.
    pub time: Option<Duration>,
}

/// Why a render stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// All samples are traced.
    Done,
    /// The time was up.
    Time,
    /// Interrupted from outside.
    Interrupted,
}

/// How far a render is.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Samples per pixel so far.
    pub done: u64,
    /// Time since the start.
    pub elapsed: Duration,
    /// The latest look at the picture's error, if there was one.
    pub summary: Option<Summary>,
}

/// A finished render.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// Why it stopped.
    pub stop: Stop,
    /// Time spent.
    pub elapsed: Duration,
}

/// Renders according to plan. `observe` is told of the progress after every round;
/// with `look`, also of the picture's error from time to time.
///
/// # Errors
/// If the tracer fails.
pub fn render(
    tracer: &mut dyn Tracer,
    plan: &Plan,
    interrupt: &AtomicBool,
    look: bool,
    observe: &mut dyn FnMut(Progress),
) -> Result<Outcome, TraceError> {
    let started = Instant::now();
    let mut next = plan.samples.start;
    let mut count = 1;
    let mut summary = None;
    let mut next_look = Duration::from_secs(1);
    let stop = loop {
        if next >= plan.samples.end {
            break Stop::Done;
        }
        // At least one sample of every pixel is traced, so that there is a picture.
        if next > plan.samples.start {
            if interrupt.load(Ordering::Relaxed) {
                break Stop::Interrupted;
            }
            if plan.time.is_some_and(|limit| started.elapsed() >= limit) {
                break Stop::Time;
            }
        }
        let round = Instant::now();
        let end = plan.samples.end.min(next + count);
        tracer.add_samples(next..end)?;
        let left = plan.time.map(|limit| limit.saturating_sub(started.elapsed()));
        count = next_count(end - next, round.elapsed(), left.unwrap_or(ROUND).min(ROUND));
        next = end;
        if look && started.elapsed() >= next_look {
            let looked = Instant::now();
            summary = Some(summarize(&tracer.film()?));
            let pause = looked.elapsed().div_f64(LOOK_SHARE).max(Duration::from_secs(1));
            next_look = started.elapsed() + pause;
        }
        observe(Progress { done: next - plan.samples.start, elapsed: started.elapsed(), summary });
    };
    Ok(Outcome { stop, elapsed: started.elapsed() })
}

/// Samples of the next round, from what the last one took; at most four times as many.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a guess at a count"
)]
fn next_count(count: u64, took: Duration, budget: Duration) -> u64 {
    let fitting = count as f64 * budget.as_secs_f64() / took.as_secs_f64().max(1e-6);
    (fitting as u64).clamp(1, count * 4)
}
