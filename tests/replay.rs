//! Samples that are traced again: they are what the film holds, to the bit; device and twin take
//! the same paths; and a kernel that is wrong at one vertex parts from the twin there.

#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    pub mod light_scenes;
    pub mod scenes;
    pub mod tracers;
}

use candor::bound::sample_scale;
use candor::cpu::{self, PreparedScene, SampleKey};
use candor::effects::Effects;
use candor::film::{PixelSums, WORDS};
use candor::gpu::Replayer;
use candor::kernel::Kernel;
use candor::replay::{Cause, Parting, parting};
use candor::scene::{Estimator, Scene, Surface};
use candor::tracer::InvalidReason;
use candor::trail::{Ending, Trail};
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use support::light_scenes;
use support::scenes::{classic, diffuse, emitter, glossy, many, packed, room, seen, size, sphere};
use support::tracers::{film, on_device};

const WIDTH: u32 = 13;
const HEIGHT: u32 = 9;
/// Samples on both sides of where the index takes a second word.
const FIRST: u64 = (1 << 32) - 1;

fn under(scene: &Scene, estimator: Estimator, bounces: u32) -> Scene {
    let settings = scene.settings().with_estimator(estimator);
    let settings = settings.with_bounces(bounces).expect("a few bounces");
    scene.clone().with_size(size(WIDTH, HEIGHT)).with_settings(settings)
}

/// Scenes with every form of the kernel: searches and bounces written out and in loops, seen
/// from inside and outside, one light and many, huge ones, glossy surfaces alone.
fn scenes() -> Vec<(&'static str, Scene, u32)> {
    vec![
        ("classic", classic(size(WIDTH, HEIGHT)), 2),
        ("classic, many bounces", classic(size(WIDTH, HEIGHT)), 6),
        ("many", many(size(WIDTH, HEIGHT)), 3),
        ("hollow", light_scenes::hollow(3), 3),
        ("in a light", light_scenes::in_light(), 3),
        ("gloss", light_scenes::gloss(), 3),
        ("under a sun", light_scenes::under_sun(1e2), 2),
        ("forty lights", light_scenes::forty_lights(), 2),
    ]
}

/// The twin's path of a sample.
fn twin(scene: &Scene, pixel: u32, index: u64) -> Trail {
    cpu::replay(&PreparedScene::new(scene), SampleKey { pixel, index })
}

/// Every fifth pixel.
fn pixels() -> impl Iterator<Item = u32> {
    (0..WIDTH * HEIGHT).step_by(5)
}

/// What a replay brings is what the film of that one sample holds, for every estimator.
#[test]
fn the_device_replays_what_it_rendered() {
    let mut lit = 0;
    for (name, scene, bounces) in scenes() {
        for estimator in Estimator::ALL {
            let scene = under(&scene, estimator, bounces);
            let (gpu, scale) = (support::gpu::open(), sample_scale(&scene));
            let replayer = Replayer::new(&scene, &gpu).expect("the device takes the scene");
            for index in FIRST..FIRST + 2 {
                let film = film(&mut on_device(&scene), &[index..index + 1]);
                for pixel in pixels() {
                    let trail = replayer.replay(pixel, index).expect("a path");
                    let mut sums = PixelSums::of(&[0; WORDS]);
                    sums.add(trail.radiance, scale);
                    let held = film.pixels()[pixel as usize];
                    assert_eq!(sums.words(), held, "{name}, {estimator:?}: {pixel}, {index}");
                    assert_eq!(trail.invalid(scale.bound()), None);
                    lit += usize::from(held != [0; WORDS]);
                }
            }
        }
    }
    // Black everywhere would prove nothing.
    assert!(lit > 500, "{lit} of the samples brought light");
}

/// The twin's replay is the twin's sample, to the bit; its vertices lie on their spheres, at
/// the end of their segments; and it ends as its last vertex says.
#[test]
fn the_twin_replays_what_it_traces() {
    for (name, scene, bounces) in scenes() {
        for estimator in Estimator::ALL {
            let scene = under(&scene, estimator, bounces);
            let prepared = PreparedScene::new(&scene);
            for pixel in 0..WIDTH * HEIGHT {
                let key = SampleKey { pixel, index: FIRST + 1 };
                let trail = cpu::replay(&prepared, key);
                let traced = cpu::trace(&prepared, key).as_vec3().to_array().map(f32::to_bits);
                let replayed = trail.radiance.map(f32::to_bits);
                assert_eq!(replayed, traced, "{name}, {estimator:?}: {pixel}");
                assert_consistent(&scene, &trail);
            }
        }
    }
}

