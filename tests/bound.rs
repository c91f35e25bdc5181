//! The bound on one sample: by hand, and against samples of scenes made to come near it.

#![expect(clippy::cast_possible_truncation, reason = "bounds are compared as f32")]

mod support {
    pub mod gpu;
    pub mod light_scenes;
    pub mod scenes;
    pub mod tracers;
}

use candor::bound::sample_scale;
use candor::cpu::{PreparedScene, SampleKey, trace};
use candor::gpu::GpuTracer;
use candor::kernel::{Packed, layout};
use candor::scene::Estimator::{self, Cosine, Explicit, Implicit, Mis};
use candor::scene::{Scene, Sphere, Surface};
use candor::tracer::Tracer;
use support::light_scenes::{forty_lights, hollow, in_light, lamp_layer};
use support::scenes::{diffuse, emitter, glossy, packed, seen, size, sphere};
use support::tracers::kernel;

fn under(scene: &Scene, estimator: Estimator, bounces: u32) -> Scene {
    let settings = scene.settings().with_bounces(bounces).expect("a few bounces");
    scene.clone().with_settings(settings.with_estimator(estimator))
}

/// Surfaces side by side in front of the camera.
fn row_of(surfaces: &[Surface]) -> Scene {
    let places = std::iter::successors(Some(0.0), |x| Some(x + 3.0));
    let spheres: Vec<Sphere> =
        surfaces.iter().zip(places).map(|(&s, x)| sphere([x, 0.0, 0.0], 1.0, s)).collect();
    seen([0.0, 0.0, 9.0], [0.0; 3], size(8, 8), 2, spheres)
}

/// Lights of 10 and 2, chalk of 0.75, gloss of 0.9; 200 lights of 1.5 over chalk of 0.8 and
/// gloss of 0.9. Roundings take less than 2⁻¹⁵.
#[test]
fn bounds_by_hand() {
    let (lamp, dim, chalk, gloss) =
        (emitter([10.0, 1.0, 0.0]), emitter([0.0, 2.0, 1.0]), diffuse(0.75), glossy(0.9, 3.0));
    let one = row_of(&[lamp, chalk]);
    let both = row_of(&[lamp, dim, chalk, gloss]);
    let mirrors = row_of(&[lamp, gloss]);
    let lamps = lamp_layer(200, 0.0);
    let expected = [
        (&one, Cosine, 2, 10.0),
        // 2·0.75·10 at each of two vertices, 0.75 before the second; then 0.75·10.
        (&one, Explicit, 2, 15.0 + 0.75 * 15.0 + 7.5),
        (&one, Explicit, 0, 10.0),
        // Half of 0.75·10 at the first, of 0.75²·10 at the second, and a light that is hit.
        (&one, Mis, 2, 3.75 + 2.8125 + 7.5),
        // 4·0.75·(10 + 2), 0.9 before the second.
        (&both, Explicit, 2, 36.0 + 0.9 * 36.0 + 9.0),
        (&both, Mis, 1, 4.5 + 9.0),
        (&both, Implicit, 2, 10.0 * 1.5 * 1.5),
        // No chalk, no connection.
        (&mirrors, Explicit, 5, 10.0),
        (&mirrors, Mis, 2, 4.5 + 4.05 + 9.0),
        // Half of an even chance: 4·0.8·200·1.5.
        (&lamps, Explicit, 2, 960.0 + 0.9 * 960.0 + 1.35),
        (&lamps, Mis, 1, 0.675 + 1.35),
    ];
    for (scene, estimator, bounces, bound) in expected {
        let found = f64::from(sample_scale(&under(scene, estimator, bounces)).bound());
        let excess = found / bound - 1.0;
        let what = format!("{estimator:?}, {bounces} bounces: {found} for {bound}");
        assert!((0.0..f64::from(1 << 15).recip()).contains(&excess), "{what}");
    }
}

/// A surface of albedo 1 under a light so near and so large that it fills half the sky.
fn sky(surface: Surface) -> Scene {
    let spheres = vec![
        sphere([0.0, -1e4, 0.0], 1e4, surface),
        sphere([0.0, 1e6 + 4.0, 0.0], 1e6, emitter([3.0, 2.0, 1.0])),
    ];
    seen([0.0, 2.0, 0.1], [0.0, 0.0, 0.0], size(8, 8), 1, spheres)
}

