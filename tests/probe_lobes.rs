//! The density of a Phong lobe for directions that it did not draw, on the device: the
//! elementary functions behind it and the density itself against `f64`, and against the
//! density that the same direction is drawn with.

#![expect(clippy::cast_possible_truncation, reason = "the device computes in f32")]

mod support {
    pub mod bare;
    pub mod gpu;
}

use bytemuck::Zeroable;
use candor::cpu::material::{evaluate_glossy, scatter_glossy};
use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sampling::{around, polar_hemisphere};
use candor::gpu::probe::{Probe, Row};
use candor::kernel::layout;
use glam::{DVec2, DVec3, Vec3};
use std::f64::consts::TAU;
use support::bare::bare;

const U: f64 = 1.0 / (1 << 24) as f64;

/// Relative error of -log(1 - u) for every u in [0, 1), in units of U: that of
/// `probe_math` for multiples of 2⁻²⁴, where 1 - u is exact, or where f is -u itself. In
/// between, from 1 - √½ to ½, 1 - u is off by half a unit of 2⁻²⁴, which the logarithm
/// (at least 0.35) makes 2.1.
const LOG: f64 = 4.5 + 2.1;

/// Relative error of exp(-x), x ≤ 80, in units of U. The reduced argument is off by its last
/// difference (0.35), e^r - 1 by a sum (0.42) over a term of at most 0.07 of seven roundings
/// (0.5) and its series (0.1); e^r ≥ 0.7 makes those 2, and the last sum costs 1.
const EXP: f64 = 3.0;

/// Beyond, 2⁻¹¹⁵ counts as 0.
const LAST_EXPONENT: f64 = 80.0;

const EXPONENTS: [f32; 8] = [0.0, 1.0, 7.5, 100.0, 1e4, 1e6, 1e8, 1e10];

fn run(entry: &str, rows: &[Row], results: usize) -> Vec<[f32; 4]> {
    let glossy = |exponent| layout::Sphere {
        kind: layout::KIND_GLOSSY,
        exponent,
        ..layout::Sphere::zeroed()
    };
    let scene = bare(layout::Scene::zeroed(), EXPONENTS.map(glossy).to_vec());
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &scene).expect("the probe compiles");
    let rows = probe.run(entry, rows, results).expect("the device runs");
    rows.into_iter().map(|row| row.map(f32::from_bits)).collect()
}

/// Numbers from 2^`lowest` up to 2^`highest`, 2¹⁴ in each binade.
fn binades(lowest: i32, highest: i32) -> impl Iterator<Item = f32> {
    const STEPS: u32 = 14;
    let start = (lowest + 127).cast_unsigned() << 23;
    let count = (highest - lowest).cast_unsigned() << STEPS;
    // Odd last digits, so that 1 - u is not exact.
    (0..count).map(move |n| f32::from_bits(start + (n << (23 - STEPS)) + n % 512))
}

/// Relative error in units of U; exact zeros must be met exactly.
fn error(found: f32, truth: f64) -> f64 {
    let off = (f64::from(found) - truth).abs();
    if off == 0.0 { 0.0 } else { off / truth.abs() / U }
}

