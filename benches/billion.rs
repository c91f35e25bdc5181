//! A picture of eight pixels with a known answer, to a thousand million samples of each:
//! `cargo bench --bench billion [-- --spp N --device NAME]`.
//!
//! A lamp over a diffuse floor, seen along a line that leads away from it, so that each pixel
//! is a few times darker than its neighbour. At every power of ten the error is printed
//! beside σ/√N, both from closed forms and quadrature; the process fails where the squares of
//! the errors are not those of χ², or the slope is not -½. What `f32` sums would have made of
//! as many samples is computed beside it.

#![allow(clippy::cast_precision_loss, reason = "counts of samples below 2^53")]

#[path = "../tests/support/closed_form.rs"]
#[expect(dead_code, reason = "the tests use the rest")]
mod closed_form;
#[path = "support/floats.rs"]
mod floats;
#[path = "support/lamp.rs"]
mod lamp;
#[path = "support/options.rs"]
mod options;

use candor::estimate::z_limit;
use candor::film::{Film, sums};
use candor::gpu::GpuTracer;
use candor::tracer::Tracer;
use lamp::{PIXELS, Pixel};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use statrs::function::gamma::digamma;
use std::process::ExitCode;
use std::time::Instant;

/// Probability that a renderer without fault fails here.
const FAMILY: f64 = 1e-6;

/// A pixel's error is normal from this many effective hits on: its skewness is below 0.03.
const HITS: f64 = 1000.0;

