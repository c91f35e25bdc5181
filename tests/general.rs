//! The kernel that a scene calls for and the general one, which searches a hierarchy in storage
//! buffers however few the spheres are, give the same bits: on every scene of the repository
//! that a device takes, and on those of the sweep.

#![expect(clippy::single_range_in_vec_init, reason = "one range of samples")]

mod support {
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::effects::Effects;
use candor::film::Film;
use candor::kernel::Kernel;
use candor::range::{self, Arithmetic};
use candor::scene::{Estimator, Scene, load};
use candor::viewpoint::Viewpoint;
use std::path::Path;
use support::scenes::{packed, size};
use support::tracers::{film, general, on_device, with_effects, with_kernel};

const SAMPLES: u64 = 4;

/// The scenes of a folder that are valid, with their names.
fn scenes_of(folder: &str) -> Vec<(String, Scene)> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<_> = folder
        .read_dir()
        .expect("the repository's scenes")
        .map(|entry| entry.expect("a file").path())
        .filter(|path| path.extension().is_some_and(|extension| extension == "toml"))
        .collect();
    paths.sort();
    let named = |path: &Path| path.file_stem().map(|name| name.to_string_lossy().into_owned());
    paths.iter().filter_map(|path| Some((named(path)?, load(path).ok()?))).collect()
}

fn scenes() -> Vec<(String, Scene)> {
    let mut scenes = scenes_of("scenes");
    scenes.extend(scenes_of("scenes/hard"));
    let is_taken = |scene: &Scene| range::check(scene, Arithmetic::Device).is_ok();
    scenes.retain(|(_, scene)| is_taken(scene));
    scenes
}

fn under(scene: &Scene, estimator: Estimator) -> Scene {
    let settings = scene.settings().with_estimator(estimator);
    scene.clone().with_size(size(16, 16)).with_settings(settings)
}

fn special(scene: &Scene) -> Film {
    film(&mut on_device(scene), &[0..SAMPLES])
}

fn by_general(scene: &Scene) -> Film {
    film(&mut with_effects(scene, general(scene)), &[0..SAMPLES])
}

#[test]
fn every_scene_of_the_repository_has_the_general_kernels_bits() {
    let scenes = scenes();
    assert!(scenes.len() > 25, "{} scenes", scenes.len());
    let mut lit = 0;
    for (name, scene) in &scenes {
        for estimator in Estimator::ALL {
            let scene = under(scene, estimator);
            let started = std::time::Instant::now();
            let film = special(&scene);
            assert!(by_general(&scene) == film, "{name}, {}", estimator.name());
            lit += usize::from(film.pixels().iter().flatten().any(|&word| word > 0));
            println!("{name} {} {:?}", estimator.name(), started.elapsed());
        }
    }
    println!("{} scenes, {lit} pictures with light", scenes.len());
}
