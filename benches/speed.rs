//! Speed and memory on this machine's device, interleaved and as medians:
//! `cargo bench --bench speed [-- --rounds N --device NAME --estimator E]`.
//!
//! Rows are rounds of the same work one after another, so that a machine that slows
//! down slows all of them; ratios are taken within a round. Where g++ is there, the
//! yardstick `benches/limit.cpp` (`implicit` by hand in AVX2) runs beside that estimator.

#![allow(clippy::cast_precision_loss, reason = "rates and ratios for show")]

#[path = "support/options.rs"]
mod options;
#[path = "support/turns.rs"]
mod turns;

use candor::bound::sample_scale;
use candor::cpu::CpuTracer;
use candor::effects::Effects;
use candor::gpu::{Adapter, GpuTracer};
use candor::kernel::{self, Kernel};
use candor::scene::{self, Estimator, ImageSize, Scene};
use candor::tracer::Tracer;
use candor::viewpoint::Viewpoint;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::time::{Duration, Instant};

/// Samples per pixel of one measurement at 512×512.
const SPP: u64 = 32;

fn main() {
    let rounds = options::count("--rounds").unwrap_or(9);
    let adapter = options::adapter();
    let scene =
        scene::load(&options::root().join("scenes/two-spheres.toml")).expect("the classic scene");
    let estimator = options::option("--estimator").map_or(scene.settings().estimator(), |name| {
        name.parse().expect("--estimator takes implicit, cosine, explicit or mis")
    });
    let settings = scene.settings().with_estimator(estimator);
    let scene = scene.with_settings(settings);
    println!("{} ({}), {}, {rounds} rounds", adapter.name(), adapter.driver(), estimator.name());

    let limit = if estimator == Estimator::Implicit { build_limit() } else { None };
    let mut rows = rows(&scene, &adapter);
    for round in 0..rounds {
        for row in &mut rows {
            row.measure(round);
        }
        if let Some(limit) = &limit {
            measure_limit(limit, &mut rows);
        }
    }
    print_rates(&rows);
    print_first_pixels(rounds);
    println!(
        "memory on the device: {:.1} bytes per pixel at 512x512",
        GpuTracer::new(&scene, options::open(&adapter)).expect("a tracer").device_bytes() as f64
            / f64::from(scene.size().pixels())
    );
}

/// One line of the table.
struct Row {
    name: &'static str,
    tracer: Option<Box<dyn Tracer>>,
    pixels: u32,
    spp: u64,
    rates: Vec<f64>,
}

impl Row {
    fn new(name: &'static str, tracer: impl Tracer + 'static, scene: &Scene, spp: u64) -> Self {
        let pixels = scene.size().pixels();
        let mut row = Self { name, tracer: Some(Box::new(tracer)), pixels, spp, rates: Vec::new() };
        // The first dispatches compile the kernel and find the device's pace.
        row.trace(1 << 40);
        row
    }

    fn trace(&mut self, first: u64) {
        let tracer = self.tracer.as_mut().expect("a row of the device");
        tracer.add_samples(first..first + self.spp).expect("samples");
    }

    fn measure(&mut self, round: u64) {
        if self.tracer.is_none() {
            return;
        }
        let started = Instant::now();
        self.trace(round * self.spp);
        let samples = f64::from(self.pixels) * self.spp as f64;
        self.rates.push(samples / started.elapsed().as_secs_f64() / 1e6);
    }
}

fn rows(scene: &Scene, adapter: &Adapter) -> Vec<Row> {
    let gpu = || options::open(adapter);
    let small = scene.clone().with_size(ImageSize::new(16, 16).expect("a size"));
    let viewpoint = Viewpoint::of(scene);
    let effects = Effects::of(scene, &viewpoint);
    let packed = kernel::pack(scene, &viewpoint, effects, sample_scale(scene));
    let kernel = Kernel::of(scene, effects, &packed);
    let with = |wgsl: &str| GpuTracer::with_kernel(scene, gpu(), &packed, wgsl).expect("a tracer");
    let looped = kernel.clone().looped();
    vec![
        Row::new("512x512, exact film", GpuTracer::new(scene, gpu()).expect("fits"), scene, SPP),
        Row::new("512x512, plain f32 sum", with(&plain_sum(&kernel.wgsl())), scene, SPP),
        Row::new("512x512, no squares", with(&without_squares(&kernel.wgsl())), scene, SPP),
        Row::new("512x512, loop over the spheres", with(&looped.wgsl()), scene, SPP),
        Row::new("16x16", GpuTracer::new(&small, gpu()).expect("fits"), &small, SPP * 1024),
        Row::new("512x512, CPU twin (f64)", CpuTracer::new(scene, None).expect("fits"), scene, 8),
        Row { name: "limit.cpp", tracer: None, pixels: 0, spp: 0, rates: Vec::new() },
    ]
}

