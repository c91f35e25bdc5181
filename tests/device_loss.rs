//! A tracer whose device is lost, at any call and as often as it may be: the same film, or what
//! was whole before.

mod support {
    pub mod faulty;
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::enduring::Enduring;
use candor::film::Film;
use candor::scene::Scene;
use candor::tracer::{Ledger, TraceError, Tracer};
use std::cell::RefCell;
use std::ops::Range;
use std::rc::Rc;
use std::thread::sleep;
use std::time::Duration;
use support::faulty::{Call, Faults, Faulty, Mistake};
use support::scenes::{classic, size};
use support::tracers::{film, twin};

/// Losses in a row that are endured.
const ENDURED: usize = 5;

fn scene() -> Scene {
    classic(size(9, 7))
}

/// An enduring tracer, how often each of its devices was lost in a row, and what it told.
struct Tested<'a> {
    enduring: Enduring<'a>,
    faults: Rc<RefCell<Faults>>,
    losses: Rc<RefCell<Vec<u32>>>,
    told: Rc<RefCell<Vec<String>>>,
}

impl<'a> Tested<'a> {
    fn new(scene: &'a Scene, faults: Rc<RefCell<Faults>>, mistake: Mistake) -> Self {
        let (losses, told) = (Rc::new(RefCell::new(Vec::new())), Rc::new(RefCell::new(Vec::new())));
        let (all, plan, texts) = (Rc::clone(&losses), Rc::clone(&faults), Rc::clone(&told));
        let enduring = Enduring::new(
            Box::new(move |losses| {
                all.borrow_mut().push(losses);
                Ok(Box::new(Faulty::new(scene, &plan, mistake)?))
            }),
            Box::new(move |text| texts.borrow_mut().push(text.to_owned())),
        );
        Self { enduring: enduring.expect("the first one is made"), faults, losses, told }
    }

    fn told(&self) -> String {
        self.told.borrow().join("\n")
    }
}

/// What is added between two looks.
const PARTS: [&[Range<u64>]; 4] = [&[0..1, 1..3], &[3..4, 4..9], &[], &[20..23, 9..11]];

/// Adds everything, with a look after each part; what was seen at the last of them.
fn trace(tracer: &mut dyn Tracer) -> Result<(Film, Ledger), TraceError> {
    for part in PARTS {
        for range in part {
            tracer.add_samples(range.clone())?;
        }
        let (film, ledger) = (tracer.film()?, tracer.ledger()?);
        assert_eq!(ledger.count, film.samples().count(), "film and ledger of other samples");
    }
    Ok((tracer.film()?, tracer.ledger()?))
}

/// The same without any loss.
fn expected(scene: &Scene) -> Film {
    film(&mut twin(scene), &PARTS.concat())
}

/// Any run of up to five calls fails: the film is the one without losses, and so is the ledger.
#[test]
fn losses_at_any_call_change_no_bit() {
    let scene = scene();
    let expected = expected(&scene);
    for run in 1..=ENDURED {
        for first in 0.. {
            // Making a tracer is left alone here: it is tried again only after a pause.
            let fails =
                move |call, what| what != Call::Make && (first..first + 2 * run).contains(&call);
            let mut left = run;
            let faults = Faults::new(move |call, what| {
                let fails = left > 0 && fails(call, what);
                left -= usize::from(fails);
                fails
            });
            let mut tested = Tested::new(&scene, faults, Mistake::None);
            let (film, ledger) = trace(&mut tested.enduring).expect("losses are endured");
            assert!(film == expected, "{run} losses from call {first} on: another film");
            assert_eq!(ledger.count, expected.samples().count());
            let calls = tested.faults.borrow().calls.len();
            let losses = tested.told().matches("the device was lost (at call ").count();
            if calls <= first {
                assert_eq!(losses, 0);
                break;
            }
            assert_eq!(tested.told().matches("opening it again").count(), losses);
            assert_eq!(tested.losses.borrow().len(), losses + 1);
        }
    }
}

