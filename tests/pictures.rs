//! Comparisons of stored pictures: the same test as for films, and deviations that are
//! distributed as they should be.

#![expect(clippy::cast_precision_loss, reason = "counts become statistics")]

mod support {
    pub mod films;
}

use candor::estimate::{
    Bars, Comparison, MapUnit, Measured, compare, compare_pictures, difference, difference_map,
};
use candor::film::Film;
use candor::report::Picture;
use candor::scene::ImageSize;
use support::films::{Uniform, film, hits};

/// Relative rounding of `f32`.
const SINGLE: f64 = 1.0 / 16_777_216.0;

/// Pairs of pictures in each test of a distribution.
const PAIRS: u32 = 200;

/// Samples per pixel of synthetic films.
const SPP: u64 = 64;

fn measured(picture: &Picture, samples: u64) -> Measured<'_> {
    let bars = Bars { luminance_error: &picture.luminance_error, samples };
    Measured { size: picture.size, rgb: &picture.rgb, bars: Some(bars), rounding: SINGLE }
}

/// Hits with probability 0.1 to 0.22 and any brightness up to 8. The mean square of such a
/// brightness is 4/3 of its squared mean, so a tile of 256 pixels has 256·64·0.16·3/4, some
/// 1950, effective hits, and its mean a relative standard error of 2.1 %.
fn noise(seed: u64, rows: u32) -> Picture {
    let mut random = Uniform(seed);
    let film = film(64, rows, SPP, |pixel, _| {
        let hit = random.next() < 0.1 + 0.02 * f64::from(pixel % 7);
        #[expect(clippy::cast_possible_truncation, reason = "any brightness will do")]
        let brightness = 8.0 * random.next() as f32;
        [if hit { brightness } else { 0.0 }; 3]
    });
    Picture::develop(&film, false)
}

/// The true means of [`noise`]: half of 8 times the probability.
fn truth(rows: u16) -> Vec<[f32; 3]> {
    (0..64 * rows).map(|pixel| [4.0 * (0.1 + 0.02 * f32::from(pixel % 7)); 3]).collect()
}

/// Largest distance of the distribution of `values` from the uniform one on [0, 1]
/// (Kolmogorov).
fn distance_from_uniform(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len() as f64;
    let steps = values.iter().enumerate().map(|(i, &p)| {
        let (before, after) = (i as f64 / n, (i + 1) as f64 / n);
        f64::max(p - before, after - p)
    });
    steps.fold(0.0, f64::max)
}

/// A distance that uniform values exceed with probability 1e-6: 2·exp(-2nd²) bounds it for
/// every n (Massart 1990).
fn limit() -> f64 {
    ((2.0_f64 / 1e-6).ln() / (2.0 * f64::from(PAIRS))).sqrt()
}

/// The three p-values of each pair, by kind.
fn p_values(pairs: impl Iterator<Item = Comparison>) -> [Vec<f64>; 3] {
    let all: Vec<[f64; 3]> = pairs
        .map(|found| {
            assert!(found.conclusive && found.tiles > 3, "{found:?}");
            [found.image.p, found.worst_tile_p(), found.all_tiles_p()]
        })
        .collect();
    std::array::from_fn(|kind| all.iter().map(|p| p[kind]).collect())
}

/// The noise of independent pictures gives uniform p-values, of each of the three kinds.
/// The injected faults: error bars that are half or twice as long as they should be.
#[test]
fn p_values_of_equal_pictures_are_uniform() {
    let pictures: Vec<Picture> = (0..2 * u64::from(PAIRS)).map(|seed| noise(seed, 32)).collect();
    let with_bars = |factor: f32| {
        let pictures: Vec<Picture> = pictures
            .iter()
            .cloned()
            .map(|mut picture| {
                picture.luminance_error.iter_mut().for_each(|error| *error *= factor);
                picture
            })
            .collect();
        p_values(
            pictures
                .chunks(2)
                .map(|pair| compare_pictures(&measured(&pair[0], SPP), &measured(&pair[1], SPP))),
        )
    };
    for (kind, values) in with_bars(1.0).into_iter().enumerate() {
        let distance = distance_from_uniform(values);
        assert!(distance < limit(), "kind {kind}: {distance}");
    }
    for factor in [0.5, 2.0] {
        for (kind, values) in with_bars(factor).into_iter().enumerate() {
            let distance = distance_from_uniform(values);
            assert!(distance > limit(), "{factor}, kind {kind}: {distance}");
        }
    }
}