/// The kernel with plain `f32` sums in place of the exact film. They race where a
/// dispatch holds several samples of a pixel, and the picture is wrong; only the time
/// is used.
fn plain_sum(wgsl: &str) -> String {
    let exact = "    add_sample((row * WIDTH + pixel.x) * FILM_WORDS, sample.radiance);";
    let plain = "    let word = (row * WIDTH + pixel.x) * FILM_WORDS;
    for (var c = 0u; c < 3u; c++) {
        let sum = bitcast<f32>(atomicLoad(&film[word + c])) + sample.radiance[c];
        atomicStore(&film[word + c], bitcast<u32>(sum));
    }";
    assert_eq!(wgsl.matches(exact).count(), 1, "the kernel adds a sample in one place");
    wgsl.replace(exact, plain)
}

/// The kernel with the exact film but for the squares, from which the error bars come.
fn without_squares(wgsl: &str) -> String {
    let squared = "    let squared = square(luminance(r, g, b));\n";
    let added =
        "    carries |= add_word(word + 11u, squared.z, add_pair(word + 9u, squared.xy)) << 12u;\n";
    for text in [squared, added] {
        assert_eq!(wgsl.matches(text).count(), 1, "the film adds squares in one place");
    }
    wgsl.replace(squared, "").replace(added, "")
}

fn print_rates(rows: &[Row]) {
    println!("{:32} {:>9} {:>17}  ratio to the first", "", "Msamples/s", "(lowest..highest)");
    for row in rows.iter().filter(|row| !row.rates.is_empty()) {
        let ratios: Vec<f64> =
            std::iter::zip(&row.rates, &rows[0].rates).map(|(a, b)| a / b).collect();
        let (low, high) = (
            row.rates.iter().copied().fold(f64::INFINITY, f64::min),
            row.rates.iter().copied().fold(0.0, f64::max),
        );
        println!(
            "{:32} {:9.2} {:>17}  {:.3}",
            row.name,
            turns::median(&row.rates),
            format!("({low:.2}..{high:.2})"),
            turns::median(&ratios)
        );
    }
}

/// From starting the program to the picture of one sample per pixel on the disk.
fn print_first_pixels(rounds: u64) {
    let folder = std::env::temp_dir().join(format!("candor-speed-{}", std::process::id()));
    std::fs::create_dir_all(&folder).expect("a folder for the pictures");
    let times: Vec<f64> = (0..rounds)
        .map(|_| {
            let started = Instant::now();
            let status = Command::new(env!("CARGO_BIN_EXE_candor"))
                .args(["render", "--spp", "1", "--quiet", "-o", "first.png"])
                .arg(options::root().join("scenes/two-spheres.toml"))
                .current_dir(&folder)
                .stdout(std::process::Stdio::null())
                .status()
                .expect("candor runs");
            assert!(status.success());
            started.elapsed().as_secs_f64()
        })
        .collect();
    std::fs::remove_dir_all(&folder).expect("the folder goes");
    println!("first pixels: {:.3} s from start to PNG (median of {rounds})", turns::median(&times));
}

fn build_limit() -> Option<PathBuf> {
    let binary = std::env::temp_dir().join(format!("candor-limit-{}", std::process::id()));
    let built = Command::new("g++")
        .args(["-O3", "-march=native", "-ffast-math", "-pthread", "-o"])
        .args([binary.as_path(), &options::root().join("benches/limit.cpp")])
        .status();
    built.is_ok_and(|status| status.success()).then_some(binary)
}

fn measure_limit(limit: &Path, rows: &mut [Row]) {
    let threads = std::thread::available_parallelism().expect("a number of cores");
    let output = Command::new(limit)
        .args(["96".to_owned(), threads.to_string()])
        .output()
        .expect("the yardstick runs");
    let text = String::from_utf8_lossy(&output.stdout).into_owned();
    let rate = text.split_whitespace().nth(3).and_then(|word| word.parse().ok());
    let row = rows.last_mut().expect("the yardstick's row");
    row.rates.push(rate.expect("a rate"));
    std::thread::sleep(Duration::from_millis(50));
}