/// In two lights of equal power, one around the other, each of which fills every view.
fn shells(surface: Surface) -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 1.0, surface),
        sphere([0.0, 0.0, 0.0], 9.0, emitter([3.0; 3])),
        sphere([0.0, 0.0, 0.0], 10.0, emitter([3.0; 3])),
    ];
    seen([0.0, 0.0, 2.0], [0.0, 0.0, 0.0], size(8, 8), 1, spheres)
}

const SAMPLES: u64 = 1024;

/// The largest of the twin's samples.
fn largest(scene: &Scene) -> f64 {
    let prepared = PreparedScene::new(scene);
    let addresses = (0..scene.size().pixels())
        .flat_map(|pixel| (0..SAMPLES).map(move |index| SampleKey { pixel, index }));
    addresses.map(|key| trace(&prepared, key).max_element()).fold(0.0, f64::max)
}

/// How many of the device's samples exceed `bound`.
fn above(scene: &Scene, bound: f32) -> u64 {
    let packed = packed(scene);
    let header = layout::Scene { bound_bits: bound.to_bits(), ..packed.scene };
    let below = Packed { scene: header, ..packed };
    let mut tracer = GpuTracer::with_kernel(scene, support::gpu::open(), &below, &kernel(scene))
        .expect("the device takes the scene");
    tracer.add_samples(0..SAMPLES).expect("the device traces");
    tracer.ledger().expect("a ledger").count
}

/// No sample exceeds its bound, on the device and in the twin; the largest comes as near as
/// `share`, which follows from the scene.
#[test]
fn samples_come_near_their_bound_and_stay_below() {
    let chalk = diffuse(1.0);
    let cases = [
        // 2cosθ of 2, and a weight of 1.
        ("chalk under a sky", sky(chalk), Implicit, 1, 0.99),
        ("chalk under a sky", sky(chalk), Cosine, 1, 0.999),
        // 2hcosθ of 2 + 1: the light after a glossy surface, which is not here, is counted.
        ("chalk under a sky", sky(chalk), Explicit, 1, 0.65),
        // x/(1 + x²) of a light, at most ½, and x²/(1 + x²) of a hit, x = 2cosθ: 1.3 of 1.5.
        ("chalk under a sky", sky(chalk), Mis, 1, 0.84),
        // The same with x up to 11.
        ("gloss under a sky", sky(glossy(1.0, 10.0)), Mis, 1, 0.95),
        // 2cosθ over a chance of ½, of 4·2 + 1.
        ("chalk in two shells", shells(chalk), Explicit, 1, 0.43),
        // x = 4cosθ: ½ + 16/17 of 1.5.
        ("chalk in two shells", shells(chalk), Mis, 1, 0.93),
        ("hollow", hollow(8), Explicit, 8, 0.01),
        ("hollow", hollow(8), Mis, 8, 0.1),
        ("in a light", in_light(), Explicit, 3, 0.08),
        ("in a light", in_light(), Mis, 3, 0.1),
        ("forty lamps", forty_lights(), Explicit, 2, 0.01),
        ("forty lamps", forty_lights(), Mis, 2, 0.1),
        ("200 lamps", lamp_layer(200, 1.0), Explicit, 2, 0.001),
        ("200 lamps", lamp_layer(200, 1.0), Mis, 2, 0.1),
    ];
    for (name, scene, estimator, bounces, share) in cases {
        let scene = under(&scene.with_size(size(8, 8)), estimator, bounces);
        let bound = sample_scale(&scene).bound();
        let reached = largest(&scene) / f64::from(bound);
        let near = (share * f64::from(bound)) as f32;
        let (over, nearly) = (above(&scene, bound), above(&scene, near));
        println!(
            "{name:<20}{:<10}{reached:>7.3} of {bound}, {nearly} samples near",
            estimator.name()
        );
        assert!((share..=1.0).contains(&reached), "{name}, {estimator:?}: {reached} of {bound}");
        assert!(over == 0 && nearly > 0, "{name}, {estimator:?}: {over} above, {nearly} near");
    }
}
