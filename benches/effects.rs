//! What leaving out of the kernel what a scene does not call for saves: the specialised kernel
//! beside the general one on every scene of the repository under every estimator, and what each
//! effect costs a scene that does not call for it:
//! `cargo bench --bench effects [-- --rounds N --scene NAME --device NAME]`.
//!
//! In turns, as ratios of processor time, which others on the machine hardly change. Markdown
//! on stdout. The process fails where the specialised kernel is the slower one beyond noise: by
//! more than [`SAME`] in every round, which chance alone does in 2^-rounds of pairs.

#[path = "support/options.rs"]
mod options;
#[path = "support/processor.rs"]
mod processor;
#[path = "support/turns.rs"]
mod turns;

use candor::effects::{Effect, Effects};
use candor::gpu::{Adapter, GpuTracer};
use candor::range::{self, Arithmetic};
use candor::scene::{Albedo, Estimator, ImageSize, Scene, Sphere, Surface, load};
use candor::tracer::Tracer;
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use processor::timed;
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use turns::{Measure, Middle};

/// Kernels with the same text differ by so much, by where their code lies in memory.
const SAME: f64 = 0.01;

/// Pixels of a side.
const SIDE: u32 = 128;

/// Least seconds of one measurement.
const LEAST: f64 = 0.1;

/// One kernel on a scene, and what it took for a sample in every round.
struct Kernel {
    tracer: GpuTracer,
    spp: u64,
}

impl Kernel {
    fn new(scene: &Scene, adapter: &Adapter, effects: Effects) -> Self {
        let tracer = GpuTracer::with_effects(scene, options::open(adapter), effects);
        let mut kernel = Self { tracer: tracer.expect("the device takes the scene"), spp: 1 };
        // The first dispatches find the device's pace.
        while kernel.measure(1 << 30) < LEAST {
            kernel.spp *= 2;
        }
        kernel
    }

    /// Seconds of processors.
    fn measure(&mut self, round: u64) -> f64 {
        let first = round * self.spp;
        let samples = first..first + self.spp;
        timed(|| self.tracer.add_samples(samples).expect("samples")).processor
    }
}

/// Times of the second kernel over those of the first, round by round.
fn ratios(scene: &Scene, adapter: &Adapter, effects: [Effects; 2], rounds: u64) -> Vec<f64> {
    let [mut one, mut other] = effects.map(|effects| Kernel::new(scene, adapter, effects));
    // The same samples for both.
    let spp = one.spp.min(other.spp);
    (one.spp, other.spp) = (spp, spp);
    let mut rows: [Measure; 2] =
        [Box::new(|round| one.measure(round)), Box::new(|round| other.measure(round))];
    let times = turns::take(rounds, &mut rows);
    std::iter::zip(&times[1], &times[0]).map(|(other, one)| other / one).collect()
}

/// What the classic scene calls for no more when both balls are diffuse.
fn diffuse_only(classic: &Scene) -> Scene {
    let grey = Albedo::new(DVec3::splat(0.5)).expect("an albedo");
    let diffuse = |sphere: &Sphere| {
        let surface = match sphere.surface() {
            Surface::Glossy(..) => Surface::Diffuse(grey),
            other => other,
        };
        Sphere::new(sphere.center(), sphere.radius(), surface).expect("a sphere")
    };
    let spheres = classic.spheres().iter().map(diffuse).collect();
    Scene::new(classic.camera().clone(), classic.size(), classic.settings(), spheres)
}

/// The scenes that are traced at all, by name, the classic one first.
fn scenes(wanted: Option<&str>) -> Vec<(String, Scene)> {
    let folder = options::root().join("scenes");
    let classic = load(&folder.join("two-spheres.toml")).expect("the classic scene");
    let mut scenes = vec![
        ("two-spheres".to_owned(), classic.clone()),
        ("two-spheres, both diffuse".to_owned(), diffuse_only(&classic)),
    ];
    let files = [files(&folder), files(&folder.join("hard"))].concat();
    for file in files.iter().filter(|file| !file.ends_with("two-spheres.toml")) {
        let name = file.file_stem().expect("a name").to_string_lossy().into_owned();
        scenes.extend(load(file).ok().map(|scene| (name, scene)));
    }
    let size = ImageSize::new(SIDE, SIDE).expect("a size");
    let mut scenes: Vec<(String, Scene)> =
        scenes.into_iter().map(|(name, scene)| (name, scene.with_size(size))).collect();
    scenes.retain(|(name, scene)| {
        wanted.is_none_or(|wanted| name.contains(wanted))
            && scene.has_lights()
            && range::check(scene, &Viewpoint::of(scene), Arithmetic::Single).is_ok()
    });
    scenes
}

/// Scene files of a folder, by name.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder).expect("the repository's scenes");
    let mut files: Vec<PathBuf> = entries.map(|entry| entry.expect("a file").path()).collect();
    files.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    files.sort();
    files
}

fn main() -> ExitCode {
    let rounds = options::count("--rounds").unwrap_or(13);
    let adapter = options::adapter();
    let scenes = scenes(options::option("--scene").as_deref());
    println!("{} ({}), {rounds} rounds\n", adapter.name(), adapter.driver());
    let slower = print_saved(&scenes, &adapter, rounds);
    print_costs(&scenes[..scenes.len().min(2)], &adapter, rounds);
    if slower.is_empty() {
        return ExitCode::SUCCESS;
    }
    eprintln!("The specialised kernel is slower: {}", slower.join("; "));
    ExitCode::FAILURE
}

fn with_estimator(scene: &Scene, estimator: Estimator) -> Scene {
    scene.clone().with_settings(scene.settings().with_estimator(estimator))
}

/// Prints what the specialised kernel takes of the general one's time; says where it is slower.
fn print_saved(scenes: &[(String, Scene)], adapter: &Adapter, rounds: u64) -> Vec<String> {
    println!("Specialised ÷ general:\n\n{}", head("scene"));
    let mut slower = Vec::new();
    for (name, scene) in scenes {
        print!("| {name} |");
        for estimator in Estimator::ALL {
            let scene = with_estimator(scene, estimator);
            let own = Effects::of(&scene, &Viewpoint::of(&scene));
            let ratios = ratios(&scene, adapter, [Effects::general(&scene), own], rounds);
            print!(" {} |", Middle::of(&ratios));
            if ratios.iter().all(|&ratio| ratio > 1.0 + SAME) {
                slower.push(format!("{name} under {}", estimator.name()));
            }
        }
        println!();
    }
    slower
}

/// Prints what a kernel with one effect more takes of the specialised kernel's time.
fn print_costs(scenes: &[(String, Scene)], adapter: &Adapter, rounds: u64) {
    for (name, scene) in scenes {
        println!("\nWith one effect more ÷ specialised, {name}:\n\n{}", head("effect"));
        for effect in Effect::all() {
            let cells = Estimator::ALL.map(|estimator| {
                let scene = with_estimator(scene, estimator);
                let own = Effects::of(&scene, &Viewpoint::of(&scene));
                if own.has(effect) || !Effects::general(&scene).has(effect) {
                    return String::new();
                }
                let ratios = ratios(&scene, adapter, [own, own.with(effect)], rounds);
                Middle::of(&ratios).to_string()
            });
            if cells.iter().any(|cell| !cell.is_empty()) {
                println!("| {effect:?} | {} |", cells.join(" | "));
            }
        }
    }
}

fn head(first: &str) -> String {
    let names = Estimator::ALL.map(|estimator| format!("`{}`", estimator.name()));
    format!("| {first} | {} |\n|---|---|---|---|---|", names.join(" | "))
}
