//! The kernel's elementary functions on the device against `f64`: every u there is,
//! and a dense sample of every binade that an exponent can be reached in. Every single one
//! of those, and WGSL's own functions beside them, takes `cargo bench --bench accuracy`.

#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "numbers below 2^24, and errors that are printed"
)]

mod support {
    pub mod bare;
    pub mod gpu;
}

use candor::gpu::probe::{Probe, Row};
use rayon::prelude::*;
use std::f64::consts::TAU;

/// Half a unit in the last place of 1: what one `f32` rounding may be off, relative.
const U: f64 = 1.0 / (1 << 24) as f64;

/// Relative error of sin 2πu and cos 2πu, in units of `U`. The reduced argument is
/// exact but for π/2 (½) and one product (1), which a sine hands on with a factor of
/// x·cot x ≤ 1. The sine adds a sum (1) to a term x³/6 of at most 0.11 of it with four
/// roundings of its own (½) and a polynomial within 0.1. The cosine adds the sum (1/cos
/// ≤ √2 of it), two products of x²/2 ≤ 0.31 (0.9), and takes over the argument's error
/// with x·tan x ≤ 0.79 (1.2). So 3.1 and 3.6.
const SINCOS: f64 = 4.0;

/// Relative error of -log(1 - u). 1 - u and f are exact. log(1 + f) is f less the
/// product s·(f - tail) ≤ 0.21·f of six roundings (1.3), and the subtraction (1), over a
/// series within 0.05: 2.4. Where k ≠ 0, k·ln 2 high is exact, the sum with its low part
/// costs 1, the last sum 1, and log(1 + f), at most as large as the result, hands on
/// its 2.4.
const LOG: f64 = 4.5;

/// Relative error of 1 - exp(-x). For k = 0 the reduced argument is exact and e^r - 1
/// is r plus a term of at most 0.2·r of seven roundings (1.4), and a sum (1). For k < 0
/// the argument's rounding (1.5 of 0.35, as x·log₂e may be off by the next integer's
/// last bit, which moves k but not the result) and that polynomial weigh 2^k ≤ ½ beside
/// 1 - 2^k ≥ ½, and the last difference costs 1.
const EXPM1: f64 = 4.0;

/// Rows of one dispatch.
const CHUNK: u32 = 1 << 21;

/// All u, as numbers of 2^-24.
const ALL: u32 = 1 << 24;

/// The n-th x: binades from 2^-58, below the smallest quotient of a logarithm and an
/// exponent of 1e10, to 2^5, each in 2^18 steps; then 0.
fn x_of(n: u32) -> f32 {
    const STEPS: u32 = 18;
    const LOWEST: u32 = 127 - 58;
    let bits = (LOWEST << 23) + (n << (23 - STEPS));
    if n < 63 << STEPS { f32::from_bits(bits) } else { 0.0 }
}

/// The largest relative error of each function, and where it is.
type Worst = [(f64, f64); 4];

fn larger(a: Worst, b: Worst) -> Worst {
    std::array::from_fn(|i| if a[i].0 >= b[i].0 { a[i] } else { b[i] })
}

/// Relative error in units of `U`; exact zeros must be met exactly.
fn error(found: f32, truth: f64) -> f64 {
    let off = (f64::from(found) - truth).abs();
    if off == 0.0 {
        return 0.0;
    }
    let error = off / truth.abs() / U;
    // NaN is infinitely wrong.
    if error.is_nan() { f64::INFINITY } else { error }
}

/// sin 2πu and cos 2πu with the quadrant taken off exactly, so that 2πu is not what
/// decides the last digit near a zero.
fn true_sincos(u: f32) -> (f64, f64) {
    let quarters = 4.0 * f64::from(u);
    let nearest = (quarters + 0.5).floor();
    let (sine, cosine) = ((quarters - nearest) * TAU / 4.0).sin_cos();
    match nearest as u32 % 4 {
        0 => (sine, cosine),
        1 => (cosine, -sine),
        2 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

fn errors(row: Row, result: Row) -> Worst {
    let [u, x, ..] = row.map(f32::from_bits);
    let found = result.map(f32::from_bits);
    let (sine, cosine) = true_sincos(u);
    let log = -(-f64::from(u)).ln_1p();
    let fraction = -(-f64::from(x)).exp_m1();
    let truth = [sine, cosine, log, fraction];
    let at = [u, u, u, x].map(f64::from);
    std::array::from_fn(|i| (error(found[i], truth[i]), at[i]))
}

fn row(n: u32) -> Row {
    [(n as f32 * 2.0_f32.powi(-24)).to_bits(), x_of(n).to_bits(), 0, 0]
}

/// The worst of all rows, as the function `run` computes them.
fn worst(run: impl Fn(&[Row]) -> Vec<Row>) -> Worst {
    let mut worst = [(0.0, 0.0); 4];
    for start in (0..ALL).step_by(CHUNK as usize) {
        let rows: Vec<Row> = (start..start + CHUNK).map(row).collect();
        let found = run(&rows);
        let chunk = rows
            .par_iter()
            .zip(found)
            .map(|(&row, found)| errors(row, found))
            .reduce(|| [(0.0, 0.0); 4], larger);
        worst = larger(worst, chunk);
    }
    worst
}

const BOUNDS: [(&str, f64); 4] =
    [("sin 2πu", SINCOS), ("cos 2πu", SINCOS), ("-log(1-u)", LOG), ("1-exp(-x)", EXPM1)];

#[test]
fn elementary_functions_keep_their_bounds() {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &support::bare::nothing()).expect("the probe compiles");
    let worst = worst(|rows| probe.run("probe_math", rows, rows.len()).expect("it runs"));
    println!("{:<12}{:>10}{:>8}   relative error in units of 2^-24", "", "worst", "bound");
    for ((name, bound), (error, at)) in BOUNDS.into_iter().zip(worst) {
        println!("{name:<12}{error:>10.3}{bound:>8.1}   at {at:e}");
    }
    for ((name, bound), (error, at)) in BOUNDS.into_iter().zip(worst) {
        assert!(error <= bound, "{name} is off by {error} units at {at:e}, beyond {bound}");
    }
}

/// What WGSL's own functions may do, and the obvious formulas in `f32`: each column
/// must be rejected.
#[test]
fn coarser_functions_are_rejected() {
    let coarse = |rows: &[Row]| {
        let compute = |row: &Row| {
            let [u, x, ..] = row.map(f32::from_bits);
            let turn = std::f32::consts::TAU * u;
            [turn.sin(), turn.cos(), -((1.0 - u).ln() + 2.0_f32.powi(-21)), 1.0 - (-x).exp()]
                .map(f32::to_bits)
        };
        rows.par_iter().map(compute).collect()
    };
    for ((name, bound), (error, _)) in BOUNDS.into_iter().zip(worst(coarse)) {
        assert!(error > bound, "{name}: an error of {error} units is accepted");
    }
}
