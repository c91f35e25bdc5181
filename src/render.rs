//! The progressive loop: drives a tracer through ranges of samples until it is done, at a
//! stated error, out of time or interrupted.

use crate::estimate::{FIRST_LOOK, Summary, is_look, next_look, summarize};
use crate::film::SampleRanges;
use crate::tracer::{TraceError, Tracer};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// One call of the tracer should take this long: often enough for progress and
/// Ctrl-C, seldom enough not to matter.
const ROUND: Duration = Duration::from_millis(200);

/// Looking at the error may take this share of the render's time.
const LOOK_SHARE: f64 = 0.01;

/// What to render.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What the tracer's film holds already.
    pub begun: Begun,
    /// Samples of every pixel that are to be added, in ascending order.
    pub ranges: SampleRanges,
    /// Stop after this long, [`Begun::elapsed`] included, with whatever samples there are; at
    /// least one.
    pub time: Option<Duration>,
    /// Stop when the upper confidence bound on the relative RMS error
    /// ([`Summary::error_bound`]) is at or below this fraction.
    pub target_error: Option<f64>,
}

/// What was rendered earlier.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Begun {
    /// Samples of every pixel.
    pub samples: u64,
    /// Time spent on them.
    pub elapsed: Duration,
    /// Samples at which the error was to be looked at next, for the same target.
    pub next_look: Option<u64>,
}

impl Plan {
    /// Samples of every pixel at the end, unless something else ends the render.
    #[must_use]
    pub fn total(&self) -> u64 {
        self.begun.samples + self.ranges.count()
    }
}

/// Who wants to know the picture's error while it is rendered.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Audience {
    /// Nobody: it is looked at only where a target asks for it.
    Nobody,
    /// A person: also from time to time.
    Person,
    /// A log: also at every power of two.
    Log,
}

/// Why a render stopped.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stop {
    /// All samples are traced.
    Done,
    /// The error is at or below the target.
    Target,
    /// The time was up.
    Time,
    /// Interrupted from outside.
    Interrupted,
    /// The tracer failed, and there is what it had before; [`render`] itself returns the error.
    Failed,
}

/// How far a render is.
#[derive(Debug, Clone, Copy)]
pub struct Progress {
    /// Samples per pixel so far.
    pub done: u64,
    /// Time spent so far, [`Begun::elapsed`] included.
    pub elapsed: Duration,
    /// Samples at which the error is looked at next, if there is a target.
    pub next_look: Option<u64>,
    /// The latest look at the picture's error, if there was one; it was just now if
    /// `summary.samples` is `done`. It has a bound only at the counts that the bound's
    /// confidence is spread over ([`is_look`]).
    pub summary: Option<Summary>,
}

/// A finished render.
#[derive(Debug, Clone, Copy)]
pub struct Outcome {
    /// Why it stopped.
    pub stop: Stop,
    /// Time spent, [`Begun::elapsed`] included.
    pub elapsed: Duration,
    /// Samples at which the error would have been looked at next, if there is a target.
    pub next_look: Option<u64>,
}

/// Told of the progress after every round; it may look at the tracer's film.
pub type Observer<'a> = dyn FnMut(&Progress, &mut dyn Tracer) -> Result<(), TraceError> + 'a;

