//! The twin's random numbers and directions: known answers, χ², and faults that the
//! χ² must find.

mod support {
    pub mod chi_square;
}

use candor::cpu::rng::{SampleKey, pcg4d, random_bits, unit_float, unit_floats};
use candor::cpu::sampling::{around, polar_hemisphere, polar_phong};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;
use support::chi_square::{check_samplers, hemisphere_p_value, lobe_p_value, p_limit};

fn sample_hemisphere(u: DVec2) -> DVec3 {
    around(DVec3::Z, polar_hemisphere(u.x), u.y)
}

fn sample_phong(u: DVec2, exponent: f64) -> DVec3 {
    around(DVec3::Z, polar_phong(u.x, exponent), u.y)
}

/// The reference of Jarzynski & Olano once more, in 64-bit arithmetic modulo 2³².
fn pcg4d_reference(key: [u64; 4]) -> [u64; 4] {
    let word = 1_u64 << 32;
    let mut v = key.map(|k| (k * 1_664_525 + 1_013_904_223) % word);
    let round = |v: &mut [u64; 4]| {
        for (i, a, b) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
            v[i] = (v[i] + v[a] * v[b] % word) % word;
        }
    };
    round(&mut v);
    v = v.map(|x| x ^ (x / 65_536));
    round(&mut v);
    v
}

/// Computed with whole numbers of any size from the paper's listing.
const KNOWN_ANSWERS: [([u32; 4], [u32; 4]); 4] = [
    (
        [0x0000_0000, 0x0000_0000, 0x0000_0000, 0x0000_0000],
        [0x0f02_f829, 0x2d56_8769, 0x32b0_c43b, 0xd325_48ea],
    ),
    (
        [0x0000_0001, 0x0000_0002, 0x0000_0003, 0x0000_0004],
        [0x3622_cd16, 0xf114_71d8, 0xe110_9b3f, 0x02b9_4c2f],
    ),
    (
        [0xffff_ffff, 0xffff_ffff, 0xffff_ffff, 0xffff_ffff],
        [0x974e_d892, 0xc015_dc67, 0x9f95_5760, 0xa1bb_a208],
    ),
    (
        [0x0003_ffff, 0xdead_beef, 0x0102_0304, 0x8000_0000],
        [0x8c90_666d, 0x33a6_ff55, 0x3189_5082, 0x1a8f_7359],
    ),
];

#[test]
fn pcg4d_gives_the_known_answers() {
    for (key, answer) in KNOWN_ANSWERS {
        assert_eq!(pcg4d(key), answer, "key {key:x?}");
        assert_eq!(pcg4d_reference(key.map(u64::from)), answer.map(u64::from), "key {key:x?}");
    }
}

#[test]
fn keys_do_not_share_words() {
    let key = |pixel, index| SampleKey { pixel, index };
    assert_eq!(random_bits(key(7, 9), 3, 11), pcg4d([7, 9, 3, 11]));
    assert_eq!(random_bits(key(7, (5 << 32) | 9), 3, 11), pcg4d([7, 9, (5 << 8) | 3, 11]));
    // The largest index and block.
    let last = (1 << 56) - 1;
    assert_eq!(random_bits(key(7, last), 255, 11), pcg4d([7, u32::MAX, u32::MAX, 11]));
}

#[test]
#[expect(clippy::cast_possible_truncation, reason = "24 bits fit an f32")]
fn unit_floats_are_below_one_and_exact_in_f32() {
    assert_eq!(unit_floats([0, u32::MAX, 0, 0]), DVec2::new(0.0, 1.0 - f64::powi(0.5, 24)));
    for bits in [1, 255, 256, 0x1234_5678, 0x8000_0000, u32::MAX] {
        let u = unit_float(bits);
        assert_eq!(u.to_bits(), f64::from(u as f32).to_bits());
        assert!((u * f64::from(1 << 24) - f64::from(bits >> 8)).abs() == 0.0);
    }
}

fn point(u: [f32; 2]) -> DVec2 {
    DVec2::new(f64::from(u[0]), f64::from(u[1]))
}

fn map(points: &[[f32; 2]], sample: impl Fn(DVec2) -> DVec3) -> Vec<DVec3> {
    points.iter().map(|&u| sample(point(u))).collect()
}

#[test]
fn directions_follow_their_densities() {
    check_samplers(&|points| map(points, sample_hemisphere), &|points, exponent| {
        map(points, |u| sample_phong(u, exponent))
    });
}

/// A cosine-weighted hemisphere, a hemisphere with a crowded azimuth.
#[test]
fn wrong_hemispheres_are_rejected() {
    let cosine = |u: DVec2| sample_hemisphere(DVec2::new(u.x.sqrt(), u.y));
    let crowded =
        |u: DVec2| sample_hemisphere(DVec2::new(u.x, u.y + 0.05 * (TAU * u.y).sin() / TAU));
    assert!(hemisphere_p_value(&|points| map(points, cosine)) < p_limit(1));
    assert!(hemisphere_p_value(&|points| map(points, crowded)) < p_limit(1));
}

#[expect(clippy::cast_possible_truncation, reason = "the fault is to compute in f32")]
fn sample_phong_by_pow(u: DVec2, exponent: f64) -> DVec3 {
    let cosine = f64::from((1.0 - u.x as f32).powf(1.0 / (exponent as f32 + 1.0)));
    let sine = (1.0 - cosine * cosine).sqrt();
    let (y, x) = (TAU * u.y).sin_cos();
    DVec3::new(sine * x, sine * y, cosine)
}

/// Exponent 3 % off, n for n + 1, and `pow` in `f32`, which has 20 different cosines
/// left at n = 1e7.
#[test]
fn wrong_lobes_are_rejected() {
    let stretched =
        |points: &[[f32; 2]], n: f64| map(points, |u| sample_phong(u, 1.03 * (n + 1.0) - 1.0));
    for exponent in [0.0, 100.0, 1e7] {
        assert!(lobe_p_value(&stretched, exponent) < p_limit(1), "{exponent:e}");
    }
    let confused = |points: &[[f32; 2]], n: f64| map(points, |u| sample_phong(u, n - 1.0));
    assert!(lobe_p_value(&confused, 1.0) < p_limit(1));
    let rounded = |points: &[[f32; 2]], n: f64| map(points, |u| sample_phong_by_pow(u, n));
    assert!(lobe_p_value(&rounded, 1e6) < p_limit(1));
    assert!(lobe_p_value(&rounded, 1e7) < p_limit(1));
}

#[test]
fn frames_are_orthonormal_around_every_direction() {
    let poles = [DVec3::Z, DVec3::NEG_Z, DVec3::new(1.0, 0.0, -0.0), DVec3::new(-0.0, 1.0, 0.0)];
    let near = [DVec3::new(1e-9, 0.0, -1.0), DVec3::new(0.0, -1e-9, 1.0)];
    let spread = (0..1000).map(|index| {
        let u = unit_floats(random_bits(SampleKey { pixel: 1, index }, 0, 0));
        let upper = sample_hemisphere(u);
        if index % 2 == 0 { upper } else { -upper }
    });
    for n in poles.into_iter().chain(near.map(DVec3::normalize)).chain(spread) {
        let [t, b] = [0.0, 0.25].map(|u| around(n, DVec2::X, u));
        let n2 = around(n, DVec2::Y, 0.0);
        assert!(n2.distance(n) < 1e-15, "{n}");
        assert!(t.cross(b).distance(n) < 1e-14, "{n} is not the frame's third axis");
        assert!(t.dot(b).abs() < 1e-14 && (t.length() - 1.0).abs() < 1e-14, "{n}");
    }
}
