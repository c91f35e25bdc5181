//! Small pictures whose truth is known, and many renders of them with seeds of their own.

#![allow(dead_code, reason = "each test uses some of them")]

use super::closed_form::integrating_sphere;
use super::scenes::{diffuse, emitter, glossy, seen, size, sphere, with_seed};
use candor::cpu::CpuTracer;
use candor::estimate::estimate;
use candor::film::Film;
use candor::scene::{Estimator, Scene};
use candor::tracer::Tracer;
use std::num::NonZeroUsize;
use std::sync::atomic::{AtomicU32, Ordering};
use std::thread::available_parallelism;

/// A picture whose pixels are known.
pub struct Known {
    pub name: &'static str,
    pub scene: Scene,
    /// True mean luminance of each pixel.
    pub truth: Vec<f64>,
    /// Variance of that, where it is itself an estimate.
    pub variance: Vec<f64>,
}

impl Known {
    /// Mean luminance of the whole picture.
    pub fn mean(&self) -> f64 {
        mean(&self.truth)
    }
}

/// Inside a hollow diffuse sphere around a lamp, which is not in view: every pixel has the
/// same radiance, in closed form.
pub fn hollow() -> Known {
    let (albedo, fraction, radiance) = (0.8, 0.4, 1.0);
    let spheres = vec![
        sphere([0.0; 3], 4.0, diffuse(albedo)),
        sphere([0.0; 3], 4.0 * f64::sqrt(fraction), emitter([radiance; 3])),
    ];
    let scene = seen([3.0, 0.0, 0.0], [9.0, 0.0, 0.0], size(8, 6), 2, spheres);
    let truth = vec![radiance * integrating_sphere(albedo, fraction, 2); 48];
    Known { name: "hollow sphere", scene, variance: vec![0.0; 48], truth }
}

/// Chalk and gloss on a floor under a lamp that is in view, before a dim sky: bright
/// pixels, dim ones, and those on the lamp's edge.
pub fn still_life() -> Known {
    let spheres = vec![
        sphere([0.0; 3], 500.0, emitter([0.02; 3])),
        sphere([0.0, -100.0, 0.0], 100.0, diffuse(0.6)),
        sphere([0.0, 3.4, -1.0], 1.6, emitter([2.0; 3])),
        sphere([-1.3, 1.0, 0.0], 1.0, diffuse(0.8)),
        sphere([1.3, 1.0, 0.5], 1.0, glossy(0.8, 20.0)),
    ];
    let scene = seen([0.0, 1.8, 7.0], [0.0, 1.5, 0.0], size(12, 9), 2, spheres);
    estimated("still life", scene, 1 << 17)
}

/// A large dim lamp in view, hardly with any noise, beside a wall that a small bright lamp
/// lights. Few of the wall's samples meet that one, and who has met it not even once sees a
/// clean picture that lacks most of its light.
pub fn tiny_lamp() -> Known {
    let spheres = vec![
        sphere([0.0, 0.0, -1003.0], 1000.0, diffuse(0.8)),
        sphere([-2.0, 0.0, -1.0], 2.0, emitter([0.15; 3])),
        // Out of view, above.
        sphere([1.5, 2.9, 1.5], 0.6, emitter([50.0; 3])),
    ];
    let scene = seen([0.0, 0.0, 5.0], [0.0, 0.0, 0.0], size(8, 6), 1, spheres);
    estimated("tiny lamp", scene, 1 << 17)
}

/// With the truth from `samples` samples of another estimator, another seed.
fn estimated(name: &'static str, scene: Scene, samples: u64) -> Known {
    let settings = scene.settings().with_estimator(Estimator::Mis).with_seed(u32::MAX);
    let film = trace(&scene.clone().with_settings(settings), 0, samples, None);
    let pixels = || film.pixels().iter().map(|words| estimate(&film, words));
    let truth = pixels().map(|pixel| pixel.luminance).collect();
    let variance = pixels().map(|pixel| pixel.standard_error(samples).powi(2)).collect();
    Known { name, scene, truth, variance }
}

/// The film of the samples from `first` on.
pub fn trace(scene: &Scene, first: u64, count: u64, threads: Option<NonZeroUsize>) -> Film {
    let mut tracer = CpuTracer::new(scene, threads).expect("threads");
    tracer.add_samples(first..first + count).expect("the twin traces");
    assert_eq!(tracer.ledger().expect("a ledger").count, 0);
    tracer.film().expect("a film")
}

/// What `of` makes of the scene with each of `seeds` seeds, in order.
pub fn per_seed<T: Send>(scene: &Scene, seeds: u32, of: impl Fn(&Scene) -> T + Sync) -> Vec<T> {
    let next = AtomicU32::new(0);
    let work = || {
        let mut made = Vec::new();
        loop {
            let seed = next.fetch_add(1, Ordering::Relaxed);
            if seed >= seeds {
                return made;
            }
            made.push((seed, of(&with_seed(scene, seed))));
        }
    };
    let mut all: Vec<(u32, T)> = std::thread::scope(|scope| {
        let threads = available_parallelism().map_or(1, NonZeroUsize::get);
        let workers: Vec<_> = (0..threads).map(|_| scope.spawn(work)).collect();
        workers.into_iter().flat_map(|worker| worker.join().expect("no panic")).collect()
    });
    all.sort_by_key(|(seed, _)| *seed);
    all.into_iter().map(|(_, made)| made).collect()
}

#[expect(clippy::cast_precision_loss, reason = "a count of pixels")]
pub fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}