/// Renders according to plan.
///
/// With a target, the samples that the render ends with depend on the picture alone, not on
/// the time that it took, unless a limit ends it.
///
/// # Errors
/// If the tracer or the observer fails.
pub fn render(
    tracer: &mut dyn Tracer,
    plan: &Plan,
    interrupt: &AtomicBool,
    audience: Audience,
    observe: &mut Observer,
) -> Result<Outcome, TraceError> {
    let started = Instant::now();
    let elapsed = || plan.begun.elapsed + started.elapsed();
    let mut watch = Watch::new(plan, audience);
    let mut ranges = plan.ranges.as_slice().iter().cloned();
    let mut range = 0..0;
    let (mut done, mut count) = (plan.begun.samples, 1);
    if plan.target_error.is_some() && done > 0 {
        watch.observe(tracer, done, elapsed())?;
    }
    let stop = loop {
        if watch.target_reached {
            break Stop::Target;
        }
        if range.is_empty() {
            let Some(next) = ranges.next() else { break Stop::Done };
            range = next;
        }
        // At least one sample of every pixel is traced, so that there is a picture.
        if done > 0 {
            if interrupt.load(Ordering::Relaxed) {
                break Stop::Interrupted;
            }
            if plan.time.is_some_and(|limit| elapsed() >= limit) {
                break Stop::Time;
            }
        }
        let round = Instant::now();
        let size = count.min(range.end - range.start).min(watch.next_count(done) - done);
        tracer.add_samples(range.start..range.start + size)?;
        range.start += size;
        done += size;
        let left = plan.time.map(|limit| limit.saturating_sub(elapsed()));
        count = next_count(count, size, round.elapsed(), left.unwrap_or(ROUND).min(ROUND));
        watch.observe(tracer, done, elapsed())?;
        let (next_look, summary) = (watch.next_look(), watch.summary);
        observe(&Progress { done, elapsed: elapsed(), next_look, summary }, tracer)?;
    };
    Ok(Outcome { stop, elapsed: elapsed(), next_look: watch.next_look() })
}

/// When the error is looked at, and what was seen.
struct Watch {
    audience: Audience,
    target: Option<f64>,
    /// The next look that the target asks for.
    target_look: u64,
    target_reached: bool,
    /// The next look for those who watch.
    next_time: Duration,
    summary: Option<Summary>,
}

impl Watch {
    fn new(plan: &Plan, audience: Audience) -> Self {
        let begun = plan.begun;
        // The first possible look from here on, which may be at once.
        let planned = begun.next_look.filter(|&look| look >= begun.samples);
        let first = planned.unwrap_or(match begun.samples {
            0 => FIRST_LOOK,
            samples => next_look(samples - 1, Some(samples)),
        });
        Self {
            audience,
            target: plan.target_error,
            target_look: plan.target_error.map_or(u64::MAX, |_| first),
            target_reached: false,
            next_time: begun.elapsed + Duration::from_secs(1),
            summary: None,
        }
    }

    fn next_look(&self) -> Option<u64> {
        self.target.map(|_| self.target_look)
    }

    /// The count after `done` at which a round must end for a look.
    fn next_count(&self, done: u64) -> u64 {
        match self.audience {
            Audience::Log => self.target_look.min((done + 1).next_power_of_two()),
            Audience::Nobody | Audience::Person => self.target_look,
        }
    }

    /// Looks, if it is time.
    fn observe(
        &mut self,
        tracer: &mut dyn Tracer,
        done: u64,
        elapsed: Duration,
    ) -> Result<(), TraceError> {
        let by_count =
            done == self.target_look || (self.audience == Audience::Log && done.is_power_of_two());
        let by_time = self.audience != Audience::Nobody && elapsed >= self.next_time;
        if !by_count && !by_time {
            return Ok(());
        }
        let looked = Instant::now();
        let mut summary = summarize(&tracer.film()?);
        if !is_look(done) {
            summary.error_bound = None;
        }
        let proven = tracer.ledger()?.count == 0;
        if let (Some(target), true) = (self.target, done == self.target_look) {
            self.target_reached = summary.error_bound.is_some_and(|bound| bound <= target);
            // The look that reaches the target stays the next one: who goes on from a film that
            // was written just now looks again, and ends here too.
            if !self.target_reached {
                self.target_look = next_look(done, summary.spread.samples_to(target));
            }
        }
        // Samples that are invalid add 0 where they should not.
        summary.error_bound = summary.error_bound.filter(|_| proven);
        self.summary = Some(summary);
        let pause = looked.elapsed().div_f64(LOOK_SHARE).max(Duration::from_secs(1));
        self.next_time = elapsed + looked.elapsed() + pause;
        Ok(())
    }
}

/// Samples of the next round, from the time that `traced` samples of the last one took; at
/// most four times as many. A round that was cut short for a look says little about more.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    clippy::cast_precision_loss,
    reason = "a guess at a count"
)]
fn next_count(count: u64, traced: u64, took: Duration, budget: Duration) -> u64 {
    let fitting = traced as f64 * budget.as_secs_f64() / took.as_secs_f64().max(1e-6);
    (fitting as u64).clamp(1, count.max(4 * traced))
}
