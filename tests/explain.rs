//! What is explained of a scene's kernel: the judges on made-up numbers, spheres by name, and
//! text and sizes that naga confirms.

mod support {
    pub mod gpu;
    pub mod scenes;
}

use candor::bound::sample_scale;
use candor::cost::Measured;
use candor::effects::{Effect, Effects, left_out};
use candor::explain::{Agreement, Explanation, NAMED, Saving, Version};
use candor::film::{Film, SampleRanges};
use candor::gpu::{GpuTracer, device_parts};
use candor::kernel::{spirv, validate};
use candor::scene::{Estimator, Scene};
use candor::viewpoint::Viewpoint;
use support::scenes::{classic, diffuse, emitter, many, seen, size, sphere};

fn under(scene: Scene, estimator: Estimator) -> Scene {
    let settings = scene.settings().with_estimator(estimator);
    scene.with_settings(settings)
}

fn explained(scene: &Scene) -> Explanation {
    let (viewpoint, [specialised, general]) = (Viewpoint::of(scene), versions(scene));
    Explanation::of(scene, &viewpoint, &specialised, &general).expect("both kernels are valid")
}

/// The special kernel and the general one.
fn versions(scene: &Scene) -> [Version; 2] {
    let viewpoint = Viewpoint::of(scene);
    [Version::specialised(scene, &viewpoint), Version::general(scene, &viewpoint)]
}

/// A 30 % saving among rounds that vary by more is none; the same saving in quiet rounds is one,
/// and so is a loss. The bounds are those of the order statistics of nine values (2nd and 8th).
#[test]
fn a_saving_inside_the_noise_is_none() {
    let judged = |ratios: &[f64]| Saving::of(Measured::median(ratios).expect("enough rounds"));
    let noisy = [0.7, 0.5, 0.4, 1.3, 0.7, 1.6, 0.6, 1.2, 0.7];
    assert_eq!(judged(&noisy), Saving::None);
    let quiet = [0.70, 0.71, 0.69, 0.70, 0.72, 0.68, 0.70, 0.71, 0.69];
    let Saving::Saves(share) = judged(&quiet) else { panic!("30 % in quiet rounds is a saving") };
    assert!((share.value - 0.3).abs() < 1e-12);
    assert!((share.low - 0.29).abs() < 1e-12 && (share.high - 0.31).abs() < 1e-12, "{share:?}");
    let Saving::Costs(share) = judged(&quiet.map(|ratio| 1.0 / ratio)) else { panic!("a loss") };
    assert!(share.low > 0.0 && share.low <= share.value && share.value <= share.high);
    // An interval that ends at 1 holds it.
    let edge = Measured { value: 0.9, low: 0.8, high: 1.0 };
    assert_eq!(Saving::of(edge), Saving::None);
}

/// One bit of one pixel is a difference in software, and rounding on hardware; a picture with no
/// light in it beside one with some is a difference anywhere.
#[test]
fn films_are_held_against_each_other() {
    let scene = classic(size(4, 4));
    let film = |value: u32| {
        let mut samples = SampleRanges::default();
        samples.insert(0..4).expect("four samples");
        let mut film = Film::awaiting(scene.size(), sample_scale(&scene), samples);
        for pixel in film.pixels_mut() {
            for channel in 0..3 {
                pixel[3 * channel + 1] = value;
            }
        }
        film
    };
    let (ours, mut other) = (film(1 << 20), film(1 << 20));
    assert_eq!(Agreement::of(&ours, &other, true), Agreement::SameBits);
    other.pixels_mut()[3][0] ^= 1;
    assert_eq!(Agreement::of(&ours, &other, true), Agreement::Differ);
    assert_eq!(Agreement::of(&ours, &other, false), Agreement::UpToRounding);
    assert_eq!(Agreement::of(&film(0), &ours, false), Agreement::Differ);
}

