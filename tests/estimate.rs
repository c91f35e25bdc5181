//! Means, error bars and comparisons against hand-made films and known statistics.

mod support {
    pub mod films;
}

use candor::estimate::{compare, estimate, p_value, pair, summarize, z_limit};
use candor::film::SampleScale;
use support::films::{Uniform, film, hits};

/// Samples 1, 2, 3, 6 of grey: mean 3, variance 14/3, by hand; the film's step of
/// 2^-57 is far below the tolerance.
#[test]
fn mean_and_variance_are_those_of_the_samples() {
    let film = film(1, 1, 4, |_, i| [[1.0, 2.0, 3.0, 6.0][usize::try_from(i).expect("four")]; 3]);
    let pixel = estimate(&film, &film.pixels()[0]);
    assert!(pixel.rgb.iter().all(|c| (c - 3.0).abs() < 1e-14), "{pixel:?}");
    assert!((pixel.luminance - 3.0).abs() < 1e-14, "{pixel:?}");
    assert!((pixel.variance - 14.0 / 3.0).abs() < 1e-12, "{pixel:?}");
    assert!((pixel.standard_error(4) - (14.0_f64 / 12.0).sqrt()).abs() < 1e-12);
    assert!((pixel.hits(4) - 144.0 / 50.0).abs() < 1e-12, "(1+2+3+6)²/(1+4+9+36): {pixel:?}");
}

/// Whatever its value and channels, a constant has variance exactly 0.
#[test]
fn a_constant_has_no_variance() {
    let mut random = Uniform(1);
    for n in [2, 3, 1000] {
        for _ in 0..200 {
            let exponent = -30.0 + 36.0 * random.next();
            #[expect(clippy::cast_possible_truncation, reason = "any f32 will do")]
            let rgb = [(); 3].map(|()| (random.next() * exponent.exp2()).min(64.0) as f32);
            let film = film(1, 1, n, |_, _| rgb);
            let variance = estimate(&film, &film.pixels()[0]).variance;
            assert_eq!(variance.to_bits(), 0.0_f64.to_bits(), "{rgb:?} {n} times");
        }
    }
}

#[test]
fn pixels_without_hits_are_unproven_and_two_samples_are_needed() {
    let dark = film(2, 1, 8, |pixel, i| [if pixel == 0 && i == 3 { 1.0 } else { 0.0 }; 3]);
    let summary = summarize(&dark);
    assert_eq!((summary.unproven_pixels, summary.coarse_pixels), (1, 0));
    assert!(summary.relative_error.is_some_and(|e| e > 0.0));
    assert_eq!(summarize(&film(1, 1, 1, |_, _| [1.0; 3])).relative_error, None);
    assert_eq!(summarize(&film(4, 4, 8, |_, _| [0.0; 3])).relative_error, None);
}

/// Bernoulli(p) of brightness 8: σ²/n relative to the mean is (1-p)/(pn), so ε is its
/// root. The estimate over 64² pixels of 64 samples has a relative standard error of
/// about √((1/p)/(4·64·4096)) = 0.4 %; the bound is six of those.
#[test]
fn the_relative_error_is_that_of_bernoulli_hits() {
    let p = 0.0625;
    let summary = summarize(&hits(2, 64, 64, |_| p));
    let expected = ((1.0 - p) / (p * 64.0)).sqrt();
    let found = summary.relative_error.expect("a lit picture");
    assert!((found / expected - 1.0).abs() < 0.024, "{found} for {expected}");
}

/// Hits of 2¹⁵ film steps, whose square leaves nothing in the sums: the error that is
/// stated must not be smaller than the true one, √((1-p)/(pn)).
#[test]
fn what_truncation_hides_is_charged() {
    let step = SampleScale::from_bound(64.0).step();
    #[expect(clippy::cast_possible_truncation, reason = "a power of two")]
    let dim = (32_768.0 * step) as f32;
    let mut random = Uniform(5);
    let film = film(16, 16, 64, |_, _| [if random.next() < 0.25 { dim } else { 0.0 }; 3]);
    let summary = summarize(&film);
    assert_eq!(summary.coarse_pixels + summary.unproven_pixels, 256);
    let truth = (3.0_f64 / 64.0).sqrt();
    assert!(summary.relative_error.is_some_and(|stated| stated > truth), "{summary:?}");
    let pixel = estimate(&film, &film.pixels()[0]);
    assert!(pixel.hits(64).is_finite() && pixel.variance > 0.0, "{pixel:?}");
}

#[test]
fn coarse_pixels_are_counted() {
    let step = SampleScale::from_bound(64.0).step();
    #[expect(clippy::cast_possible_truncation, reason = "powers of two")]
    let value = |pixel: u32| if pixel == 0 { 9e5 * step } else { 1.1e6 * step } as f32;
    let summary = summarize(&film(2, 1, 4, |pixel, _| [value(pixel); 3]));
    assert_eq!(summary.coarse_pixels, 1);
}