/// Against the exact means, the error is that of one picture alone. The injected fault: an
/// exact picture that is 2 % too bright, 2.7 standard errors of eight tiles.
#[test]
fn a_picture_without_bars_is_taken_as_exact() {
    let size = ImageSize::new(64, 32).expect("a size");
    let against = |factor: f32| {
        let rgb: Vec<[f32; 3]> = truth(32).iter().map(|rgb| rgb.map(|x| factor * x)).collect();
        let exact = Measured { size, rgb: &rgb, bars: None, rounding: SINGLE };
        p_values(
            (0..u64::from(PAIRS))
                .map(|seed| compare_pictures(&measured(&noise(1000 + seed, 32), SPP), &exact)),
        )
    };
    for (kind, values) in against(1.0).into_iter().enumerate() {
        let distance = distance_from_uniform(values);
        assert!(distance < limit(), "kind {kind}: {distance}");
    }
    let [image, ..] = against(1.02);
    let distance = distance_from_uniform(image);
    assert!(distance > limit(), "{distance}");
}

/// Two estimators of one mean, 0.004: hits of 8 in 1 of 2000 samples, 16 of each pixel, two in a tile,
/// and in each of 64 the mean itself, with some noise.
fn rare_and_steady(seed: u64) -> [Film; 2] {
    let mut random = Uniform(seed + 1000);
    let steady = film(32, 32, 64, |_, _| {
        #[expect(clippy::cast_possible_truncation, reason = "any noise will do")]
        let noise = random.next() as f32;
        [0.008 * noise; 3]
    });
    [hits(seed, 32, 16, |_| 0.0005), steady]
}

/// A picture of few hits is mostly too dark and too sure of it. Beside one of another
/// estimator it must not count as different; the rule for films of one estimator, where hits
/// on one side suffice, is taken in.
#[test]
fn few_hits_beside_many_are_no_difference() {
    let mut taken_in = 0;
    for seed in 0..60 {
        let films = rare_and_steady(seed);
        let [rare, steady] = [&films[0], &films[1]].map(|film| Picture::develop(film, false));
        let found = compare_pictures(&measured(&rare, 16), &measured(&steady, 64));
        assert!(!found.conclusive || !found.disagrees(1e-3), "seed {seed}: {found:?}");
        taken_in += u32::from(compare(&films[0], &films[1]).disagrees(1e-3));
    }
    assert!(taken_in > 6, "{taken_in} of 60");
}

/// A picture keeps all of its film that the test needs: tiles, hits and deviations are the
/// same but for the rounding of means and errors to `f32` (6e-8 each; z is the difference of
/// two sums some hundred times as large as it). Some pixels are without hits. Tiles and pools
/// have hits enough on both sides or on neither, five standard errors from the limit: 393 in
/// those of the first column, 1232 and more in the others.
#[test]
fn a_picture_is_tested_like_its_film() {
    let film = |seed| hits(seed, 96, 64, |pixel| 0.0032 * f64::from(pixel % 96));
    let films: [Film; 2] = [film(1), film(2)];
    let pictures = films.each_ref().map(|film| Picture::develop(film, false));
    assert!(pictures[0].luminance_error.iter().any(|error| error.is_infinite()));
    let from_films = compare(&films[0], &films[1]);
    let from_pictures = compare_pictures(&measured(&pictures[0], 64), &measured(&pictures[1], 64));
    assert!(from_films.tiles < 36 && from_films.tiles == from_pictures.tiles, "some are pooled");
    let deviations = |found: &Comparison| [found.image.z, found.worst.z, found.mean_z, found.rms_z];
    for (a, b) in std::iter::zip(deviations(&from_films), deviations(&from_pictures)) {
        assert!((a - b).abs() < 1e-4, "{from_films:?} {from_pictures:?}");
    }
}

/// Differences of either sign everywhere: 5 % of a tile's mean, 1.6 standard errors of its
/// difference. Neither the image nor a single tile shows them; 32 tiles together do.
#[test]
fn all_tiles_together_find_what_no_single_one_shows() {
    let (mut tinted, plain) = (noise(1, 128), noise(2, 128));
    let found = compare_pictures(&measured(&tinted, SPP), &measured(&plain, SPP));
    assert!(found.tiles == 32 && !found.disagrees(1e-3), "{found:?}");
    for (i, rgb) in tinted.rgb.iter_mut().enumerate() {
        let checker = (i % 64 / 16 + i / 64 / 16) % 2 == 0;
        *rgb = rgb.map(|x| if checker { 1.05 * x } else { 0.95 * x });
    }
    let found = compare_pictures(&measured(&tinted, SPP), &measured(&plain, SPP));
    let [image, worst] = [found.image.p, found.worst_tile_p()];
    assert!(image > 1e-3 && worst > 1e-3 && found.disagrees(1e-3), "{found:?}");
}

/// A reference in half floats may be off by 2⁻¹¹ of each value, and here it is, everywhere:
/// 4.9 standard errors of a picture whose tile is known to 1e-4.
#[test]
fn the_rounding_of_half_floats_is_granted() {
    let size = ImageSize::new(16, 16).expect("a size");
    let exact = vec![[1.0; 3]; 256];
    let shifted = vec![[1.0 - 1.0 / 2048.0; 3]; 256];
    // √256 times the error of the tile's mean; there are hits enough.
    let error = vec![16.0 * 1e-4; 256];
    let bars = Some(Bars { luminance_error: &error, samples: 1 << 20 });
    let ours = Measured { size, rgb: &shifted, bars, rounding: SINGLE };
    let reference = |rounding| Measured { size, rgb: &exact, bars: None, rounding };
    let strict = compare_pictures(&ours, &reference(SINGLE));
    assert!((strict.image.z + 4.88).abs() < 0.01 && strict.disagrees(1e-3), "{strict:?}");
    let granted = compare_pictures(&ours, &reference(1.0 / 2048.0));
    assert!(granted.conclusive && !granted.disagrees(1e-3), "{granted:?}");
}