#[track_caller]
fn assert_consistent(scene: &Scene, trail: &Trail) {
    let bounces = scene.settings().bounces() as usize;
    assert!((1..=bounces + 1).contains(&trail.segments.len()), "{trail:?}");
    for (segment, next) in trail.segments.iter().zip(&trail.segments[1..]) {
        let vertex = segment.vertex.expect("a path that goes on has hit something");
        assert_eq!(next.origin, vertex.position);
        assert!(next.direction.dot(vertex.normal) > -1e-9, "{trail:?}");
    }
    for segment in &trail.segments {
        let Some(vertex) = segment.vertex else { continue };
        let sphere = &scene.spheres()[vertex.sphere];
        let reached = segment.origin + vertex.distance * segment.direction;
        // f64 leaves 1e-15 of the largest length.
        let rounding = 1e-13 * (sphere.radius() + sphere.center().length() + vertex.distance);
        assert!(reached.distance(vertex.position) < rounding, "{segment:?}");
        let off = vertex.position.distance(sphere.center()) - sphere.radius();
        assert!(off.abs() < rounding && vertex.normal.is_normalized(), "{segment:?}");
    }
    let last = trail.segments.last().and_then(|segment| segment.vertex);
    let emits = |place: usize| matches!(scene.spheres()[place].surface(), Surface::Emitter(_));
    match trail.ending {
        Ending::Escaped => assert_eq!(last, None),
        Ending::Light => assert!(last.is_some_and(|vertex| emits(vertex.sphere)), "{trail:?}"),
        Ending::Limit => assert!(trail.segments.len() >= bounces, "{trail:?}"),
        Ending::Absorbed => {
            assert_eq!(trail.segments.last().map(|segment| segment.weight), Some(DVec3::ZERO));
        }
        Ending::Unfinished => panic!("the twin has no driver"),
    }
}

/// Rounding parts a path only where it passes a sphere's edge as closely as positions are rounded,
/// 1e-6 of the extent and some ten times that after a bounce off a ball. With edges of some ten
/// extents in view of each vertex, that is 1e-4 of the paths, 0.2 of 32 × 72; more than 5 have
/// probability 1e-7 (Poisson).
#[test]
fn device_and_twin_take_the_same_paths() {
    let mut parted = Vec::new();
    for (name, scene, bounces) in scenes() {
        for estimator in Estimator::ALL {
            let scene = under(&scene, estimator, bounces);
            let gpu = support::gpu::open();
            let replayer = Replayer::new(&scene, &gpu).expect("the device takes the scene");
            let viewpoint = Viewpoint::of(&scene);
            for (pixel, index) in pixels().flat_map(|pixel| (0..3).map(move |k| (pixel, k))) {
                let device = replayer.replay(pixel, index).expect("a path");
                let found = parting(&device, &twin(&scene, pixel, index), &viewpoint);
                parted.extend(found.map(|found| (name, estimator, pixel, index, found)));
            }
        }
    }
    assert!(parted.len() <= 5, "{parted:#?}");
}

/// The first sample among `pixels` whose path on the twin does as asked.
fn sample_where(scene: &Scene, asked: impl Fn(&Trail) -> bool) -> (u32, u64) {
    let all = (0..64).flat_map(|index| (0..WIDTH * HEIGHT).map(move |pixel| (pixel, index)));
    let mut found = all.filter(|&(pixel, index)| asked(&twin(scene, pixel, index)));
    found.next().expect("some path does")
}

/// What a kernel makes of a sample that has `to` in place of `from`, and where it parts from the
/// twin.
fn mutated(scene: &Scene, at: (u32, u64), from: &str, to: &str) -> (Trail, Option<Parting>) {
    let (gpu, packed, viewpoint) = (support::gpu::open(), packed(scene), Viewpoint::of(scene));
    let kernel = Kernel::of(scene, Effects::of(scene, &viewpoint), &packed).replay_wgsl();
    assert_eq!(kernel.matches(from).count(), 1, "occurrences of {from:?} in the kernel");
    let kernel = kernel.replace(from, to);
    let replayer = Replayer::with_kernel(scene, &gpu, &packed, &kernel).expect("a kernel");
    let trail = replayer.replay(at.0, at.1).expect("a path");
    let parted = parting(&trail, &twin(scene, at.0, at.1), &viewpoint);
    (trail, parted)
}

fn at(vertex: usize, cause: Cause) -> Parting {
    Parting { vertex, cause }
}