fn main() -> ExitCode {
    let most = options::count("--spp").unwrap_or(1_000_000_000);
    let adapter = options::adapter();
    let (scene, truth) = (lamp::scene(), lamp::pixels());
    println!("{} ({}), {PIXELS} pixels, implicit", adapter.name(), adapter.driver());
    print_picture(&truth);
    let mut tracer = GpuTracer::new(&scene, options::open(&adapter)).expect("it fits");
    let counts: Vec<u64> = (3..=9).map(|k| 10_u64.pow(k)).filter(|&n| n <= most).collect();
    assert!(!counts.is_empty(), "--spp takes 1000 or more");
    println!(
        "{:>8} {:>10} {:>10} {:>7}  errors of the pixels in standard errors",
        "samples", "error", "σ/√N", "ratio"
    );
    let started = Instant::now();
    let (mut points, mut last, mut passed) = (Vec::new(), ([0; PIXELS], 0), true);
    let mut means = [0.0; PIXELS];
    for &count in &counts {
        tracer.add_samples(last.1..count).expect("samples");
        let film = tracer.film().expect("a film");
        let (now, step) = (totals(&film), film.scale().step());
        means = now.map(|sum| sum as f64 * step / count as f64);
        print_count(&truth, &means, count);
        passed &= judge(&truth, &means, count, counts.len());
        let fresh = std::array::from_fn(|i| (now[i] - last.0[i]) as f64 * step);
        points.extend(Point::of(&truth, &fresh, count - last.1));
        last = (now, count);
    }
    let rate = last.1 as f64 * PIXELS as f64 / started.elapsed().as_secs_f64() / 1e6;
    let invalid = tracer.ledger().expect("a ledger").count;
    println!("{rate:.1} Msamples/s, {invalid} invalid samples");
    passed &= print_slope(&points) && invalid == 0;
    passed &= rejects(&truth, &means, last.1);
    floats::print(&truth, &counts);
    println!("{}", if passed { "The error is what statistics lets expect." } else { "FAILED" });
    if passed { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}

fn print_picture(truth: &[Pixel; PIXELS]) {
    let row = |name: &str, of: &dyn Fn(&Pixel) -> f64| {
        print!("{name:20}");
        for pixel in truth {
            print!("{:>10.2e}", of(pixel));
        }
        println!();
    };
    row("true radiance", &|pixel| pixel.mean);
    row("σ of one sample", &|pixel| pixel.deviation);
    println!();
}

/// Sums of the green channel in steps of the film; the scene is grey.
fn totals(film: &Film) -> [u128; PIXELS] {
    std::array::from_fn(|i| sums(&film.pixels()[i])[1])
}

/// Errors of the means in standard errors; none where hits are too few for a normal one.
fn deviates(truth: &[Pixel; PIXELS], means: &[f64; PIXELS], count: u64) -> [Option<f64>; PIXELS] {
    std::array::from_fn(|i| {
        let Pixel { mean, deviation, .. } = truth[i];
        let effective = count as f64 * mean * mean / (mean * mean + deviation * deviation);
        (effective >= HITS).then(|| (means[i] - mean) / deviation * (count as f64).sqrt())
    })
}

/// Root of the mean square of errors relative to the truth.
fn rms(truth: &[Pixel; PIXELS], error: impl Fn(usize) -> f64) -> f64 {
    let squares = (0..PIXELS).map(|i| (error(i) / truth[i].mean).powi(2));
    (squares.sum::<f64>() / PIXELS as f64).sqrt()
}

fn print_count(truth: &[Pixel; PIXELS], means: &[f64; PIXELS], count: u64) {
    let found = rms(truth, |i| means[i] - truth[i].mean);
    let expected = rms(truth, |i| truth[i].deviation) / (count as f64).sqrt();
    print!("{count:>8.0e} {found:>10.2e} {expected:>10.2e} {:>7.2} ", found / expected);
    for z in deviates(truth, means, count) {
        print!("{}", z.map_or_else(|| format!("{:>7}", "-"), |z| format!("{z:>7.2}")));
    }
    println!();
}

/// Whether the squared errors may come from χ², neither too large nor too small. Half of the
/// risk is for the looks, on two sides each; half for the slope.
fn judge(truth: &[Pixel; PIXELS], means: &[f64; PIXELS], count: u64, looks: usize) -> bool {
    let z: Vec<f64> = deviates(truth, means, count).into_iter().flatten().collect();
    let Ok(law) = ChiSquared::new(z.len() as f64) else { return true };
    let squares = z.iter().map(|z| z * z).sum();
    law.cdf(squares).min(law.sf(squares)) >= FAMILY / 4.0 / looks as f64
}

/// Whether the judge would have seen a picture that is too bright by ten standard errors of
/// the pixel that is known best; prints how much that is.
fn rejects(truth: &[Pixel; PIXELS], means: &[f64; PIXELS], count: u64) -> bool {
    if deviates(truth, means, count).iter().all(Option::is_none) {
        return true;
    }
    let relative = |pixel: &Pixel| pixel.deviation / pixel.mean / (count as f64).sqrt();
    let off = 10.0 * truth.iter().map(relative).fold(f64::INFINITY, f64::min);
    println!("a picture that is {off:.1e} too bright would have failed\n");
    !judge(truth, &means.map(|mean| mean * (1.0 + off)), count, 1)
}

/// The error of samples that no other point shares.
struct Point {
    log_count: f64,
    /// Logarithm of the RMS error over σ, less what its mean is for a slope of -½.
    log_error: f64,
    /// Its variance: of ½·log χ²/m with m degrees of freedom.
    variance: f64,
}

impl Point {
    fn of(truth: &[Pixel; PIXELS], sums: &[f64; PIXELS], count: u64) -> Option<Self> {
        let z = deviates(truth, &sums.map(|sum| sum / count as f64), count);
        let squares: Vec<f64> = z.iter().flatten().map(|z| z * z).collect();
        let half = squares.len() as f64 / 2.0;
        let of_sigma = squares.iter().sum::<f64>() / squares.len() as f64;
        (half > 0.0).then(|| Self {
            log_count: (count as f64).ln(),
            log_error: 0.5 * (of_sigma.ln() - digamma(half) + half.ln())
                - 0.5 * (count as f64).ln(),
            variance: trigamma(half) / 4.0,
        })
    }
}

/// ψ′ for x ≥ ½: raised by its recurrence, then the series of DLMF 5.15.8.
fn trigamma(x: f64) -> f64 {
    if x < 20.0 {
        return trigamma(x + 1.0) + 1.0 / (x * x);
    }
    1.0 / x + 0.5 / (x * x) + 1.0 / (6.0 * x.powi(3)) - 1.0 / (30.0 * x.powi(5))
}

/// Fits the slope of the error, weighted by the points' variances, and judges it.
fn print_slope(points: &[Point]) -> bool {
    let weighted = |of: &dyn Fn(&Point) -> f64| -> f64 {
        points.iter().map(|point| of(point) / point.variance).sum()
    };
    if points.len() < 2 {
        println!("too few samples for a slope");
        return true;
    }
    let total = weighted(&|_| 1.0);
    let x = weighted(&|p| p.log_count) / total;
    let y = weighted(&|p| p.log_error) / total;
    let spread = weighted(&|p| (p.log_count - x).powi(2));
    let slope = weighted(&|p| (p.log_count - x) * (p.log_error - y)) / spread;
    let error = 1.0 / spread.sqrt();
    println!("slope of log error over log N, from new samples alone: {slope:.3} ± {error:.3}");
    (slope + 0.5).abs() <= z_limit(FAMILY / 2.0) * error
}
