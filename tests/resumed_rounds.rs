//! The progressive loop goes on from any film that it could have left: in the order of the plan,
//! and to a stated error with the samples of a render that nothing interrupted.

mod support {
    pub mod scenes;
}

use candor::cpu::CpuTracer;
use candor::film::{Film, SampleRanges};
use candor::render::{Audience, Begun, Outcome, Plan, Stop, render};
use candor::scene::{Estimator, Scene};
use candor::tracer::{Description, Ledger, TraceError, Tracer};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use support::scenes::{many, size};

const TARGET: f64 = 0.6;

/// The twin, which keeps what it was asked for.
struct Recorder {
    twin: CpuTracer,
    asked: Vec<Range<u64>>,
}

impl Recorder {
    fn new(scene: &Scene) -> Self {
        let twin = CpuTracer::new(scene, NonZeroUsize::new(1)).expect("a thread");
        Self { twin, asked: Vec::new() }
    }
}

impl Tracer for Recorder {
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError> {
        self.asked.push(range.clone());
        self.twin.add_samples(range)
    }

    fn restore(&mut self, film: &Film, ledger: &Ledger) -> Result<(), TraceError> {
        self.twin.restore(film, ledger)
    }

    fn film(&mut self) -> Result<Film, TraceError> {
        self.twin.film()
    }

    fn ledger(&mut self) -> Result<Ledger, TraceError> {
        self.twin.ledger()
    }

    fn describe(&self) -> Description {
        self.twin.describe()
    }
}

fn scene() -> Scene {
    let scene = many(size(6, 4));
    let settings = scene.settings().with_estimator(Estimator::Mis);
    scene.with_settings(settings)
}

fn ranges(text: &str) -> SampleRanges {
    text.parse().expect("ranges")
}

/// A plan that traces what is missing of `wanted` in a film that holds `there`.
fn plan(there: &SampleRanges, wanted: &Range<u64>, target_error: Option<f64>) -> Plan {
    let begun = Begun { samples: there.count(), ..Begun::default() };
    Plan { begun, ranges: there.missing(wanted), time: None, target_error }
}

/// What a render could have left behind after a round.
struct Left {
    film: Film,
    begun: Begun,
}

/// Renders, and keeps what could have been left after each round.
fn rendered(tracer: &mut Recorder, plan: &Plan) -> (Outcome, Vec<Left>) {
    let mut all = Vec::new();
    let never = AtomicBool::new(false);
    let outcome = render(tracer, plan, &never, Audience::Nobody, &mut |at, tracer| {
        let begun = Begun { samples: at.done, elapsed: at.elapsed, next_look: at.next_look };
        all.push(Left { film: tracer.film()?, begun });
        Ok(())
    });
    (outcome.expect("the twin traces"), all)
}

/// However a range is cut into rounds, the samples come in the order of the plan, and no round
/// crosses what is there.
#[test]
fn gaps_come_first_and_in_order() {
    for (there, wanted, missing) in [
        ("0..3,8..12", 0..16, "3..8,12..16"),
        ("0..3,8..12", 0..400, "3..8,12..400"),
        ("5..6,9..40,50..60", 0..70, "0..5,6..9,40..50,60..70"),
        ("0..3,8..12", 10..20, "12..20"),
    ] {
        let there = ranges(there);
        let mut tracer = Recorder::new(&scene());
        let (outcome, _) = rendered(&mut tracer, &plan(&there, &wanted, None));
        assert_eq!(outcome.stop, Stop::Done);
        let mut asked: Vec<Range<u64>> = Vec::new();
        for range in tracer.asked {
            match asked.last_mut().filter(|last| last.end == range.start) {
                Some(last) => last.end = range.end,
                None => asked.push(range),
            }
        }
        // Ascending as they are written, which the joined ranges of a film are by nature.
        let texts: Vec<_> = asked.iter().map(|r| format!("{}..{}", r.start, r.end)).collect();
        assert_eq!(texts.join(","), missing, "{there}");
    }
}

#[test]
fn a_film_that_holds_all_is_not_traced() {
    let mut tracer = Recorder::new(&scene());
    let (outcome, left) = rendered(&mut tracer, &plan(&ranges("0..40"), &(3..9), None));
    assert_eq!((outcome.stop, tracer.asked.len(), left.len()), (Stop::Done, 0, 0));
}

fn to_target(tracer: &mut Recorder, begun: Begun, there: &SampleRanges) -> (Film, Vec<Left>) {
    let plan = Plan { begun, ..plan(there, &(0..1 << 31), Some(TARGET)) };
    let (outcome, left) = rendered(tracer, &plan);
    assert_eq!(outcome.stop, Stop::Target);
    (tracer.film().expect("a film"), left)
}

fn resumed(left: &Left) -> Film {
    let mut tracer = Recorder::new(&scene());
    tracer.restore(&left.film, &Ledger::default()).expect("the same picture");
    to_target(&mut tracer, left.begun, left.film.samples()).0
}

/// Whichever round was the last before a kill, the one included that reached the target.
#[test]
fn a_target_is_reached_with_the_same_samples_from_any_round() {
    let mut tracer = Recorder::new(&scene());
    let (film, mut left) = to_target(&mut tracer, Begun::default(), &SampleRanges::default());
    let end = film.samples().count();
    assert!(end > 64, "{end} samples leave too few looks");
    assert_eq!(left.last().map(|last| last.begun.samples), Some(end));
    for round in &left {
        assert!(resumed(round) == film, "from {} not to {end}", round.begun.samples);
    }
    // The injected fault: the look that reached the target is not looked at again.
    let last = left.last_mut().expect("rounds");
    last.begun.next_look = Some(end + 1);
    assert!(resumed(last) != film);
}

/// Wherever a limit ended it, at a look or between two.
#[test]
fn a_target_is_reached_with_the_same_samples_from_any_limit() {
    let (film, _) =
        to_target(&mut Recorder::new(&scene()), Begun::default(), &SampleRanges::default());
    for limit in (1..film.samples().count()).step_by(13) {
        let mut tracer = Recorder::new(&scene());
        let limited = plan(&SampleRanges::default(), &(0..limit), Some(TARGET));
        let (outcome, _) = rendered(&mut tracer, &limited);
        assert_eq!(outcome.stop, Stop::Done);
        let begun = Begun { samples: limit, next_look: outcome.next_look, ..Begun::default() };
        let left = Left { film: tracer.film().expect("a film"), begun };
        assert!(resumed(&left) == film, "from {limit}");
    }
}