/// Twelve pairs of films of the same picture: the tiles' z are standard normal, so the
/// mean of 12·64 of them has standard error 0.036 and their mean square one of
/// √(2/768) = 0.051; bounds at 4.9 of those (1e-6).
#[test]
fn equal_pictures_agree_with_standard_normal_deviations() {
    let (mut count, mut sum, mut squares) = (0.0, 0.0, 0.0);
    for seed in 0..12 {
        let make = |seed| hits(seed, 128, 64, |pixel| 0.1 + 0.1 * f64::from(pixel % 7));
        let found = compare(&make(100 + 2 * seed), &make(101 + 2 * seed));
        assert!(found.conclusive && !found.disagrees(1e-6), "{found:?}");
        #[expect(clippy::cast_precision_loss, reason = "a count of tiles")]
        let tiles = found.tiles as f64;
        count += tiles;
        sum += tiles * found.mean_z;
        squares += tiles * found.rms_z * found.rms_z;
    }
    assert!((sum / count).abs() < 4.9 / f64::sqrt(count), "mean z {}", sum / count);
    assert!((squares / count - 1.0).abs() < 4.9 * f64::sqrt(2.0 / count), "{}", squares / count);
}

/// The injected faults: 2 % more hits everywhere (over 10 standard errors of the image), and
/// a quarter more in a single tile (11 of its standard errors), which the image's mean hides.
#[test]
fn a_brighter_picture_and_a_brighter_tile_are_rejected() {
    let even = |seed| hits(seed, 128, 64, |_| 0.2);
    let brighter = compare(&even(1), &hits(2, 128, 64, |_| 0.2 * 1.02));
    assert!(brighter.image.p < 1e-7 && brighter.disagrees(1e-6), "{brighter:?}");
    let in_first_tile = |pixel: u32| pixel % 128 < 16 && pixel / 128 < 16;
    let spot = hits(3, 128, 64, |pixel| if in_first_tile(pixel) { 0.25 } else { 0.2 });
    let spotted = compare(&even(4), &spot);
    assert!(spotted.image.p > 1e-6 && spotted.worst.p < 1e-7, "{spotted:?}");
    assert!(spotted.disagrees(1e-6));
}

#[test]
fn too_few_hits_are_not_a_verdict() {
    let found = compare(&hits(1, 16, 4, |_| 0.1), &hits(2, 16, 4, |_| 0.1));
    assert!(!found.conclusive, "{found:?}");
    let dark = || film(4, 4, 8, |_, _| [0.0; 3]);
    assert!(!compare(&dark(), &dark()).conclusive, "no evidence at all");
}

/// A film that stayed dark where another has its thousands of hits is no case of too few.
#[test]
fn darkness_differs_from_light() {
    let found = compare(&film(64, 64, 64, |_, _| [0.0; 3]), &hits(1, 64, 64, |_| 0.2));
    assert!(found.conclusive && found.disagrees(1e-6), "{found:?}");
}

/// Pairing sees a channel that is 0.3 % too bright, and does not mind noise that both share.
#[test]
fn pairing_finds_the_bias_of_a_channel() {
    let make = |blue: f32| {
        let mut random = Uniform(7);
        film(32, 32, 64, |_, _| if random.next() < 0.1 { [8.0, 8.0, blue] } else { [0.0; 3] })
    };
    let same = pair(&make(8.0), &make(8.0));
    assert_eq!((same.bias, same.error), ([0.0; 3], [0.0; 3]));
    let biased = pair(&make(8.0 * 1.003), &make(8.0));
    assert!((biased.bias[2] - 0.003).abs() < 1e-6, "{biased:?}");
    assert!(biased.bias[..2] == [0.0; 2] && biased.exceeds(1e-3, 1e-6), "{biased:?}");
    assert!(!biased.exceeds(4e-3, 1e-6) && biased.is_within(4e-3, 1e-6), "{biased:?}");
    assert!(same.is_within(1e-3, 1e-6) && !biased.is_within(1e-3, 1e-6));
    // Other paths with the same mean are no proof of a small bias.
    let other = hits(8, 32, 64, |_| 0.1);
    let apart = pair(&hits(9, 32, 64, |_| 0.1), &other);
    assert!(!apart.is_within(1e-3, 1e-6), "{apart:?}");
}

/// Values of the standard normal's tail from Abramowitz & Stegun, table 26.2.
#[test]
fn tails_of_the_normal() {
    for (z, p) in [(0.0, 1.0), (1.0, 0.317_310_507_863), (5.0, 5.733_031_437_58e-7)] {
        assert!((p_value(z) / p - 1.0).abs() < 1e-9, "{z}");
        assert!((z_limit(p) - z).abs() < 1e-8, "{p}");
    }
}