/// Two pixels by hand: differences 0.3 and -0.1 of grey, b's mean 0.75.
#[test]
fn differences_of_two_pixels() {
    let size = ImageSize::new(2, 1).expect("a size");
    let (a, b) = ([[1.3; 3], [0.4; 3]], [[1.0; 3], [0.5; 3]]);
    let error = [0.1, f32::INFINITY];
    let bars = Some(Bars { luminance_error: &error, samples: 4 });
    let a = Measured { size, rgb: &a, bars, rounding: SINGLE };
    let b = Measured { size, rgb: &b, bars: None, rounding: SINGLE };
    let found = difference(&a, &b);
    let floor = 0.01 * 0.75 * 0.75;
    let table = [
        (found.luminance[0], 0.85),
        (found.luminance[1], 0.75),
        (found.rmse, f64::sqrt(0.05)),
        (found.channel_rmse, f64::sqrt(0.05)),
        (found.expected_rmse.expect("a has bars"), f64::sqrt(0.01 / 2.0)),
        (found.relative_mse.expect("b has light"), 0.045 / (1.0 + floor) + 0.005 / (0.25 + floor)),
    ];
    for (i, (value, expected)) in table.into_iter().enumerate() {
        // From f32: 6e-8 of 1.3, in a difference of 0.1.
        assert!((value / expected - 1.0).abs() < 3e-6, "{i}: {value} for {expected}");
    }
    let dark = Measured { rgb: &[[0.0; 3]; 2], ..b };
    assert_eq!(difference(&a, &dark).relative_mse, None);
    assert_eq!(difference(&b, &dark).expected_rmse, None);
}

/// The error bars foretell the RMSE: over 4096 pixels its square has a relative standard
/// error of about √(5/4096) = 3.5 % (a pixel's difference has a kurtosis below 6); the
/// bound is five of those, halved by the root.
#[test]
fn the_expected_rmse_is_the_one_found() {
    let (a, b) = (noise(11, 64), noise(12, 64));
    let found = difference(&measured(&a, SPP), &measured(&b, SPP));
    let expected = found.expected_rmse.expect("both have bars");
    assert!((found.rmse / expected - 1.0).abs() < 0.09, "{found:?}");
}

/// Blocks grow until they have some hundred hits, and say how far apart the pictures are.
#[test]
fn the_map_is_as_fine_as_the_hits_allow() {
    // 64 samples with p = 0.5 are 32 hits, of brightness 8: blocks of 2×2 pixels.
    let map = |seed: u64, p: f64| {
        let pictures = [seed, seed + 1].map(|seed| {
            Picture::develop(&hits(seed, 32, 64, |pixel| if pixel < 512 { p } else { 0.0 }), false)
        });
        difference_map(&measured(&pictures[0], 64), &measured(&pictures[1], 64))
    };
    let fine = map(1, 0.9);
    assert_eq!((fine.block, fine.values.len(), fine.unit), (2, 256, MapUnit::StandardErrors));
    let coarse = map(3, 0.01);
    assert_eq!((coarse.block, coarse.values.len()), (16, 4));
    // The lower half has no hit in either picture: nothing is known of it.
    assert!(fine.values[..128].iter().all(|z| z.abs() < 6.0), "normal deviates");
    assert!(fine.values[128..].iter().all(|z| z.is_nan()));
}

/// Without any bars the map is relative: 0.3 of 1.0, 0.1 of 0.5, each with ε beside.
#[test]
fn the_map_without_bars_is_relative() {
    let size = ImageSize::new(2, 1).expect("a size");
    let (a, b) = ([[1.3; 3], [0.4; 3]], [[1.0; 3], [0.5; 3]]);
    let exact = |rgb| Measured { size, rgb, bars: None, rounding: SINGLE };
    let map = difference_map(&exact(&a), &exact(&b));
    assert_eq!((map.block, map.unit), (1, MapUnit::Tenths));
    let floor = 0.01 * 0.75 * 0.75;
    let expected = [3.0 / f64::sqrt(1.0 + floor), -1.0 / f64::sqrt(0.25 + floor)];
    for (value, expected) in std::iter::zip(map.values, expected) {
        assert!((f64::from(value) / expected - 1.0).abs() < 1e-5, "{value} for {expected}");
    }
    let black = difference_map(&exact(&[[0.0; 3]; 2]), &exact(&[[0.0; 3]; 2]));
    assert!(black.values.iter().all(|&value| value == 0.0), "equal, though nothing to divide by");
}
