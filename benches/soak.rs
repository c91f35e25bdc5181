//! Ten thousand million samples without an invalid one: every scene of the repository, and of
//! the sweep, under every estimator, `cargo bench --bench soak [-- --samples N --device NAME]`.
//!
//! The samples are shared out evenly over the scenes of `scenes/`, `scenes/hard/` and `candor
//! verify --hard`, and the four estimators. An invalid sample (NaN, infinite, negative, above the proven bound, or cut
//! short) is counted and named, and the process fails.

#[path = "support/options.rs"]
mod options;

use candor::bound;
use candor::gpu::{Adapter, GpuTracer};
use candor::range::{self, Arithmetic};
use candor::scene::{Estimator, Scene, load};
use candor::sweep;
use candor::tracer::{Ledger, Tracer};
use candor::viewpoint::Viewpoint;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

/// Scene files of a folder, by name.
fn scene_files(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a folder").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    files.sort();
    files
}

/// The scenes, by name; what is refused is named.
fn scenes() -> Vec<(String, Scene)> {
    let folder = options::root().join("scenes");
    let files = [scene_files(&folder), scene_files(&folder.join("hard"))].concat();
    let named = |path: &PathBuf| {
        let name = path.strip_prefix(options::root()).unwrap_or(path).display().to_string();
        match loaded(path) {
            Ok(scene) => Some((name, scene)),
            Err(error) => {
                refused(&name, &error);
                None
            }
        }
    };
    let swept = sweep::cases().expect("the classic scene is valid").into_iter();
    let swept = swept.map(|case| (format!("{} {}", case.group, case.value), case.scene));
    files.iter().filter_map(named).chain(swept).collect()
}

/// Each scene under every estimator that takes it.
fn tasks(adapter: &Adapter) -> Vec<(String, Scene)> {
    let mut tasks = Vec::new();
    for (name, scene) in scenes() {
        for estimator in Estimator::ALL {
            let settings = scene.settings().with_estimator(estimator);
            let scene = scene.clone().with_settings(settings);
            let name = format!("{name}, {}", estimator.name());
            let accepted = bound::check(&scene).map_err(|error| error.to_string());
            let opened = || GpuTracer::new(&scene, options::open(adapter)).map(drop);
            match accepted.and_then(|()| opened().map_err(|error| error.to_string())) {
                Ok(()) => tasks.push((name, scene)),
                Err(error) => refused(&name, &error),
            }
        }
    }
    tasks
}

/// A scene that `candor render` would take.
fn loaded(path: &Path) -> Result<Scene, String> {
    let scene = load(path).map_err(|error| error.to_string())?;
    range::check(&scene, &Viewpoint::of(&scene), Arithmetic::Single)
        .map_err(|error| error.to_string())?;
    Ok(scene)
}

fn refused(name: &str, error: &str) {
    println!("refused: {name}: {}", error.lines().next().unwrap_or_default());
}

/// Traces at least `samples` samples; their number and what was invalid among them.
fn soak(scene: &Scene, adapter: &Adapter, samples: u64) -> (u64, Ledger) {
    let spp = samples.div_ceil(u64::from(scene.size().pixels()));
    let mut tracer = GpuTracer::new(scene, options::open(adapter)).expect("it was taken before");
    tracer.add_samples(0..spp).expect("the device traces");
    (spp * u64::from(scene.size().pixels()), tracer.ledger().expect("a ledger"))
}

#[expect(clippy::cast_precision_loss, reason = "a rate for show")]
fn main() -> ExitCode {
    let wanted = options::count("--samples").unwrap_or(10_000_000_000);
    let adapter = options::adapter();
    println!("{} ({})", adapter.name(), adapter.driver());
    let tasks = tasks(&adapter);
    let each = wanted.div_ceil(tasks.len().max(1) as u64);
    println!("{:52} {:>14} {:>8} {:>11}", "", "samples", "invalid", "Msamples/s");
    let (mut samples, mut invalid) = (0, 0);
    for (name, scene) in &tasks {
        let started = Instant::now();
        let (traced, ledger) = soak(scene, &adapter, each);
        let rate = traced as f64 / started.elapsed().as_secs_f64() / 1e6;
        println!("{name:52} {traced:>14} {:>8} {rate:>11.1}", ledger.count);
        for record in ledger.records {
            println!("    {record:?}");
        }
        (samples, invalid) = (samples + traced, invalid + ledger.count);
    }
    println!("{:52} {samples:>14} {invalid:>8}", "in all");
    if invalid == 0 && samples >= wanted { ExitCode::SUCCESS } else { ExitCode::FAILURE }
}
