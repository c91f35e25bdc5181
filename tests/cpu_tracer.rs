//! The twin as a tracer: the same bits however the work is divided.

use candor::cpu::{CpuTracer, PreparedScene, SampleKey, trace};
use candor::film::{Film, FilmError, PixelSums, RangeError, WORDS};
use candor::scene::{ImageSize, Scene, load};
use candor::tracer::{TraceError, Tracer};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::path::Path;

/// The classic scene, small.
fn scene() -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml");
    let size = ImageSize::new(37, 23).expect("a size");
    load(&path).expect("a valid scene").with_size(size)
}

fn tracer(scene: &Scene, threads: usize) -> CpuTracer {
    CpuTracer::new(scene, NonZeroUsize::new(threads)).expect("threads")
}

fn film(scene: &Scene, threads: usize, ranges: &[Range<u64>]) -> Film {
    let mut tracer = tracer(scene, threads);
    for range in ranges {
        tracer.add_samples(range.clone()).expect("samples");
    }
    assert_eq!(tracer.ledger().expect("a ledger").count, 0);
    tracer.film().expect("a film")
}

#[test]
#[expect(clippy::single_range_in_vec_init, reason = "one way of dividing the work")]
fn films_do_not_depend_on_threads_or_ranges() {
    let scene = scene();
    let whole = film(&scene, 1, &[0..24]);
    assert!(whole.pixels().iter().flatten().any(|&word| word > 0));
    assert_eq!(whole, film(&scene, 3, &[0..24]));
    assert_eq!(whole, film(&scene, 2, &[17..24, 0..5, 5..17]));
    let mut merged = film(&scene, 1, &[8..24]);
    merged.merge(&film(&scene, 2, &[0..8])).expect("disjoint samples");
    assert_eq!(whole, merged);
}

#[test]
#[expect(clippy::single_range_in_vec_init, reason = "one way of dividing the work")]
fn one_pixel_is_the_sum_of_its_replayed_samples() {
    let scene = scene();
    let film = film(&scene, 2, &[0..64]);
    let prepared = PreparedScene::new(&scene);
    for pixel in [0, 425, 850] {
        let mut sums = PixelSums::of(&[0; WORDS]);
        for index in 0..64 {
            let radiance = trace(&prepared, SampleKey { pixel, index });
            sums.add(radiance.as_vec3().to_array(), film.scale());
        }
        assert_eq!(sums.words(), film.pixels()[pixel as usize]);
    }
}

#[test]
fn samples_are_not_counted_twice() {
    let mut tracer = tracer(&scene(), 2);
    tracer.add_samples(0..4).expect("samples");
    let before = tracer.film().expect("a film");
    let refused = tracer.add_samples(3..6);
    assert!(matches!(refused, Err(TraceError::Film(FilmError::Range(RangeError::Overlap(_))))));
    assert_eq!(before, tracer.film().expect("a film"));
}

#[test]
fn the_twin_says_what_it_is() {
    let description = tracer(&scene(), 2).describe();
    assert_eq!(description.device, "CPU twin (f64, 2 threads)");
    assert_eq!(description.driver, format!("candor {}", env!("CARGO_PKG_VERSION")));
    assert!(description.software);
    assert_eq!(tracer(&scene(), 1).describe().device, "CPU twin (f64, 1 thread)");
}
