//! Renders, and keeps what there was where the tracer fails for good.

use crate::enduring::Enduring;
use crate::film::Film;
use crate::render::{Audience, Observer, Outcome, Plan, Progress, Stop, render};
use crate::tracer::{Ledger, TraceError, Tracer};
use std::sync::atomic::AtomicBool;
use std::time::Instant;

/// What was rendered, and how it ended.
pub(super) struct Traced {
    pub outcome: Outcome,
    pub film: Film,
    pub ledger: Ledger,
    /// Why there is no more of it.
    pub failure: Option<TraceError>,
}

/// Renders according to plan. Where the tracer fails, the last whole state is what was
/// rendered: its samples were paid for.
///
/// # Errors
/// If the tracer fails before there is anything.
pub(super) fn trace(
    tracer: &mut Enduring,
    plan: &Plan,
    interrupt: &AtomicBool,
    audience: Audience,
    observe: &mut Observer,
) -> Result<Traced, TraceError> {
    let started = Instant::now();
    // A look at the error takes a whole state: what was planned last is planned from that one.
    let mut next_look = plan.begun.next_look;
    let mut observe = |progress: &Progress, tracer: &mut dyn Tracer| {
        next_look = progress.next_look;
        observe(progress, tracer)
    };
    let rendered = render(tracer, plan, interrupt, audience, &mut observe).and_then(|outcome| {
        Ok(Traced { outcome, film: tracer.film()?, ledger: tracer.ledger()?, failure: None })
    });
    let error = match rendered {
        Err(error) => error,
        whole => return whole,
    };
    match tracer.last_whole() {
        Some((film, ledger)) if film.samples().count() > 0 => {
            let elapsed = plan.begun.elapsed + started.elapsed();
            let outcome = Outcome { stop: Stop::Failed, elapsed, next_look };
            Ok(Traced { outcome, film, ledger, failure: Some(error) })
        }
        _ => Err(error),
    }
}
