//! Random valid scenes, on both tracers: never a panic, never an invalid sample, and the
//! means agree.
//!
//! Both trace the same random numbers, so that a path differs only by rounding, or where
//! rounding sends it elsewhere. Such a parting may change a sample by as much as a sample can
//! be, and no variance is known beforehand. But where neither tracer is biased its sign is a
//! coin's, and then, however the sizes are spread, the differences d of independent pixels have
//! P(|Σd| ≥ x√Σd²) ≤ 2exp(−x²/2) (Efron 1969, *JASA* 64:1278, from Hoeffding's inequality for
//! signs). A scene fails where |Σd| exceeds that and the bias that `verify` grants a device.

#![expect(clippy::cast_precision_loss, reason = "exact sums become statistics")]

mod support {
    pub mod gpu;
    pub mod recipe;
    pub mod scenes;
    pub mod tracers;
}

use candor::film::{Film, sums};
use candor::gpu::GpuTracer;
use candor::scene::{Scene, parse};
use candor::tracer::Tracer;
use candor::verify::{ALPHA, MAX_BIAS};
use candor::{bound, cpu::CpuTracer};
use proptest::prelude::{ProptestConfig, Strategy};
use proptest::test_runner::{RngAlgorithm, TestCaseError, TestRng, TestRunner};
use std::cell::{Cell, RefCell};
use support::gpu;
use support::recipe::{Recipe, recipes};


/// Sides of the pictures, and samples per pixel.
const SIDE: u32 = 12;
const SAMPLES: u64 = 8;

/// Scenes per test.
const CASES: u32 = 384;

/// Decades that radii and distances lie within, 10^-6 to 10^6 ...
const WIDE: f64 = 6.0;

/// The scene of a recipe, if candor takes it.
fn scene(recipe: &Recipe) -> Option<Scene> {
    let scene = parse("scene.toml", &recipe.toml(SIDE)).ok()?;
    bound::check(&scene).is_ok().then_some(scene)
}

/// Runs `holds` for scenes that are the same on every run; the shrunk one that fails is
/// printed as a scene file. Returns how many were valid.
fn for_random_scenes(
    decades: f64,
    cases: u32,
    holds: impl Fn(&Scene) -> Result<(), String>,
) -> Result<u32, String> {
    let config = ProptestConfig { cases, failure_persistence: None, ..ProptestConfig::default() };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let valid = Cell::new(0);
    let recipes = recipes(decades).prop_map(|recipe| Readable { toml: recipe.toml(SIDE), recipe });
    TestRunner::new_with_rng(config, rng)
        .run(&recipes, |Readable { recipe, .. }| {
            let Some(scene) = scene(&recipe) else { return Ok(()) };
            valid.set(valid.get() + 1);
            holds(&scene).map_err(TestCaseError::fail)
        })
        .map_err(|error| error.to_string())?;
    Ok(valid.get())
}

/// A recipe that shows itself as the file that a user can load.
#[derive(Clone)]
struct Readable {
    recipe: Recipe,
    toml: String,
}

impl std::fmt::Debug for Readable {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "this scene:\n{}", self.toml)
    }
}

/// The film of a tracer, which may have no invalid sample.
fn film(tracer: &mut dyn Tracer) -> Result<Film, String> {
    tracer.add_samples(0..SAMPLES).map_err(|error| error.to_string())?;
    let ledger = tracer.ledger().map_err(|error| error.to_string())?;
    if ledger.count > 0 {
        return Err(format!("invalid samples: {ledger:?}"));
    }
    tracer.film().map_err(|error| error.to_string())
}

/// The films of device and twin, of the same samples; `None` where a tracer takes no such
/// scene.
fn films(scene: &Scene) -> Result<Option<[Film; 2]>, String> {
    let (Ok(mut device), Ok(mut twin)) =
        (GpuTracer::new(scene, gpu::open()), CpuTracer::new(scene, None))
    else {
        return Ok(None);
    };
    let device = film(&mut device).map_err(|reason| format!("device: {reason}"))?;
    let twin = film(&mut twin).map_err(|reason| format!("twin: {reason}"))?;
    Ok(Some([device, twin]))
}

/// One channel of two films of the same samples, summed over pixels, in film steps.
#[derive(Debug, Clone, Copy, Default)]
struct Parting {
    reference: f64,
    difference: f64,
    squares: f64,
}

impl Parting {
    fn of(device: &Film, twin: &Film, channel: usize) -> Self {
        let mut parting = Self::default();
        for (ours, theirs) in std::iter::zip(device.pixels(), twin.pixels()) {
            let (ours, theirs) = (sums(ours)[channel], sums(theirs)[channel]);
            let size = ours.abs_diff(theirs) as f64;
            parting.reference += theirs as f64;
            parting.difference += if ours < theirs { -size } else { size };
            parting.squares += size * size;
        }
        parting
    }

    /// Whether the means differ, certainly at the level `alpha`.
    fn differs(&self, alpha: f64) -> bool {
        let most = (2.0 * (2.0 / alpha).ln()).sqrt();
        self.difference.abs() > MAX_BIAS * self.reference + most * self.squares.sqrt()
    }
}

/// Whether a scene's channels agree, of `CASES` scenes.
fn agree([device, twin]: &[Film; 2]) -> Result<(), String> {
    for channel in 0..3 {
        let parting = Parting::of(device, twin, channel);
        if channel == 0 { println!("bias {:+.2e} T {:+.2} ref {:.1e}", parting.difference/parting.reference, parting.difference/parting.squares.sqrt(), parting.reference); }
        if parting.differs(ALPHA / f64::from(3 * CASES)) {
            return Err(format!("channel {channel}: the means differ: {parting:?}"));
        }
    }
    Ok(())
}

#[test]
fn no_scene_panics_or_has_an_invalid_sample_and_the_means_agree() {
    let failures = RefCell::new(Vec::new());
    let valid = for_random_scenes(WIDE, CASES, |scene| {
        if let Some(films) = films(scene)? {
            agree(&films)?;
        }
        Ok(())
    })
    .map_err(|e| failures.borrow_mut().push(e));
    println!("valid {valid:?} {}", failures.borrow().join("\n"));
    assert!(failures.borrow().is_empty());
}
