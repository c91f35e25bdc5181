//! χ² tests of direction samplers, whoever computes them.

#![expect(clippy::cast_precision_loss, reason = "counts become statistics")]

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use glam::DVec3;
use statrs::distribution::{ChiSquared, ContinuousCDF};
use std::f64::consts::TAU;

/// Draws one direction around +z for each point of the unit square.
pub type Hemisphere<'a> = &'a dyn Fn(&[[f32; 2]]) -> Vec<DVec3>;
/// The same for the Phong lobe of an exponent.
pub type Lobe<'a> = &'a dyn Fn(&[[f32; 2]], f64) -> Vec<DVec3>;

/// Exponents at which lobes are tested.
pub const EXPONENTS: [f64; 7] = [0.0, 1.0, 100.0, 1e4, 1e6, 1e7, 1e10];

/// Chance that correct samplers fail anywhere.
const FAMILY: f64 = 1e-6;
const SAMPLES: u32 = 1 << 20;
const AZIMUTHS: usize = 16;
const POLAR_EDGES: u32 = 32;
/// Cells that expect fewer are pooled: below, the count is not nearly normal.
const LEAST_EXPECTED: f64 = 5.0;
/// How far from unit length a direction may be: `f32` samplers round.
const LENGTH_TOLERANCE: f64 = 1e-6;

/// The largest p-value that rejects, for this many tests together (Šidák).
pub fn p_limit(tests: usize) -> f64 {
    -(-FAMILY).ln_1p() / tests as f64
}

/// Tests both samplers at every exponent and at the corners of the unit square.
///
/// # Panics
/// If a sampler is wrong.
pub fn check_samplers(hemisphere: Hemisphere, lobe: Lobe) {
    let limit = p_limit(1 + EXPONENTS.len());
    check_corners(hemisphere);
    let p = hemisphere_p_value(hemisphere);
    println!("hemisphere: p = {p:.4}");
    assert!(p > limit, "the hemisphere is not uniform: p = {p:e}");
    for exponent in EXPONENTS {
        check_corners(&|points| lobe(points, exponent));
        let p = lobe_p_value(lobe, exponent);
        println!("lobe of exponent {exponent:e}: p = {p:.4}");
        assert!(p > limit, "the lobe of exponent {exponent:e} is wrong: p = {p:e}");
    }
}

/// Chance of a scatter like this one or worse from a uniform hemisphere, which is the
/// lobe of exponent 0.
pub fn hemisphere_p_value(sample: Hemisphere) -> f64 {
    p_value(&sample(&points()), 0.0)
}

/// Chance of a scatter like this one or worse from a correct lobe.
pub fn lobe_p_value(sample: Lobe, exponent: f64) -> f64 {
    p_value(&sample(&points(), exponent), exponent)
}

/// Random points, in the 24 bits that a path gets.
#[expect(clippy::cast_possible_truncation, reason = "24 bits fit an f32")]
fn points() -> Vec<[f32; 2]> {
    let point = |index| {
        let [x, y, ..] = random_bits(SampleKey { pixel: 0, index }, 1, 0);
        [unit_float(x) as f32, unit_float(y) as f32]
    };
    (0..u64::from(SAMPLES)).map(point).collect()
}

/// The ends of the unit square give directions too.
fn check_corners(sample: Hemisphere) {
    let last = 1.0 - f32::EPSILON / 2.0;
    let corners = [[0.0, 0.0], [0.0, last], [last, 0.0], [last, last]];
    for direction in sample(&corners) {
        assert_direction(direction);
    }
}

fn assert_direction(d: DVec3) {
    let off = (d.length() - 1.0).abs();
    assert!(off <= LENGTH_TOLERANCE && d.z >= 0.0, "{d} is no direction of a hemisphere");
}

/// 1 − cosα from the sine, which keeps its digits in narrow lobes.
fn versine(d: DVec3) -> f64 {
    (d.x * d.x + d.y * d.y) / (1.0 + d.z)
}

/// Share of the lobe within a versine of `t`: 1 − (1−t)^(n+1).
fn share_within(t: f64, exponent: f64) -> f64 {
    -((exponent + 1.0) * (-t).ln_1p()).exp_m1()
}

/// Inverse of [`share_within`].
fn versine_of_share(share: f64, exponent: f64) -> f64 {
    -((-share).ln_1p() / (exponent + 1.0)).exp_m1()
}

/// Edges in versine between the innermost and the outermost 1e-4 of the lobe, equal
/// ratios apart.
fn polar_edges(exponent: f64) -> Vec<f64> {
    let low = versine_of_share(1e-4, exponent);
    let high = versine_of_share(1.0 - 1e-4, exponent);
    let place = |i| f64::from(i) / f64::from(POLAR_EDGES - 1);
    (0..POLAR_EDGES).map(|i| low * (high / low).powf(place(i))).collect()
}

#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "a share of a turn, at least 0 and at most 1"
)]
fn sector(direction: DVec3) -> usize {
    let turn = (direction.y.atan2(direction.x) / TAU).rem_euclid(1.0);
    // rem_euclid rounds up to 1 just under the +x axis.
    (turn * AZIMUTHS as f64) as usize % AZIMUTHS
}

fn p_value(directions: &[DVec3], exponent: f64) -> f64 {
    let edges = polar_edges(exponent);
    let mut observed = vec![0_u32; (edges.len() + 1) * AZIMUTHS];
    for &direction in directions {
        assert_direction(direction);
        let ring = edges.partition_point(|&edge| edge <= versine(direction));
        observed[ring * AZIMUTHS + sector(direction)] += 1;
    }
    let shares: Vec<f64> = edges.iter().map(|&t| share_within(t, exponent)).collect();
    let inner = std::iter::once(0.0).chain(shares.iter().copied());
    let outer = shares.iter().copied().chain(std::iter::once(1.0));
    let in_sector = directions.len() as f64 / AZIMUTHS as f64;
    let rings = inner.zip(outer).map(|(a, b)| (b - a) * in_sector);
    let expected = rings.flat_map(|count| [count; AZIMUTHS]);
    pearson(observed.into_iter().map(f64::from).zip(expected))
}

/// Pearson's χ² over (observed, expected) cells, the thin ones pooled into one.
fn pearson(cells: impl Iterator<Item = (f64, f64)>) -> f64 {
    let (thin, mut cells): (Vec<_>, Vec<_>) = cells.partition(|c| c.1 < LEAST_EXPECTED);
    let pooled = thin.iter().fold((0.0, 0.0), |sum, c| (sum.0 + c.0, sum.1 + c.1));
    if pooled.1 >= LEAST_EXPECTED {
        cells.push(pooled);
    }
    let statistic: f64 = cells.iter().map(|(o, e)| (o - e).powi(2) / e).sum();
    let freedom = cells.len() as f64 - 1.0;
    ChiSquared::new(freedom).expect("more than one cell").sf(statistic)
}
