//! Which estimator a pilot takes, and that it is not taken in by light that was not found.

mod support {
    pub mod scenes;
}

use candor::cpu::CpuTracer;
use candor::estimate::{Summary, summarize};
use candor::film::Film;
use candor::pilot::{Trial, cheapest, darker, trial_size, try_out};
use candor::scene::{Estimator, Scene};
use candor::tracer::{Description, Ledger, TraceError, Tracer};
use std::ops::Range;
use std::sync::atomic::AtomicBool;
use support::scenes::{classic, diffuse, emitter, seen, size, sphere};

fn tracers(scene: &Scene) -> Vec<(Estimator, Box<dyn Tracer>)> {
    let tracer = |estimator| {
        let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
        let twin = CpuTracer::new(&scene, None).expect("threads");
        (estimator, Box::new(twin) as Box<dyn Tracer>)
    };
    Estimator::ALL.map(tracer).into()
}

fn trials(scene: &Scene) -> Vec<Trial> {
    try_out(&mut tracers(scene), &AtomicBool::new(false)).expect("the twin traces")
}

/// A faint lamp that fills a quarter of the picture, and a bright one so small that one path in
/// ten million hits it by itself.
fn speck() -> Scene {
    let spheres = vec![
        sphere([0.0, -1e4, 0.0], 1e4, diffuse(0.8)),
        sphere([0.0, 2.0, -4.0], 1.5, emitter([0.01; 3])),
        sphere([1.0, 2.0, 0.0], 1e-3, emitter([1e6; 3])),
    ];
    seen([0.0, 1.5, 5.0], [0.0, 1.0, 0.0], size(24, 24), 1, spheres)
}

/// On the classic scene light sampling has a twentieth of the variance at about twice the
/// time per sample: no noise of a clock turns that around.
#[test]
fn light_sampling_is_cheapest_on_the_classic_scene() {
    let found = cheapest(&trials(&classic(size(64, 64))));
    assert!(matches!(found, Some(Estimator::Explicit | Estimator::Mis)), "{found:?}");
}

/// Without having hit the lamp, `implicit` sees a faint picture with hardly any noise. By
/// variance × time of what it saw it would be taken; that its picture is darker says otherwise.
#[test]
fn light_that_was_not_found_is_not_taken_for_quiet() {
    let trials = trials(&speck());
    for trial in &trials {
        println!("{trial:?}");
    }
    assert_eq!(darker(&trials), [Estimator::Implicit, Estimator::Cosine]);
    let chosen = cheapest(&trials).expect("some trial has found light");
    assert!(chosen.samples_lights(), "{chosen:?}");
    let of = |estimator| trials.iter().find(|t| t.estimator == estimator).expect("all were tried");
    let variance = |estimator| of(estimator).variance.expect("light was found");
    assert!(10.0 * variance(Estimator::Cosine) < variance(chosen), "naively taken");
}

/// A tracer of black pictures.
struct Dark(Film);

impl Tracer for Dark {
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError> {
        Ok(self.0.claim(range)?)
    }

    fn restore(&mut self, film: &Film, _: &Ledger) -> Result<(), TraceError> {
        self.0 = film.clone();
        Ok(())
    }

    fn film(&mut self) -> Result<Film, TraceError> {
        Ok(self.0.clone())
    }

    fn ledger(&mut self) -> Result<Ledger, TraceError> {
        Ok(Ledger::default())
    }

    fn describe(&self) -> Description {
        Description { device: "dark".to_owned(), driver: String::new(), software: true }
    }
}

/// A trial that has found no light has no variance, however often it looked.
#[test]
fn black_trials_are_never_taken() {
    let scene = classic(size(8, 8));
    let film = Film::new(scene.size(), candor::bound::sample_scale(&scene));
    let mut tracers = tracers(&scene);
    tracers.truncate(1);
    tracers.push((Estimator::Cosine, Box::new(Dark(film.clone()))));
    let trials = try_out(&mut tracers, &AtomicBool::new(false)).expect("both trace");
    assert_eq!(trials[1].variance, None);
    assert_eq!(cheapest(&trials), Some(Estimator::Implicit));
    assert_eq!(cheapest(&trials[1..]), None);
    let Summary { relative_error, .. } = summarize(&film);
    assert_eq!(relative_error, None);
}

#[test]
fn trials_are_small_and_keep_the_shape() {
    let table = [
        ((512, 512), (256, 256)),
        ((64, 48), (64, 48)),
        ((8192, 2048), (512, 128)),
        ((65_535, 1), (65_535, 1)),
        ((60_000, 60_000), (256, 256)),
    ];
    for ((width, height), (to_width, to_height)) in table {
        assert_eq!(trial_size(size(width, height)), size(to_width, to_height));
    }
}