/// The test above tells each mistake by the film or the ledger: some loss brings it to light.
#[test]
fn mistakes_are_told_by_film_or_ledger() {
    let scene = scene();
    let expected = expected(&scene);
    let mistakes =
        [Mistake::ForgetsAll, Mistake::ForgetsSums, Mistake::ForgetsLedger, Mistake::AddsTwice];
    for mistake in [&[Mistake::None], &mistakes[..]].concat() {
        // The third range is being added; there is a whole state.
        let mut added = 0;
        let faults = Faults::new(move |_, what| {
            added += usize::from(what == Call::Add);
            what == Call::Add && added == 3
        });
        let mut tested = Tested::new(&scene, faults, mistake);
        for range in PARTS[0].iter().chain(PARTS[1]).chain(PARTS[3]) {
            tested.enduring.add_samples(range.clone()).expect("losses are endured");
            if range.end == 3 {
                tested.enduring.film().expect("a film");
            }
        }
        let film = tested.enduring.film().expect("a film");
        let ledger = tested.enduring.ledger().expect("a ledger");
        let is_right = film == expected && ledger.count == expected.samples().count();
        assert_eq!(is_right, mistake == Mistake::None, "{mistake:?}");
        assert!(tested.told().contains("going on from 3 samples per pixel, with smaller"));
    }
}

/// From some call on everything fails: it gives up after five losses and says so, and what was
/// whole is still there, film and ledger of the same samples.
#[test]
fn a_device_that_is_lost_for_ever_costs_no_whole_state() {
    let scene = scene();
    let mut wholes = Vec::new();
    for first in 0.. {
        let faults = Faults::new(move |call, what| what != Call::Make && call >= first);
        let mut tested = Tested::new(&scene, faults, Mistake::None);
        let Err(error) = trace(&mut tested.enduring) else { break };
        if first == 0 {
            continue;
        }
        let text = error.to_string();
        let expected = "the device was lost: 6 times without a step forward, in the end: at call ";
        assert!(matches!(error, TraceError::DeviceLost(_)) && text.starts_with(expected), "{text}");
        assert_eq!(*tested.losses.borrow(), [0, 1, 2, 3, 4, 5]);
        let samples = tested.enduring.last_whole().map_or(0, |(whole, ledger)| {
            assert!(whole == film(&mut twin(&scene), whole.samples().as_slice()));
            assert_eq!(ledger.count, whole.samples().count());
            ledger.count
        });
        wholes.push(samples);
    }
    // Each of the states that were looked at, in their order.
    assert!(wholes.is_sorted());
    wholes.dedup();
    assert_eq!(wholes, [0, 3, 9]);
}

/// Every tenth call fails: many more losses than five, but each time it got ahead, and dispatches
/// are a quarter of the full size, no less.
#[test]
fn losses_between_steps_forward_are_endured_without_end() {
    let scene = scene();
    let faults = Faults::new(|call, what| what != Call::Make && call % 10 == 9);
    let mut tested = Tested::new(&scene, faults, Mistake::None);
    let ranges: Vec<Range<u64>> = (0..40).map(|i| 2 * i..2 * i + 2).collect();
    for range in &ranges {
        tested.enduring.add_samples(range.clone()).expect("losses are endured");
        tested.enduring.film().expect("a film");
    }
    assert!(tested.enduring.film().expect("a film") == film(&mut twin(&scene), &ranges));
    let losses = tested.losses.borrow();
    assert!(losses.len() > 2 * ENDURED, "{losses:?}");
    assert!(losses[1..].iter().all(|&losses| losses == 1), "{losses:?}");
}

