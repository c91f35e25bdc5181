//! Random valid scenes, on both tracers: never a panic, never an invalid sample, and the
//! means agree.
//!
//! Both trace the same random numbers, so that a path differs only by rounding, or where
//! rounding sends it elsewhere. Such a parting may change a sample by as much as a sample can
//! be, and no variance is known beforehand. If a parting is as likely to gain as to lose the same
//! amount, then, however the sizes are spread, the differences d of independent pixels have
//! P(|Σd| ≥ x√Σd²) ≤ 2exp(−x²/2) (Efron 1969, *JASA* 64:1278, from Hoeffding's inequality for
//! signs). That symmetry is an assumption: rounding that falls either way has it, and a mean of
//! zero alone is not enough. A scene in the declared range fails where |Σd| exceeds that and the bias that `verify` grants a device.

#![expect(clippy::cast_precision_loss, reason = "exact sums become statistics")]

mod support {
    pub mod gpu;
    pub mod recipe;
    pub mod scenes;
    pub mod tracers;
}

use candor::bound;
use candor::cpu::CpuTracer;
use candor::film::{Film, sums};
use candor::gpu::GpuTracer;
use candor::range::{self, Arithmetic};
use candor::scene::{Scene, parse};
use candor::tracer::Tracer;
use candor::verify::{ALPHA, MAX_BIAS};
use candor::viewpoint::Viewpoint;
use proptest::prelude::{ProptestConfig, Strategy};
use proptest::test_runner::{RngAlgorithm, TestCaseError, TestRng, TestRunner};
use std::cell::Cell;
use support::gpu;
use support::recipe::{Recipe, recipes};
use support::tracers::{kernel, with_kernel};

/// Sides of the pictures, and samples per pixel.
const SIDE: u32 = 16;
const SAMPLES: u64 = 32;

/// Scenes per test.
const CASES: u32 = 96;

/// Scenes of which one must show a fault.
const FAULTY_CASES: u32 = 1500;

/// Simpler scenes that are tried where one fails.
const SHRINKS: u32 = 64;

/// Radii and distances lie within 10^-6 to 10^6.
const DECADES: f64 = 6.0;

/// The scene of a recipe, if candor takes it.
fn scene(recipe: &Recipe) -> Option<Scene> {
    let scene = parse("scene.toml", &recipe.toml(SIDE)).ok()?;
    bound::check(&scene).is_ok().then_some(scene)
}

/// Runs `holds` for scenes that are the same on every run; the shrunk one that fails is
/// printed as a scene file. Returns how many were valid.
fn for_random_scenes(
    cases: u32,
    holds: impl Fn(&Scene) -> Result<(), String>,
) -> Result<u32, String> {
    let config = ProptestConfig {
        cases,
        max_shrink_iters: SHRINKS,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    let rng = TestRng::deterministic_rng(RngAlgorithm::ChaCha);
    let valid = Cell::new(0);
    let recipes = recipes(DECADES).prop_map(|recipe| Readable { toml: recipe.toml(SIDE), recipe });
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

/// What puts a scene on the device; `None` where the device takes no such scene.
type Device = fn(&Scene) -> Option<GpuTracer>;

fn device(scene: &Scene) -> Option<GpuTracer> {
    GpuTracer::new(scene, gpu::open()).ok()
}

/// A device whose diffuse and glossy surfaces all reflect `factor` times as much as they should.
fn reflecting(scene: &Scene, factor: &str) -> Option<GpuTracer> {
    let wgsl = kernel(scene);
    // In paths that run into light, and in those that sample it.
    let (blind, connected) =
        ("*= scattering.weight * color", "let throughput = (*path).throughput");
    let wrong = wgsl
        .replace(blind, &format!("{blind} * {factor}"))
        .replace(connected, &format!("{connected} * {factor}"));
    (wrong != wgsl).then(|| with_kernel(scene, &wrong))
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

/// What must hold for a scene: valid samples on both, and where it is in the declared range
/// of both, means that agree. Returns whether any light was seen.
fn holds(scene: &Scene, device: Device) -> Result<bool, String> {
    let Some(mut device) = device(scene) else { return Ok(false) };
    let mut twin = CpuTracer::new(scene, None).map_err(|error| error.to_string())?;
    let device = film(&mut device).map_err(|reason| format!("device: {reason}"))?;
    let twin = film(&mut twin).map_err(|reason| format!("twin: {reason}"))?;
    let viewpoint = Viewpoint::of(scene);
    let in_range = [Arithmetic::Single, Arithmetic::Double]
        .into_iter()
        .all(|arithmetic| range::check(scene, &viewpoint, arithmetic).is_ok());
    for channel in 0..3 {
        let parting = Parting::of(&device, &twin, channel);
        if in_range && parting.differs(ALPHA / f64::from(3 * CASES)) {
            return Err(format!("channel {channel}: the means differ: {parting:?}"));
        }
    }
    Ok(in_range && Parting::of(&device, &twin, 0).reference > 0.0)
}

#[test]
fn no_sample_of_random_scenes_is_invalid_and_the_means_agree() {
    let lit = Cell::new(0);
    let valid = for_random_scenes(CASES, |scene| {
        holds(scene, device).map(|seen| lit.set(lit.get() + u32::from(seen)))
    });
    let valid = valid.unwrap_or_else(|error| panic!("{error}"));
    println!("of {CASES} scenes, {valid} are valid; {} in range show light", lit.get());
    assert!(valid >= CASES / 2 && lit.get() >= CASES / 8, "too few to say anything");
}

/// The first scene that shows the fault ends the search, made simpler and as a file.
#[test]
fn devices_that_are_wrong_are_found() {
    let faults: [(Device, &str); 2] = [
        (|scene| reflecting(scene, "0.9"), "the means differ"),
        (|scene| reflecting(scene, "-1.0"), "invalid samples"),
    ];
    for (device, reason) in faults {
        let error = for_random_scenes(FAULTY_CASES, |scene| holds(scene, device).map(drop))
            .expect_err(reason);
        assert!(error.contains(reason), "{error}");
        assert!(error.contains("[[spheres]]"), "no scene to load: {error}");
    }
}