#[test]
fn elementary_functions_keep_their_bounds_for_all_inputs() {
    let us = binades(-70, 0).chain([0.0, 1.0 - f32::EPSILON / 2.0]);
    let xs = binades(-30, 6).chain((0..1 << 14).map(|n| 64.0 + f32::from(n as i16) / 1024.0));
    let xs: Vec<f32> = xs.chain([0.0]).collect();
    let rows: Vec<Row> =
        us.zip(xs.iter().cycle()).map(|(u, &x)| [u.to_bits(), x.to_bits(), 0, 0]).collect();
    let (mut log, mut exp) = ([0.0_f64; 2], [0.0_f64; 2]);
    for (row, found) in rows.iter().zip(run("probe_exp", &rows, rows.len())) {
        let [u, x] = [row[0], row[1]].map(|bits| f64::from(f32::from_bits(bits)));
        let off = [error(found[0], -(-u).ln_1p()), error(found[1], (-x).exp())];
        assert!(off[0] <= LOG, "-log(1 - {u:e}) off by {}", off[0]);
        assert!(off[1] <= EXP, "exp(-{x:e}) off by {}", off[1]);
        // Through 1 - u, and through a built-in function with WGSL's error of 3 + 2x.
        let coarse =
            [-((1.0 - u as f32).ln()), (-x).exp() as f32 * (1.0 + 6e-8 * (3.0 + 2.0 * x as f32))];
        let coarse = [error(coarse[0], -(-u).ln_1p()), error(coarse[1], (-x).exp())];
        (log, exp) = (
            [log[0].max(off[0]), log[1].max(coarse[0])],
            [exp[0].max(off[1]), exp[1].max(coarse[1])],
        );
    }
    println!("-log(1-u): {:.2} of {LOG}·2^-24; exp(-x): {:.2} of {EXP}·2^-24", log[0], exp[0]);
    assert!(log[1] > LOG && exp[1] > EXP, "coarser functions pass: {log:?}, {exp:?}");
    let far: Vec<Row> = [80.1_f32, 100.0, 1e12, f32::MAX].map(|x| [0, x.to_bits(), 0, 0]).into();
    assert!(run("probe_exp", &far, far.len()).iter().all(|found| found[1] == 0.0), "far from 0");
}

/// A direction on a glossy surface.
#[derive(Debug, Clone, Copy)]
struct Event {
    normal: Vec3,
    incoming: Vec3,
    surface: usize,
    u: [f32; 2],
    direction: Vec3,
}

fn draw(index: u64, block: u32) -> DVec2 {
    let [u, v, ..] = random_bits(SampleKey { pixel: 5, index }, block, 0).map(unit_float);
    DVec2::new(u, v)
}

/// Lobes that face anywhere, with directions of the lobe and, each fourth time, any.
fn events(count: u64) -> Vec<Event> {
    let event = |index: u64| {
        let [u, v] = draw(index, 0).to_array();
        let up = around(DVec3::Z, polar_hemisphere(u), v);
        let normal = if index.is_multiple_of(2) { up } else { -up };
        let [u, v] = draw(index, 1).to_array();
        let incoming = -around(normal, polar_hemisphere(u), v);
        let surface = (index / 4) as usize % EXPONENTS.len();
        let point = draw(index, 2).as_vec2();
        let exponent = f64::from(EXPONENTS[surface]);
        let drawn = scatter_glossy(normal, incoming, exponent, point.as_dvec2()).direction;
        let [u, v] = draw(index, 3).to_array();
        let any = around(normal, polar_hemisphere(u), v);
        Event {
            normal: normal.as_vec3(),
            incoming: incoming.as_vec3(),
            surface,
            u: point.to_array(),
            direction: if index.is_multiple_of(4) { any } else { drawn }.as_vec3(),
        }
    };
    (0..count).map(event).collect()
}

fn rows(events: &[Event], third: impl Fn(&Event) -> Vec3) -> Vec<Row> {
    let row = |v: Vec3, w: u32| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), w];
    let rows = |e: &Event| {
        let surface = u32::try_from(e.surface).expect("a few");
        [row(e.normal, 0), row(e.incoming, surface), row(third(e), 0)]
    };
    events.iter().flat_map(rows).collect()
}

/// How far off, relative, (n+1)·exp(n·log(1 - t)) may be for a versine t that is off by
/// `of_t`: the logarithm hands that on with 1/(1-t), n multiplies its error and that of the
/// product (1), and the exponential makes it relative. `None` where that is no bound.
fn density_bound(exponent: f64, t: f64, of_t: f64) -> Option<f64> {
    let depth = -exponent * (-t).ln_1p();
    let left = 1.0 - t - of_t;
    if left < 0.05 || depth > LAST_EXPONENT - 1.0 {
        return None;
    }
    let of_depth = exponent * of_t / left + (LOG + 1.0) * U * depth;
    // The exponential, n + 1 and the product; π does not enter.
    Some(of_depth.exp_m1() + (EXP + 2.0) * U)
}

/// The versine ½|m - d|² of a mirror direction that is off by 26 (`probe_sampling`) from a
/// direction at the distance |m - d|: the difference rounds (1), the dot product too (3).
fn versine_error(t: f64) -> f64 {
    let off = (2.0 * t).sqrt();
    let of_off = U * (26.0 + off);
    off * of_off + of_off * of_off / 2.0 + 3.0 * U * t
}