/// A device that opens only after a while is waited for; one that does not is given up, with
/// what was whole.
#[test]
fn a_device_that_does_not_open_is_tried_again() {
    let scene = scene();
    for (failures, opens) in [(2, true), (usize::MAX, false)] {
        let (mut made, mut added) = (0, 0);
        let faults = Faults::new(move |_, what| {
            made += usize::from(what == Call::Make);
            added += usize::from(what == Call::Add);
            (what == Call::Make && made > 1 && made - 1 <= failures)
                || (what == Call::Add && added == 2)
        });
        let mut tested = Tested::new(&scene, faults, Mistake::None);
        let enduring = &mut tested.enduring;
        enduring.add_samples(0..3).expect("samples");
        let whole = enduring.film().expect("a film");
        let added = enduring.add_samples(3..4);
        assert_eq!(added.is_ok(), opens);
        if let Err(error) = added {
            let expected = "the device was lost and does not open again: it is busy";
            assert_eq!(error.to_string(), expected);
            assert!(enduring.last_whole().expect("it was looked at").0 == whole);
        } else {
            let range = 0..4;
            assert!(enduring.film().expect("a film") == film(&mut twin(&scene), &[range]));
        }
    }
}

/// Whoever goes on from a film goes on from it after a loss, too.
#[test]
fn a_restored_film_outlives_the_device() {
    let scene = scene();
    let before = film(&mut twin(&scene), &[2..7, 9..10]);
    let ledger = Ledger { count: before.samples().count(), ..Ledger::default() };
    let expected = film(&mut twin(&scene), &[2..7, 9..10, 7..9]);
    for first in 1..8 {
        let faults = Faults::new(move |call, _| call == first);
        let mut tested = Tested::new(&scene, faults, Mistake::None);
        let enduring = &mut tested.enduring;
        enduring.restore(&before, &ledger).expect("it fits");
        assert!(enduring.last_whole().expect("it was given").0 == before);
        enduring.add_samples(7..9).expect("samples");
        assert!(enduring.film().expect("a film") == expected, "lost at call {first}");
        assert_eq!(enduring.ledger().expect("a ledger").count, 8);
    }
}

/// What a film refuses is no loss: the error comes back, and everything is as it was.
#[test]
fn refused_samples_and_films_change_nothing() {
    let scene = scene();
    let mut tested = Tested::new(&scene, Faults::new(|_, _| false), Mistake::None);
    let other = film(&mut twin(&classic(size(3, 3))), &[]);
    let enduring = &mut tested.enduring;
    enduring.add_samples(0..3).expect("samples");
    assert!(matches!(enduring.add_samples(2..5), Err(TraceError::Film(_))));
    assert!(matches!(enduring.restore(&other, &Ledger::default()), Err(TraceError::Film(_))));
    enduring.add_samples(3..4).expect("samples");
    let range = 0..4;
    assert!(enduring.film().expect("a film") == film(&mut twin(&scene), &[range]));
    assert_eq!(tested.told(), "");
    assert_eq!(tested.losses.borrow().len(), 1);
}

/// After a loss, whole states are taken even if nobody looks: a device that lasts for some
/// seconds at a time gets ahead.
#[test]
fn whole_states_are_taken_unasked_after_a_loss() {
    let scene = scene();
    let mut added = 0;
    let faults = Faults::new(move |_, what| {
        added += usize::from(what == Call::Add);
        what == Call::Add && added == 2
    });
    let mut tested = Tested::new(&scene, faults, Mistake::None);
    let enduring = &mut tested.enduring;
    enduring.add_samples(0..3).expect("samples");
    enduring.add_samples(3..4).expect("samples");
    assert!(enduring.last_whole().is_none());
    // After the loss and before any step forward, a second after it was open again.
    sleep(Duration::from_millis(1100));
    enduring.add_samples(4..9).expect("samples");
    let (whole, ledger) = enduring.last_whole().expect("it is time");
    let range = 0..9;
    assert!(whole == film(&mut twin(&scene), &[range]));
    assert_eq!(ledger.count, 9);
}
