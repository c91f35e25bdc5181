//! The device against the `f64` twin on whole pictures, and the error against the
//! number of samples.

#![expect(clippy::cast_precision_loss, reason = "counts of samples and pixels")]
#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::estimate::{estimate, pair};
use candor::film::Film;
use candor::scene::{Estimator, Scene};
use candor::verify::{ALPHA, MAX_BIAS, judge};
use support::scenes::{
    classic, diffuse, emitter, glossy, many, room, seen, size, sphere, with_seed,
};
use support::tracers::{film, on_device, twin};

const SIDE: u32 = 48;

/// Inside a hollow diffuse sphere with two lamps of different colour and a glossy ball.
fn hollow() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 5.0, diffuse(0.7)),
        sphere([0.0, 3.0, 0.0], 1.0, emitter([6.0, 5.0, 4.0])),
        sphere([2.0, -1.0, -3.0], 0.8, emitter([1.0, 2.0, 8.0])),
        sphere([-1.5, -1.0, -2.0], 1.2, glossy(0.9, 20.0)),
    ];
    seen([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], size(SIDE, SIDE), 3, spheres)
}

/// On the floor, looking at lamps, one behind another, and at a glossy wall; the lowest
/// pixels look into the floor.
fn standing() -> Scene {
    let spheres = vec![
        sphere([0.0, -1e6, 0.0], 1e6, diffuse(0.8)),
        sphere([0.0, 4.0, -6.0], 2.0, emitter([4.0, 4.0, 4.0])),
        sphere([0.5, 2.0, -3.0], 0.5, emitter([9.0, 1.0, 1.0])),
        sphere([-1e4 - 3.0, 0.0, 0.0], 1e4, glossy(0.9, 5.0)),
        sphere([2.0, 1.0, -5.0], 1.0, diffuse(0.5)),
    ];
    seen([0.0, 0.0, 1.0], [0.0, 1.5, -4.0], size(SIDE, SIDE), 2, spheres)
}

/// Glossy surfaces alone, from a nearly uniform lobe to a near mirror.
fn gloss() -> Scene {
    let mut spheres = vec![
        sphere([0.0, 5.0, 0.0], 2.5, emitter([5.0, 5.0, 5.0])),
        sphere([0.0, -1e5 - 1.0, 0.0], 1e5, glossy(0.8, 2.0)),
    ];
    for (x, n) in [(-3.0, 0.0), (-1.0, 1.0), (1.0, 1e4), (3.0, 1e8)] {
        spheres.push(sphere([x, 0.0, 0.0], 1.0, glossy(0.95, n)));
    }
    seen([0.0, 2.0, 9.0], [0.0, 0.5, 0.0], size(SIDE, SIDE), 3, spheres)
}

