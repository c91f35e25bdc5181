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
use candor::scene::{Estimator, Scene, load};
use candor::sweep::{Case, cases};
use rayon::prelude::*;
use std::path::Path;
use support::scenes::size;
use support::tracers::{film, kernel, on_device, trace, with_effects, with_kernel};

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
    film(&mut with_effects(scene, Effects::general(scene)), &[0..SAMPLES])
}

/// Whether the two kernels give the same film, and whether there is light in it.
fn compare(name: &str, scene: &Scene) -> bool {
    let film = special(scene);
    let (estimator, spheres) = (scene.settings().estimator().name(), scene.spheres().len());
    assert!(by_general(scene) == film, "{name}, {estimator}, {spheres} spheres");
    film.pixels().iter().flatten().any(|&word| word > 0)
}

#[test]
fn every_scene_of_the_repository_has_the_general_kernels_bits() {
    let scenes = scenes();
    assert!(scenes.len() > 25, "{} scenes", scenes.len());
    let of_all = |(name, scene): &(String, Scene)| {
        Estimator::ALL.into_iter().filter(|&e| compare(name, &under(scene, e))).count()
    };
    let lit: usize = scenes.par_iter().map(of_all).sum();
    println!("{} scenes, {lit} pictures with light", scenes.len());
    assert!(lit > 3 * scenes.len(), "pictures of nothing agree");
}

#[test]
fn scenes_of_the_sweep_have_the_general_kernels_bits() {
    let cases = cases().expect("the classic scene");
    let of_mis = |case: &&Case| compare(case.group, &under(&case.scene, Estimator::Mis));
    let lit = cases.par_iter().filter(of_mis).count();
    println!("{} scenes, {lit} pictures with light", cases.len());
    assert!(lit > 0);
}

/// One effect of the special kernel, wrong by little: where it is called for, the general one
/// does not have its bits.
#[test]
fn a_fault_in_one_effect_is_told() {
    use Estimator::{Explicit, Implicit, Mis};
    let faults = [
        ("two-spheres", Implicit, "2.0 * polar.y", "2.0000002 * polar.y"),
        ("two-spheres", Mis, "+ 2.0 * offset", "+ 2.0000002 * offset"),
        ("15-uniform-lobe", Implicit, "(exponent + 1.0))", "(exponent + 1.001))"),
        ("09-integrating-sphere", Mis, "2.0 * abs(q.b)", "2.0000002 * abs(q.b)"),
        ("25-lamps-touch-and-overlap", Explicit, "0.5 * (potential", "0.5000001 * (potential"),
        ("particles", Explicit, "t.y < t.x)", "t.y > t.x)"),
        ("particles", Explicit, "return t < distance ||", "return t > distance ||"),
    ];
    let scenes = scenes();
    for (name, estimator, from, to) in faults {
        let scene = &scenes.iter().find(|scene| scene.0 == name).expect("a scene").1;
        let scene = under(scene, estimator);
        let text = kernel(&scene);
        assert_eq!(text.matches(from).count(), 1, "{name}: {from}");
        let (wrong, ledger) =
            trace(&mut with_kernel(&scene, &text.replace(from, to)), &[0..SAMPLES]);
        let told = ledger.count > 0 || wrong != by_general(&scene);
        assert!(told, "{name}: {to}");
    }
}