/// Each fault sits at one vertex of a path with three: the replay shows it there.
#[test]
fn a_fault_shows_at_its_vertex() {
    let scene = under(&classic(size(WIDTH, HEIGHT)), Estimator::Cosine, 2);
    let long = sample_where(&scene, |trail| {
        trail.segments.len() == 3
            && trail.ending == Ending::Limit
            && trail.segments.iter().all(|s| s.weight.min_element() > 0.0)
    });
    let weight = "(*path).throughput *= scattering.weight * color;";
    let direction = "(*path).ray = Ray(point.position, scattering.direction);";
    let position = "return SurfacePoint(position, facing_normal(outward, hit.sphere));";
    let faults = [
        (
            weight,
            "(*path).throughput *= scattering.weight * color * select(1.0, 1.01, bounce == 0u);",
            at(1, Cause::Weight),
        ),
        (
            weight,
            "(*path).throughput *= scattering.weight * color * select(1.0, 0.0, bounce == 1u);",
            at(2, Cause::Weight),
        ),
        (
            direction,
            "(*path).ray = Ray(point.position, select(scattering.direction, \
         point.normal, bounce == 1u));",
            at(2, Cause::Direction),
        ),
        (
            "normalize(scene.forward + offset));",
            "normalize(scene.forward + offset.yzx));",
            at(0, Cause::Direction),
        ),
        (
            position,
            "return SurfacePoint(position + 0.01, facing_normal(outward, hit.sphere));",
            at(1, Cause::Position),
        ),
        (
            position,
            "return SurfacePoint(position, -facing_normal(outward, hit.sphere));",
            at(1, Cause::Normal),
        ),
        ("bounce <= BOUNCES && goes_on", "bounce < BOUNCES && goes_on", at(2, Cause::Ending)),
    ];
    for (from, to, expected) in faults {
        let (trail, found) = mutated(&scene, long, from, to);
        assert_eq!(found, Some(expected), "{to}: {trail:#?}");
    }
    // The same change of nothing.
    assert_eq!(mutated(&scene, long, weight, &weight.replace("color", "1.0 * color")).1, None);
}

/// A search that overlooks the lamp parts where the path should hit it, and only there.
#[test]
fn a_sphere_that_is_overlooked_shows_where_it_should_be_hit() {
    let scene = under(&classic(size(WIDTH, HEIGHT)), Estimator::Implicit, 2);
    let search = "    best = closer_factored(best, ray, shape_0, 0u, leaving);\n";
    for vertices in 1..=3 {
        let sample = sample_where(&scene, |trail| {
            trail.segments.len() == vertices && trail.ending == Ending::Light
        });
        assert_eq!(mutated(&scene, sample, search, "").1, Some(at(vertices, Cause::Sphere)));
    }
}

/// Faults of the connections to lights.
#[test]
fn a_wrong_connection_shows_at_its_vertex() {
    let scene = under(&classic(size(WIDTH, HEIGHT)), Estimator::Mis, 2);
    let hidden_at_second = sample_where(&scene, |trail| {
        let seen = |i: usize| trail.segments.get(i)?.connection.map(|found| found.visible);
        (seen(0), seen(1)) == (Some(true), Some(false))
    });
    let (_, found) = mutated(
        &scene,
        hidden_at_second,
        "return first < distance || earlier <= distance;",
        "return false;",
    );
    assert_eq!(found, Some(at(2, Cause::Visibility)));
    let bright_at_first = sample_where(&scene, |trail| {
        trail.segments[0].connection.is_some() && trail.segments[0].radiance.min_element() > 0.0
    });
    let share = "return x / (1.0 + x * x);";
    let (_, found) = mutated(&scene, bright_at_first, share, "return x / (1.0 + x);");
    assert_eq!(found, Some(at(1, Cause::Radiance)));
    let lamps = under(&light_scenes::joined_lights(), Estimator::Explicit, 2);
    let last = sample_where(&lamps, |trail| {
        let light = trail.segments[0].connection.map(|found| found.light);
        light.is_some_and(|light| light > 1)
    });
    let (_, found) = mutated(&lamps, last, "if u < sum {", "if u < sum + 2.0 {");
    assert_eq!(found, Some(at(1, Cause::Light)));
}

/// An invalid sample says why, and the path shows where it became so.
#[test]
fn an_invalid_sample_shows_where_it_went_wrong() {
    let scene = under(&classic(size(WIDTH, HEIGHT)), Estimator::Explicit, 2);
    let bound = sample_scale(&scene).bound();
    let sample = sample_where(&scene, |trail| trail.segments.len() == 2);
    let values = [
        (f32::NAN, InvalidReason::NotANumber),
        (f32::INFINITY, InvalidReason::Infinite),
        (f32::NEG_INFINITY, InvalidReason::Infinite),
        (-1.0, InvalidReason::Negative),
        (2.0 * bound, InvalidReason::AboveBound),
    ];
    let before = "    let departure = Departure(point, scattering.density,";
    for (value, reason) in values {
        let bits = value.to_bits();
        let poison = format!(
            "    if bounce == 1u {{ (*path).radiance.y = bitcast<f32>({bits}u + (key.pixel & \
             0x80000000u)); }}\n{before}"
        );
        let (trail, found) = mutated(&scene, sample, before, &poison);
        assert_eq!(trail.invalid(bound), Some(reason), "{trail:?}");
        assert_eq!(found, Some(at(2, Cause::Radiance)), "{trail:?}");
    }
    let unfinished = "(*path).finished = hit.sphere != UNFINISHED && !unfinished;";
    let (trail, found) = mutated(&scene, sample, unfinished, "unfinished = bounce == 1u;");
    assert_eq!(trail.invalid(bound), Some(InvalidReason::Unfinished), "{trail:?}");
    assert_eq!((trail.ending, found), (Ending::Unfinished, Some(at(2, Cause::Ending))));
}

