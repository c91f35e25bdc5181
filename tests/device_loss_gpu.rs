//! Real devices that are destroyed in the middle of work, or do not end it in time: the same
//! bits as those that are left alone.

mod support {
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::enduring::Enduring;
use candor::gpu::{Gpu, GpuTracer};
use candor::scene::Scene;
use candor::tracer::{Ledger, TraceError, Tracer};
use std::cell::{Cell, RefCell};
use std::ops::Range;
use std::rc::Rc;
use std::sync::Barrier;
use std::thread::{scope, sleep};
use std::time::Duration;
use support::scenes::{classic, size};
use support::tracers::{film, on_device};

/// A picture whose samples take a while on any processor.
fn scene() -> Scene {
    classic(size(320, 240))
}

/// An enduring tracer on devices that `open` opens, for so many losses in a row; the device that
/// is open, and how many losses were told.
struct Tested<'a> {
    enduring: Enduring<'a>,
    device: Rc<RefCell<Option<wgpu::Device>>>,
    losses: Rc<Cell<u32>>,
}

fn enduring<'a>(scene: &'a Scene, open: impl Fn(u32) -> Gpu + 'a) -> Tested<'a> {
    let (device, losses) = (Rc::new(RefCell::new(None)), Rc::new(Cell::new(0)));
    let (opened, told) = (Rc::clone(&device), Rc::clone(&losses));
    let enduring = Enduring::new(
        Box::new(move |losses| {
            let gpu = open(losses);
            *opened.borrow_mut() = Some(gpu.device().clone());
            Ok(Box::new(GpuTracer::new(scene, gpu)?.paced_for(losses)))
        }),
        Box::new(move |text| {
            told.set(told.get() + u32::from(text.starts_with("the device was lost (")));
        }),
    );
    Tested { enduring: enduring.expect("the device takes the scene"), device, losses }
}

/// Each device is destroyed by another thread while samples are traced, or before, or after:
/// which of these it is chance decides, and the film does not depend on it.
#[test]
fn devices_that_are_destroyed_while_they_trace_change_no_bit() {
    let scene = scene();
    let ranges: Vec<Range<u64>> = (0..12).map(|i| 8 * i..8 * i + 8).collect();
    let expected = film(&mut on_device(&scene), &ranges);
    let mut tested = enduring(&scene, |_| support::gpu::open());
    for (range, delay) in ranges.iter().zip(0..) {
        let device = tested.device.borrow().clone().expect("a device is open");
        let start = Barrier::new(2);
        scope(|threads| {
            threads.spawn(|| {
                start.wait();
                sleep(Duration::from_millis(3 * delay));
                device.destroy();
            });
            start.wait();
            tested.enduring.add_samples(range.clone()).expect("losses are endured");
        });
        // So far as it goes: a device that was destroyed afterwards is found out here.
        let part = tested.enduring.film().expect("losses are endured");
        assert_eq!(part.samples().count(), range.end);
    }
    let found = tested.enduring.film().expect("a film");
    assert!(found == expected, "another film");
    assert_eq!(tested.enduring.ledger().expect("a ledger"), Ledger::default());
    assert_eq!(tested.losses.get(), 12);
    // The judge sees a range that is missing.
    assert!(found != film(&mut on_device(&scene), &ranges[1..]));
}

/// A dispatch that takes longer than is waited for is a loss; the device still works on it while
/// another one is open. That one is waited for as long as it takes.
#[test]
fn dispatches_that_take_too_long_are_losses() {
    let scene = scene();
    let range = 0..16;
    let expected = film(&mut on_device(&scene), std::slice::from_ref(&range));
    let mut tested = enduring(&scene, |losses| match losses {
        0 | 1 => support::gpu::open().with_patience(Duration::from_nanos(1)),
        _ => support::gpu::open(),
    });
    tested.enduring.add_samples(range).expect("losses are endured");
    assert!(tested.enduring.film().expect("a film") == expected);
    assert_eq!(tested.losses.get(), 2);
}

/// Smaller dispatches make the same film.
#[test]
fn the_pace_changes_no_bit() {
    let scene = scene();
    let range = 0..4;
    let expected = film(&mut on_device(&scene), std::slice::from_ref(&range));
    for losses in [1, 5] {
        let mut slower = on_device(&scene).paced_for(losses);
        assert!(film(&mut slower, std::slice::from_ref(&range)) == expected);
    }
}

type Question<'a> = &'a dyn Fn(&mut GpuTracer) -> Result<(), TraceError>;

/// Whatever is asked of a device that is gone, the answer is that it was lost, and it stays so.
#[test]
fn everything_says_that_the_device_is_lost() {
    let scene = scene();
    let film = film(&mut on_device(&scene), &[]);
    let is_lost = |answer: Result<(), TraceError>| match answer {
        Err(TraceError::DeviceLost(reason)) => assert_eq!(reason, "it was destroyed"),
        answer => panic!("{answer:?}"),
    };
    let questions: [Question; 4] = [
        &|tracer| tracer.add_samples(0..1),
        &|tracer| tracer.film().map(drop),
        &|tracer| tracer.ledger().map(drop),
        &|tracer| tracer.restore(&film, &Ledger::default()),
    ];
    for first in questions {
        let gpu = support::gpu::open();
        let device = gpu.device().clone();
        let mut tracer = GpuTracer::new(&scene, gpu).expect("the device takes the scene");
        device.destroy();
        is_lost(first(&mut tracer));
        for again in questions {
            is_lost(again(&mut tracer));
        }
    }
    let gpu = support::gpu::open();
    gpu.device().destroy();
    is_lost(GpuTracer::new(&scene, gpu).map(drop));
}