#[test]
fn spheres_are_named_and_the_others_counted() {
    let mut spheres = vec![sphere([0.0, 9.0, 0.0], 1.0, emitter([1.0; 3])).named("lamp")];
    for i in 0..5_u32 {
        let ball = sphere([3.0 * f64::from(i), 0.0, 0.0], 1.0, diffuse(0.5));
        spheres.push(if i == 0 { ball.named("ball") } else { ball });
    }
    let explanation = explained(&seen([0.0, 1.0, 20.0], [0.0, 0.0, 0.0], size(8, 8), 2, spheres));
    let of = |effect: Effect| &explanation.effects[effect as usize];
    let diffuse = of(Effect::Diffuse);
    assert_eq!((diffuse.called_for, diffuse.spheres, diffuse.named.len()), (true, 5, NAMED));
    assert_eq!(diffuse.sentence(), "paths scatter at ball, sphere 3, sphere 4 and 2 more");
    let glossy = of(Effect::Glossy);
    assert_eq!((glossy.called_for, glossy.sentence().as_str()), (false, "no glossy sphere"));
    assert_eq!(of(Effect::Connections).sentence(), "the estimator samples no lights");
}

/// Each effect is called for or left out for a reason, as the kernel has it or not.
#[test]
fn reasons_are_those_of_the_kernel() {
    for estimator in Estimator::ALL {
        for bounces in [0, 2] {
            for scene in [classic(size(8, 8)), many(size(8, 8))] {
                let settings = scene.settings().with_estimator(estimator);
                let settings = settings.with_bounces(bounces).expect("a few bounces");
                let scene = scene.with_settings(settings);
                let viewpoint = Viewpoint::of(&scene);
                let effects = Effects::of(&scene, &viewpoint);
                for effect in Effect::all() {
                    let why = left_out(effect, &scene, &viewpoint);
                    assert_eq!(effects.has(effect), why.is_none(), "{effect:?}: {why:?}");
                    assert!(!effects.has(effect) || Effects::general(&scene).has(effect));
                }
                if bounces == 0 {
                    let why = left_out(Effect::Diffuse, &scene, &viewpoint);
                    assert_eq!(why, Some("no bounces"));
                }
            }
        }
    }
}

/// naga reads both kernels, and what it writes begins with SPIR-V's magic number and version
/// (specification, section 2.3); a text that is no kernel is refused.
#[test]
fn kernels_are_valid_and_measured() {
    for estimator in Estimator::ALL {
        for scene in [classic(size(8, 8)), many(size(8, 8))] {
            let scene = under(scene, estimator);
            let explanation = explained(&scene);
            let facts = [&explanation.specialised, &explanation.general];
            for (version, facts) in versions(&scene).into_iter().zip(facts) {
                let wgsl = version.kernel.wgsl();
                let (module, _) = validate(&wgsl).expect("a valid kernel");
                assert_eq!(facts.functions, module.functions.len() + 1);
                let words = spirv(&wgsl).expect("SPIR-V");
                assert_eq!(words[..2], [0x0723_0203, 0x0001_0600]);
                assert_eq!((facts.wgsl_bytes, facts.spirv_bytes), (wgsl.len(), 4 * words.len()));
            }
            assert!(explanation.specialised.spirv_bytes < explanation.general.spirv_bytes);
        }
    }
    assert!(spirv("fn broken( {").is_err());
}

/// The parts add up to what the tracer allocates.
#[test]
fn bytes_on_the_device_are_those_of_the_tracer() {
    for scene in [classic(size(40, 30)), many(size(7, 5))] {
        for version in versions(&scene) {
            let parts = device_parts(&version.packed, scene.size());
            let wgsl = version.kernel.wgsl();
            let tracer =
                GpuTracer::with_kernel(&scene, support::gpu::open(), &version.packed, &wgsl)
                    .expect("it fits");
            let sum: u64 = parts.iter().map(|(_, bytes)| bytes).sum();
            assert_eq!(sum, tracer.device_bytes(), "{parts:?}");
        }
    }
}