/// A search that a driver cut short is told from one that found nothing.
#[test]
fn a_search_cut_short_is_unfinished() {
    let scene = many(size(WIDTH, HEIGHT));
    let cut = "; i < scene.sphere_count; i++";
    let (trail, found) = mutated(&scene, (0, 0), cut, "; i < 3u; i++");
    assert_eq!((trail.ending, trail.segments.len()), (Ending::Unfinished, 1));
    assert!(found.is_some_and(|found| found.vertex == 1), "{found:?}");
}

/// The longest path among the most spheres: watching it does not cut its loops short.
#[test]
fn the_longest_path_is_replayed_whole() {
    let mut spheres = room(1e4, false).spheres().to_vec();
    let speck = |i: u32| {
        let [x, y, z] = [i % 8, i / 8 % 8, i / 64].map(|n| 0.6 * f64::from(n) - 2.1);
        sphere([x, y, z], 0.01, if i == 0 { emitter([1.0; 3]) } else { diffuse(1.0) })
    };
    let free = candor::kernel::SPHERE_CAPACITY - spheres.len();
    spheres.extend((0..).map(speck).take(free));
    let gpu = support::gpu::open();
    // The bound on what a hierarchy may take allows somewhat less than 64 bounces.
    let scene = |bounces| {
        let (eye, target) = ([1.0, 0.5, 0.25], [2.0, 1.0, 0.0]);
        seen(eye, target, size(16, 16), bounces, spheres.clone())
    };
    let is_taken = |bounces: &u32| Replayer::new(&scene(*bounces), &gpu).is_ok();
    let most = (48..=64).rev().find(is_taken).expect("48 bounces are allowed");
    let scene = scene(most);
    let replayer = Replayer::new(&scene, &gpu).expect("the device takes the scene");
    let trails = (0..8).map(|pixel| replayer.replay(pixel, 1).expect("a path"));
    let ends: Vec<_> = trails.map(|trail| (trail.ending, trail.segments.len())).collect();
    assert!(ends.contains(&(Ending::Limit, most as usize + 1)), "{ends:?}");
    assert!(ends.iter().all(|&(ending, _)| ending != Ending::Unfinished), "{ends:?}");
}

/// From far away the device's rays start before the scene; its first segment counts from the
/// camera all the same.
#[test]
fn far_cameras_are_where_they_are() {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 1.0, glossy(0.9, 3.0)),
        sphere([0.0, -51.0, 0.0], 50.0, diffuse(0.5)),
        sphere([0.0, 4.0, 0.0], 1.0, emitter([5.0; 3])),
    ];
    let camera = candor::scene::Camera::new(
        DVec3::new(0.0, 2e4, 1e5),
        DVec3::new(0.0, 1.0, 0.0),
        DVec3::Y,
        0.003,
    );
    let near = seen([0.0, 2.0, 9.0], [0.0; 3], size(WIDTH, HEIGHT), 2, spheres);
    let camera = camera.expect("a camera");
    let scene = Scene::new(camera, near.size(), near.settings(), near.spheres().to_vec());
    let viewpoint = Viewpoint::of(&scene);
    assert!(viewpoint.approach() > 0.0);
    let gpu = support::gpu::open();
    let replayer = Replayer::new(&scene, &gpu).expect("the device takes the scene");
    let mut hits = 0;
    for pixel in pixels() {
        let (device, twin) = (replayer.replay(pixel, 0).expect("a path"), twin(&scene, pixel, 0));
        assert_eq!(device.segments[0].origin, twin.segments[0].origin);
        assert_eq!(parting(&device, &twin, &viewpoint), None, "{device:#?} {twin:#?}");
        let Some((ours, theirs)) = device.segments[0].vertex.zip(twin.segments[0].vertex) else {
            continue;
        };
        // f32 rounds the scene's few units by 1e-6, the way from the camera not at all.
        assert!((ours.distance - theirs.distance).abs() < 1e-3, "{ours:?} {theirs:?}");
        hits += 1;
    }
    assert!(hits > 5, "{hits}");
}
