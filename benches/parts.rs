//! What the parts of the twin and the building of hierarchies take:
//! `cargo bench --bench parts [-- NAME]`, with intervals of 95 % by bootstrap.

#[path = "support/volume.rs"]
mod volume;

use candor::bound::sample_scale;
use candor::cpu::material::{evaluate_glossy, scatter_cosine, scatter_diffuse, scatter_glossy};
use candor::cpu::nearest::nearest;
use candor::cpu::rng::{random_bits, unit_floats};
use candor::cpu::sampling::{around, polar_cone, polar_cosine, polar_hemisphere, polar_phong};
use candor::cpu::sphere::{Ray, anchored, entry, exit, factored};
use candor::cpu::{PreparedScene, SampleKey, Search, camera_ray, trace};
use candor::film::{PixelSums, WORDS};
use candor::hierarchy::{Bounds, Hierarchy};
use candor::range::{self, Arithmetic};
use candor::scene::{Estimator, ImageSize, Scene, load};
use candor::viewpoint::Viewpoint;
use criterion::{BenchmarkId, Criterion, Throughput, criterion_group, criterion_main};
use glam::{DVec2, DVec3};
use std::hint::black_box;
use std::path::Path;
use std::time::Duration;

/// Inputs that are gone through in turn, so that no branch is learnt by heart.
const INPUTS: usize = 4096;

/// Sizes of the uniform volume in which hits are looked for.
const SEARCHED: [usize; 8] = [8, 16, 32, 64, 100, 1000, 10_000, 1_000_000];

/// The loop is not waited for beyond.
const LOOPED: usize = 10_000;

fn key(index: usize) -> SampleKey {
    SampleKey { pixel: 3, index: index as u64 }
}

fn numbers(index: usize) -> DVec2 {
    unit_floats(random_bits(key(index), 1, 2))
}

/// Measures a function of the number of the input.
fn measure<T>(c: &mut Criterion, group: &str, name: &str, mut run: impl FnMut(usize) -> T) {
    let mut input = 0;
    c.benchmark_group(group).bench_function(name, |b| {
        b.iter(|| {
            input = (input + 1) % INPUTS;
            run(input)
        });
    });
}

fn classic() -> Scene {
    load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml")).expect("a scene")
}

/// Random bits and the directions that are drawn from them.
fn samplers(c: &mut Criterion) {
    measure(c, "random", "bits", |i| random_bits(key(i), 1, 2));
    let u: Vec<DVec2> = (0..INPUTS).map(numbers).collect();
    let axes: Vec<DVec3> = (0..INPUTS as u64).map(|i| volume::direction(i, 1)).collect();
    measure(c, "sampling", "around", |i| around(axes[i], DVec2::new(0.6, 0.8), u[i].y));
    measure(c, "sampling", "polar_hemisphere", |i| polar_hemisphere(u[i].x));
    measure(c, "sampling", "polar_cosine", |i| polar_cosine(u[i].x));
    measure(c, "sampling", "polar_cone", |i| polar_cone(u[i].x, 0.25));
    measure(c, "sampling", "polar_phong", |i| polar_phong(u[i].x, 50.0));
    measure(c, "material", "scatter_diffuse", |i| scatter_diffuse(axes[i], u[i]));
    measure(c, "material", "scatter_cosine", |i| scatter_cosine(axes[i], u[i]));
    let incoming = DVec3::new(0.0, -0.6, -0.8);
    measure(c, "material", "scatter_glossy", |i| scatter_glossy(axes[i], incoming, 50.0, u[i]));
    measure(c, "material", "evaluate_glossy", |i| {
        evaluate_glossy(DVec3::Y, incoming, axes[i], 50.0)
    });
}

/// One sphere in both forms, from both sides.
fn spheres(c: &mut Criterion) {
    let origin = DVec3::new(0.1, 0.2, 0.3);
    let rays: Vec<Ray> = (0..INPUTS as u64)
        .map(|index| Ray { origin, direction: volume::direction(index, 2) })
        .collect();
    let center = DVec3::new(1.0, 2.0, 2.0);
    let (gradient, offset) = (-center, (center.length_squared() - 1.0) / 2.0);
    measure(c, "sphere", "factored, entry", |i| entry(factored(&rays[i], center, 1.0)));
    measure(c, "sphere", "anchored, entry", |i| entry(anchored(&rays[i], gradient, offset, 1.0)));
    measure(c, "sphere", "factored, exit", |i| exit(factored(&rays[i], DVec3::ZERO, 2.0), false));
    measure(c, "sphere", "anchored, exit", |i| {
        exit(anchored(&rays[i], DVec3::ZERO, -1.0, 0.5), false)
    });
}