/// The scenes, and how many samples each takes.
fn scenes() -> [(&'static str, Scene, u64); 6] {
    [
        ("classic", classic(size(96, 96)), 256),
        ("hollow", hollow(), 512),
        ("standing", standing(), 1024),
        ("gloss", gloss(), 1024),
        ("many", many(size(SIDE, SIDE)), 512),
        ("room", room(1e5, true).with_size(size(SIDE, SIDE)), 1024),
    ]
}

#[test]
fn the_device_shows_the_twins_picture() {
    println!(
        "{:<10}{:>6}{:>9}{:>7}{:>7}   bias of the image mean per channel, in millionths",
        "", "tiles", "image z", "worst", "rms"
    );
    for (name, scene, samples) in scenes() {
        let range = [0..samples];
        let device = film(&mut on_device(&scene), &range);
        let other = film(&mut on_device(&with_seed(&scene, 1)), &range);
        let verdict = judge(&device, &film(&mut twin(&scene), &range), &other);
        let found = &verdict.independent;
        println!(
            "{name:<10}{:>6}{:>9.2}{:>7.2}{:>7.2}   {:+.1?} ± {:.1?}",
            found.tiles,
            found.image.z,
            found.worst.z,
            found.rms_z,
            verdict.paired.bias.map(|b| 1e6 * b),
            verdict.paired.error.map(|e| 1e6 * e)
        );
        assert!(verdict.agrees(), "{name}: {verdict:?}");
    }
}

/// The other estimators, path by path: the bias of the image mean is within `verify`'s
/// limit, with an error that would show one.
#[test]
fn the_device_follows_the_twins_paths_under_every_estimator() {
    println!("bias of the image mean per channel, in millionths");
    for (name, scene, samples) in scenes() {
        for estimator in [Estimator::Cosine, Estimator::Explicit, Estimator::Mis] {
            let scene = scene.clone().with_settings(scene.settings().with_estimator(estimator));
            let range = [0..samples / 8];
            let found =
                pair(&film(&mut on_device(&scene), &range), &film(&mut twin(&scene), &range));
            println!(
                "{name:<10}{:<10}{:+.3?} ± {:.3?}",
                estimator.name(),
                found.bias.map(|b| 1e6 * b),
                found.error.map(|e| 1e6 * e)
            );
            assert!(found.is_within(MAX_BIAS, ALPHA), "{name}, {}: {found:?}", estimator.name());
        }
    }
}

const COUNTS: [u64; 6] = [4, 16, 64, 256, 1024, 4096];
/// Independent pictures of each count.
const PICTURES: u64 = 8;

/// Mean radiance of green in each pixel.
fn means(film: &Film) -> Vec<f64> {
    film.pixels().iter().map(|words| estimate(film, words).rgb[1]).collect()
}

/// A mean square error with its relative standard error. The latter is taken from the
/// scatter between pixels, which also contains that pixels differ: too large, if anything.
#[derive(Debug, Clone, Copy)]
struct SquareError {
    mean: f64,
    relative: f64,
}

/// Mean square distance of the pictures from the reference.
fn square_error(pictures: &[Vec<f64>], reference: &[f64]) -> SquareError {
    let pixel = |p: usize| {
        let off = pictures.iter().map(|picture| (picture[p] - reference[p]).powi(2));
        off.sum::<f64>() / pictures.len() as f64
    };
    let squares: Vec<f64> = (0..reference.len()).map(pixel).collect();
    let n = squares.len() as f64;
    let mean = squares.iter().sum::<f64>() / n;
    let scatter = squares.iter().map(|s| (s - mean).powi(2)).sum::<f64>() / (n - 1.0);
    SquareError { mean, relative: (scatter / n).sqrt() / mean }
}

/// Slope of log error against log count by least squares, with its standard error.
fn slope(errors: &[SquareError]) -> (f64, f64) {
    let x: Vec<f64> = COUNTS.iter().map(|&n| (n as f64).log2()).collect();
    let middle = x.iter().sum::<f64>() / x.len() as f64;
    let spread = x.iter().map(|x| (x - middle).powi(2)).sum::<f64>();
    let (mut slope, mut variance) = (0.0, 0.0);
    for (x, error) in x.iter().zip(errors) {
        let weight = (x - middle) / spread;
        // log₂ of the root of the mean square.
        slope += weight * error.mean.log2() / 2.0;
        variance += (weight * error.relative / 2.0 / std::f64::consts::LN_2).powi(2);
    }
    (slope, variance.sqrt())
}

/// Whether the slope is -1/2 within five standard errors, and these small enough to
/// mean something.
fn halves_with_four_times_the_samples(errors: &[SquareError]) -> bool {
    let (slope, error) = slope(errors);
    (slope + 0.5).abs() <= 5.0 * error && error <= 0.01
}

#[test]
fn the_error_falls_with_the_root_of_the_samples() {
    let scene = classic(size(24, 24));
    // From the f64 twin and with another seed: a bias of the device would stay.
    let reference = film(&mut twin(&with_seed(&scene, 1)), &[0..1 << 14]);
    let mut own = 0.0;
    for words in reference.pixels() {
        // Green and luminance vary alike here; their variances differ by a few percent.
        own += estimate(&reference, words).variance / f64::from(1 << 14) / 576.0;
    }
    let reference = means(&reference);
    let (mut errors, mut next) = (Vec::new(), 0);
    for count in COUNTS {
        let mut picture = |_| {
            let range = next..next + count;
            next = range.end;
            means(&film(&mut on_device(&scene), std::slice::from_ref(&range)))
        };
        let pictures: Vec<Vec<f64>> = (0..PICTURES).map(&mut picture).collect();
        let found = square_error(&pictures, &reference);
        let error = SquareError { mean: found.mean - own, ..found };
        println!(
            "{count:>5} samples: RMS error {:.5} ± {:.1} %",
            error.mean.sqrt(),
            50.0 * error.relative
        );
        errors.push(error);
    }
    let (slope, error) = slope(&errors);
    println!("slope {slope:.4} ± {error:.4}");
    assert!(halves_with_four_times_the_samples(&errors), "slope {slope} ± {error}");
    // A bias of twice the last error is seen.
    let floor = 4.0 * errors[5].mean;
    let biased: Vec<_> =
        errors.iter().map(|e| SquareError { mean: e.mean + floor, ..*e }).collect();
    assert!(!halves_with_four_times_the_samples(&biased));
}
