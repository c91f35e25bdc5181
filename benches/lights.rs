//! What picking a light takes and brings, from 10 lights to 100,000: scanned and by a walk
//! down the tree, in turns and as medians:
//! `cargo bench --bench lights [-- --rounds N --device NAME --estimator E]`.
//!
//! A layer of lamps hangs over a floor with balls on it, which the camera looks at from under the
//! layer; the lamps' surface and power are the same in all for any number of them. Efficiency is one over error² times time, as a ratio to
//! the scan's.

#![allow(clippy::cast_precision_loss, reason = "rates and ratios for show")]

#[path = "support/options.rs"]
mod options;
#[path = "support/turns.rs"]
mod turns;

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::effects::{Effect, Effects};
use candor::estimate::summarize;
use candor::gpu::{Adapter, GpuTracer};
use candor::light_tree::LightTree;
use candor::scene::{
    Albedo, Camera, Estimator, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface,
};
use candor::tracer::Tracer;
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use std::time::Instant;

/// Numbers of lamps.
const COUNTS: [u32; 10] = [10, 30, 64, 128, 256, 500, 1000, 3000, 10_000, 100_000];

/// More of them are not scanned: the loops would come near lavapipe's limit.
const MOST_SCANNED: u32 = 3000;

/// Pixels of a side.
const SIDE: u32 = 64;

fn main() {
    let rounds = options::count("--rounds").unwrap_or(7);
    let adapter = options::adapter();
    let estimator = options::option("--estimator")
        .map_or(Estimator::Mis, |name| name.parse().expect("--estimator takes explicit or mis"));
    println!("{} ({}), {}, {rounds} rounds", adapter.name(), adapter.driver(), estimator.name());
    println!(
        "{:>8} {:>12} {:>12} {:>12} {:>12} {:>14} {:>11}",
        "lamps", "scan, ns", "walk, ns", "error²·spp", "of the walk", "efficiency", "tree, ms"
    );
    for count in COUNTS {
        println!("{}", row(&lamps(count, estimator), count, &adapter, rounds));
    }
}

/// A floor, a hundred balls and a layer of lamps.
fn lamps(count: u32, estimator: Estimator) -> Scene {
    let place = |pixel, index: u32, height: f64| {
        let key = SampleKey { pixel, index: u64::from(index) };
        let [x, y, z, _] = random_bits(key, 0, 0).map(unit_float);
        DVec3::new(8.0 * x - 4.0, height + 0.2 * y, 8.0 * z - 4.0)
    };
    let diffuse = Surface::Diffuse(Albedo::new(DVec3::splat(0.7)).expect("an albedo"));
    let light = Surface::Emitter(Radiance::new(DVec3::splat(20.0)).expect("a radiance"));
    let mut spheres = vec![(DVec3::new(0.0, -1e4, 0.0), 1e4, diffuse)];
    spheres.extend((0..100).map(|i| (place(1, i, 0.1), 0.2, diffuse)));
    let radius = 0.5 / f64::from(count).sqrt();
    spheres.extend((0..count).map(|i| (place(2, i, 1.5), radius, light)));
    let spheres = spheres.into_iter().map(|(c, r, s)| Sphere::new(c, r, s).expect("a sphere"));
    let camera = Camera::new(DVec3::new(0.0, 1.3, 3.5), DVec3::new(0.0, 0.0, 0.5), DVec3::Y, 45.0);
    let settings = RenderSettings::default().with_bounces(2).expect("few bounces");
    Scene::new(
        camera.expect("a camera"),
        ImageSize::new(SIDE, SIDE).expect("a size"),
        settings.with_estimator(estimator),
        spheres.collect(),
    )
}

/// One way to pick lights, its times and its picture's error.
struct Way {
    tracer: GpuTracer,
    spp: u64,
    traced: u64,
    nanoseconds: Vec<f64>,
}

impl Way {
    /// With as many samples a round as take some 200 ms.
    fn new(scene: &Scene, adapter: &Adapter, effects: Effects) -> Self {
        let tracer = GpuTracer::with_effects(scene, options::open(adapter), effects);
        let mut way = Self {
            tracer: tracer.expect("the device takes the scene"),
            spp: 2,
            traced: 0,
            nanoseconds: Vec::new(),
        };
        loop {
            way.measure();
            let samples = way.spp as f64 * f64::from(SIDE * SIDE);
            if way.nanoseconds.pop().is_some_and(|each| each * samples > 2e8) {
                return way;
            }
            way.spp *= 2;
        }
    }

    fn measure(&mut self) {
        let started = Instant::now();
        self.tracer.add_samples(self.traced..self.traced + self.spp).expect("samples");
        let samples = self.spp as f64 * f64::from(SIDE * SIDE);
        self.nanoseconds.push(started.elapsed().as_secs_f64() * 1e9 / samples);
        self.traced += self.spp;
    }

    /// Squared relative error of the picture, times the samples of each pixel.
    fn variance(&mut self) -> f64 {
        let summary = summarize(&self.tracer.film().expect("a film"));
        summary.relative_error.expect("light").powi(2) * summary.samples as f64
    }
}

fn row(scene: &Scene, count: u32, adapter: &Adapter, rounds: u64) -> String {
    let viewpoint = Viewpoint::of(scene);
    let own = Effects::of(scene, &viewpoint);
    let started = Instant::now();
    let tree = LightTree::of(scene, &viewpoint);
    let built = started.elapsed().as_secs_f64() * 1e3;
    assert_eq!(tree.lights().len(), count as usize);
    let scan = own.with(Effect::LightScan).without(Effect::LightTree);
    let walk = own.with(Effect::LightTree).without(Effect::LightScan);
    let ways = if count > MOST_SCANNED { vec![walk] } else { vec![walk, scan] };
    let mut ways: Vec<Way> = ways.into_iter().map(|way| Way::new(scene, adapter, way)).collect();
    for _ in 0..rounds {
        ways.iter_mut().for_each(Way::measure);
    }
    let of = |way: &mut Way| (turns::median(&way.nanoseconds), way.variance());
    let (time, variance) = of(&mut ways[0]);
    let Some((scan_time, scan_variance)) = ways.get_mut(1).map(of) else {
        return format!(
            "{count:>8} {:>12} {time:>12.0} {:>12} {variance:>12.3} {:>14} {built:>11.1}",
            "", "", ""
        );
    };
    let efficiency = scan_time * scan_variance / (time * variance);
    format!(
        "{count:>8} {scan_time:>12.0} {time:>12.0} {scan_variance:>12.3} {variance:>12.3} \
         {efficiency:>14.2} {built:>11.1}"
    )
}