/// Rays from surfaces of the volume.
fn rays(scene: &Scene) -> Vec<(Ray, Option<usize>)> {
    let ray = |index: usize| {
        let place = index * 7919 % (scene.spheres().len() - 1);
        let (sphere, normal) = (&scene.spheres()[place], volume::direction(index as u64, 3));
        let aim = volume::direction(index as u64, 4);
        let direction = if aim.dot(normal) < 0.0 { -aim } else { aim };
        (Ray { origin: sphere.center() + sphere.radius() * normal, direction }, Some(place))
    };
    (0..INPUTS).map(ray).collect()
}

/// The nearest hit, by the loop and by the hierarchy.
fn searches(c: &mut Criterion) {
    let size = ImageSize::new(16, 16).expect("a size");
    for count in SEARCHED {
        let scene = volume::scene(count, size);
        let rays = rays(&scene);
        for (name, search) in [("loop", Search::Loop), ("hierarchy", Search::Hierarchy)] {
            if search == Search::Loop && count > LOOPED {
                continue;
            }
            let prepared = PreparedScene::searched(&scene, search);
            measure(c, "nearest", &format!("{name}/{count}"), |i| {
                nearest(&prepared, &rays[i].0, rays[i].1)
            });
        }
    }
}

/// Whole paths of the classic scene, their start and their end.
fn paths(c: &mut Criterion) {
    let scene = classic();
    let prepared = PreparedScene::new(&scene);
    let middle = scene.size().pixels() / 2;
    let key = |index: usize| SampleKey { pixel: middle, index: index as u64 };
    measure(c, "path", "camera_ray", |i| camera_ray(&prepared, key(i)));
    let names = ["implicit", "cosine", "explicit", "mis"];
    for name in names {
        let estimator: Estimator = name.parse().expect("an estimator");
        let of = scene.clone().with_settings(scene.settings().with_estimator(estimator));
        let prepared = PreparedScene::new(&of);
        measure(c, "path", name, |i| trace(&prepared, key(i)));
    }
    let scale = sample_scale(&scene);
    let mut sums = PixelSums::of(&[0; WORDS]);
    let samples: Vec<[f32; 3]> =
        (0..INPUTS).map(|i| trace(&prepared, key(i)).as_vec3().to_array()).collect();
    measure(c, "film", "add", |i| black_box(&mut sums).add(samples[i], scale));
}

/// What stands between a scene of many spheres and its first sample.
fn preparations(c: &mut Criterion) {
    let mut group = c.benchmark_group("hierarchy");
    group.sample_size(10);
    for count in [1000, 10_000, 100_000, 1_000_000] {
        let radius = volume::radius(count);
        let boxes: Vec<Bounds> = volume::centers(count)
            .into_iter()
            .map(|center| Bounds::of_sphere(center, radius))
            .collect();
        group.throughput(Throughput::Elements(count as u64));
        group.bench_with_input(BenchmarkId::new("build", count), &boxes, |b, boxes| {
            b.iter(|| Hierarchy::build(boxes));
        });
    }
    group.finish();
    let mut group = c.benchmark_group("preparation of 1000000");
    group.sample_size(10);
    let scene = volume::scene(1_000_000, ImageSize::new(16, 16).expect("a size"));
    let viewpoint = Viewpoint::of(&scene);
    group.bench_function("Viewpoint::of", |b| b.iter(|| Viewpoint::of(&scene)));
    for (name, arithmetic) in
        [("range, single", Arithmetic::Single), ("range, double", Arithmetic::Double)]
    {
        group.bench_function(name, |b| b.iter(|| range::check(&scene, &viewpoint, arithmetic)));
    }
    group.bench_function("hash", |b| b.iter(|| scene.hash()));
    group.bench_function("PreparedScene::new", |b| b.iter(|| PreparedScene::new(&scene)));
    group.finish();
}

criterion_group! {
    name = parts;
    config = Criterion::default()
        .warm_up_time(Duration::from_millis(300))
        .measurement_time(Duration::from_millis(1500));
    targets = samplers, spheres, paths, searches, preparations
}
criterion_main!(parts);