#[test]
fn densities_agree_with_f64() {
    let events = events(1 << 18);
    let found = run("probe_evaluate", &rows(&events, |e| e.direction), events.len());
    let (mut worst, mut judged, mut rejected) = ([0.0_f64; EXPONENTS.len()], 0, 0);
    for (e, [weight, density, ..]) in events.iter().zip(found) {
        let exponent = f64::from(EXPONENTS[e.surface]);
        let [normal, incoming, direction] = [e.normal, e.incoming, e.direction].map(Vec3::as_dvec3);
        let truth = evaluate_glossy(normal, incoming, direction, exponent);
        assert!((f64::from(weight) - truth.weight).abs() <= 4.0 * U, "{e:?}: weight {weight}");
        let mirror = (incoming - 2.0 * incoming.dot(normal) * normal).normalize();
        let t = (mirror - direction).length_squared() / 2.0;
        let of_t = versine_error(t);
        // The kernel's density is in units of 1/2π.
        let (density, expected) = (f64::from(density), TAU * truth.density);
        if t - of_t >= 1.0 {
            assert!(density == 0.0, "{e:?}: {density} behind the mirror direction");
        }
        let Some(bound) = density_bound(exponent, t, of_t) else { continue };
        let off = (density / expected - 1.0).abs();
        assert!(off <= bound, "{e:?}: density {density} instead of {expected}, bound {bound:e}");
        worst[e.surface] = worst[e.surface].max(off / bound);
        // cosⁿ of the dot product in f32.
        let cosine = mirror.as_vec3().dot(e.direction);
        let dotted = f64::from(EXPONENTS[e.surface] + 1.0) * f64::from(cosine).powf(exponent);
        (judged, rejected) =
            (judged + 1, rejected + u32::from((dotted / expected - 1.0).abs() > bound));
    }
    println!(
        "{judged} of {} densities, largest shares of the bound {worst:.2?}, cosⁿ fails {rejected}",
        events.len()
    );
    assert!(judged > 1 << 17 && rejected > 1 << 14, "{judged} judged, {rejected} rejected");
}

/// `scatter` and `evaluate` must mean the same density, or the power heuristic's shares of
/// one direction do not add up to one. The direction is off by its three roundings where it
/// stands near the axis, and by a frame (24) and an azimuth (19) as far as it leaves it; its
/// versine by 15 (`probe_sampling`).
#[test]
fn drawn_and_evaluated_densities_agree() {
    let events = events(1 << 18);
    let points = |e: &Event| Vec3::new(e.u[0], e.u[1], 0.0);
    let found = run("probe_density", &rows(&events, points), events.len());
    let (mut worst, mut judged, mut total) = ([0.0_f64; EXPONENTS.len()], 0, 0.0);
    for (e, [drawn, evaluated, t, _]) in events.iter().zip(found) {
        let exponent = f64::from(EXPONENTS[e.surface]);
        let exact = -((-f64::from(e.u[0])).ln_1p() / (exponent + 1.0)).exp_m1();
        assert!((f64::from(t) - exact).abs() <= 15.0 * U * exact + U, "{e:?}: versine {t}");
        let off = (2.0 * exact).sqrt();
        let of_off = U * (6.0 + 60.0 * off);
        let of_t = off * of_off + of_off * of_off / 2.0 + 18.0 * U * exact;
        let Some(bound) = density_bound(exponent, exact, of_t) else { continue };
        // (1 - u)/cosα: a quotient, and cosα's own error.
        let bound = bound + U * (8.0 + 15.0 * exact / (1.0 - exact));
        let apart = (f64::from(evaluated) / f64::from(drawn) - 1.0).abs();
        assert!(apart <= bound, "{e:?}: drawn with {drawn}, evaluated as {evaluated}, {bound:e}");
        worst[e.surface] = worst[e.surface].max(apart / bound);
        (judged, total) = (judged + 1, total + apart);
    }
    println!(
        "{judged} densities, largest shares of the bound {worst:.2?}, mean difference {:.1e}",
        total / f64::from(judged)
    );
    assert!(judged > 1 << 17, "{judged} judged");
}
