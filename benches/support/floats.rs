//! What `f32` sums make of many samples: a sum and a running mean of the same stream, on the
//! host, one sample after the other as a device would add them.

use crate::lamp::{PIXELS, Pixel};
use candor::cpu::rng::{SampleKey, random_bits};

/// Relative errors at one count.
struct Line {
    exact: f64,
    sum: f64,
    mean: f64,
}

/// Samples of a pixel under cosine-weighted directions, ρL or nothing, until the last count.
#[expect(clippy::cast_possible_truncation, reason = "sums in f32 are what is shown")]
fn stream(pixel: &Pixel, counts: &[u64]) -> Vec<Line> {
    let value = (pixel.mean / pixel.share) as f32;
    // A word below this is a hit.
    let limit = (pixel.share * 4_294_967_296.0).round();
    let truth = f64::from(value) * limit / 4_294_967_296.0;
    let (mut hits, mut sum, mut mean) = (0_u64, 0.0_f32, 0.0_f32);
    let mut lines = Vec::new();
    for block in 0..counts.last().map_or(0, |last| last.div_ceil(4)) {
        for (place, word) in (1..).zip(random_bits(SampleKey { pixel: 0, index: block }, 0, 1)) {
            let count = 4 * block + place;
            let hit = f64::from(word) < limit;
            let sample = if hit { value } else { 0.0 };
            hits += u64::from(hit);
            sum += sample;
            mean += (sample - mean) / count as f32;
            if counts.contains(&count) {
                let exact = f64::from(value) * hits as f64 / count as f64;
                let [exact, sum, mean] = [exact, f64::from(sum) / count as f64, f64::from(mean)]
                    .map(|m| m / truth - 1.0);
                lines.push(Line { exact, sum, mean });
            }
        }
    }
    lines
}

/// Prints the brightest and the darkest pixel.
pub fn print(truth: &[Pixel; PIXELS], counts: &[u64]) {
    let [bright, dark] = [truth[0], truth[PIXELS - 1]];
    let (bright_lines, dark_lines) = std::thread::scope(|scope| {
        let dark = scope.spawn(|| stream(&dark, counts));
        (stream(&bright, counts), dark.join().expect("the other thread ends"))
    });
    println!("As many samples summed in f32 on the host: relative errors");
    println!(
        "{:>8}  {:^43}  {:^43}",
        "",
        format!("a pixel of {:.2e}", bright.mean),
        format!("a pixel of {:.2e}", dark.mean)
    );
    let head = format!("{:>10} {:>10} {:>10} {:>10}", "σ/√N", "integers", "f32 sum", "f32 mean");
    println!("{:>8}  {head}  {head}", "samples");
    for ((count, bright_line), dark_line) in counts.iter().zip(bright_lines).zip(dark_lines) {
        let columns = |pixel: &Pixel, line: &Line| {
            // A share of hits: σ²/m² = (1 - share)/share.
            let error = ((1.0 - pixel.share) / pixel.share / *count as f64).sqrt();
            format!("{error:>10.1e} {:>10.1e} {:>10.1e} {:>10.1e}", line.exact, line.sum, line.mean)
        };
        println!(
            "{count:>8.0e}  {}  {}",
            columns(&bright, &bright_line),
            columns(&dark, &dark_line)
        );
    }
    println!();
}
