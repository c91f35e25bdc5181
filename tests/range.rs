//! The declared range: what is refused, where, and that the device is right at its limits.

#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use candor::estimate::{Paired, pair};
use candor::range::{Arithmetic, OutOfRange, check};
use candor::scene::{Camera, Estimator, Scene, Sphere};
use candor::verify::{ALPHA, MAX_BIAS};
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use support::scenes::{classic, diffuse, emitter, size, sphere};
use support::tracers::{film, on_device, twin};

/// Where something small is put into the classic scene: free, in the air.
const AIR: DVec3 = DVec3::new(0.37, 1.2, 1.13);
/// The topmost point of its floor.
const FLOOR: DVec3 = DVec3::new(0.0, -3.0, 0.0);

/// The classic scene with more spheres, their numbers from 9 on.
fn with(more: Vec<Sphere>) -> Scene {
    let scene = classic(size(32, 32));
    let spheres = scene.spheres().iter().cloned().chain(more).collect();
    Scene::new(scene.camera().clone(), scene.size(), scene.settings(), spheres)
}

fn judged(scene: &Scene, arithmetic: Arithmetic) -> Result<(), OutOfRange> {
    check(scene, &Viewpoint::of(scene), arithmetic)
}

/// Device against twin under `mis`, on so many samples per pixel.
fn paired(scene: &Scene, samples: u64) -> Paired {
    let scene = scene.clone().with_settings(scene.settings().with_estimator(Estimator::Mis));
    let range = [0..samples];
    pair(&film(&mut on_device(&scene), &range), &film(&mut twin(&scene), &range))
}

/// The largest size, within a thousandth, at which `build` makes a scene that is refused, and
/// what is said of it; the limit by which a user would go.
fn limit(build: impl Fn(f64) -> Scene, arithmetic: Arithmetic) -> (f64, OutOfRange) {
    let (mut low, mut high) = (1e-14, 0.4);
    assert!(judged(&build(high), arithmetic).is_ok());
    let mut refusal = judged(&build(low), arithmetic)
        .expect_err(&format!("it is tiny: {:?}", build(low).spheres().last()));
    while high / low > 1.001 {
        let middle = (low * high).sqrt();
        match judged(&build(middle), arithmetic) {
            Ok(()) => high = middle,
            Err(out) => (low, refusal) = (middle, out),
        }
    }
    (high, refusal)
}

fn lone(radius: f64) -> Scene {
    with(vec![sphere(AIR, radius, emitter([50.0; 3]))])
}

fn touching(radius: f64) -> Scene {
    let beside = AIR + 2.0 * radius * DVec3::new(0.6, 0.8, 0.0);
    with(vec![sphere(AIR, radius, diffuse(0.8)), sphere(beside, radius, emitter([50.0; 3]))])
}

fn resting(radius: f64) -> Scene {
    with(vec![sphere(FLOOR + radius * DVec3::Y, radius, emitter([50.0; 3]))])
}

/// A lamp in the floor, of which so much shows.
fn sunk(height: f64) -> Scene {
    with(vec![sphere(FLOOR + (height - 0.5) * DVec3::Y, 0.5, emitter([50.0; 3]))])
}

/// A picture of the left sphere's rim that is so wide.
fn narrow(width: f64) -> Scene {
    let scene = classic(size(32, 32));
    let position = scene.camera().position();
    // Where a ray touches the unit sphere around the centre.
    let center = DVec3::new(-1.3, -2.0, -1.0);
    let towards = (position - center).normalize();
    let aside = towards.cross(DVec3::X).normalize();
    let sine = 1.0 / position.distance(center);
    let rim = center + sine * towards + (1.0 - sine * sine).sqrt() * aside;
    let fov = 2.0 * (width / 2.0 / position.distance(rim)).atan().to_degrees();
    let camera = Camera::new(position, rim, DVec3::Y, fov).expect("a camera");
    Scene::new(camera, scene.size(), scene.settings(), scene.spheres().to_vec())
}

/// A way to make a scene with something of a size, what a user may expect to be allowed in
/// the classic scene, and what the refusal says.
type Kind = (&'static str, fn(f64) -> Scene, std::ops::Range<f64>, &'static str);

const KINDS: [Kind; 5] = [
    ("lone", lone, 3e-5..6e-5, "is too small for the single precision"),
    ("touching", touching, 3e-4..6e-4, "is too small, so near to sphere 10, for"),
    ("resting", resting, 3e-4..6e-4, "is too small, so near to sphere 4 (`floor`), for"),
    ("sunk", sunk, 8e-4..1.5e-3, "is hidden by sphere 4 (`floor`) but for a part too small"),
    ("narrow", narrow, 2e-3..5e-3, "the field of view is too narrow for the single precision"),
];

#[test]
fn each_kind_has_its_limit_and_its_words() {
    for (name, build, expected, words) in KINDS {
        let (limit, refusal) = limit(build, Arithmetic::Single);
        assert!(expected.contains(&limit), "{name}: {limit}");
        let text = refusal.to_string();
        assert!(text.contains(words) && text.contains("here it takes") || name == "sunk", "{text}");
        assert!(text.ends_with("(`candor render --device cpu` takes this scene)"), "{text}");
        assert_eq!(refusal.sphere.is_some(), name != "narrow");
        // The twin has 29 more bits; it computes from the scene's origin and by centres, which
        // takes some of them where a wall is 1e5 large.
        let (twin, _) = self::limit(build, Arithmetic::Double);
        assert!(twin < 1e-4 * limit, "{name}: {twin}");
    }
}

/// At the limit, the device's image mean is within 0.1 % of the twin's.
#[test]
fn the_device_is_right_at_the_limits() {
    for (name, build, ..) in KINDS {
        let (limit, _) = limit(build, Arithmetic::Single);
        let scene = build(limit);
        let found = paired(&scene, 1024);
        println!(
            "{name:<9}{limit:.2e} {:+.1?} ± {:.1?} ppm",
            found.bias.map(|b| 1e6 * b),
            found.error.map(|e| 1e6 * e)
        );
        assert!(found.is_within(MAX_BIAS, ALPHA), "{name}: {found:?}");
    }
}

/// What is far beyond a limit is wrong on a device: a picture of a rim that is 1e-6 wide.
#[test]
fn far_beyond_a_limit_the_device_is_wrong() {
    let scene = narrow(1e-6);
    assert!(judged(&scene, Arithmetic::Single).is_err());
    let found = paired(&scene, 1024);
    println!("{found:?}");
    assert!(found.exceeds(MAX_BIAS, ALPHA), "{found:?}");
}

/// Seen from so near that nothing else is in the picture, which is what the limit for two
/// spheres that touch is worth: two of them, a lamp and a diffuse one, at shares of it.
#[test]
fn beyond_the_limit_bias_grows_with_one_over_the_size() {
    let (limit, _) = limit(touching, Arithmetic::Single);
    let close = |radius: f64| {
        let scene = touching(radius);
        let position = scene.camera().position();
        let fov = 2.0 * (3.0 * radius / position.distance(AIR)).atan().to_degrees();
        let camera = Camera::new(position, AIR, DVec3::Y, fov).expect("a camera");
        let spheres = scene.spheres().to_vec();
        paired(&Scene::new(camera, scene.size(), scene.settings(), spheres), 2048)
    };
    for share in [1.0, 0.3, 0.1, 0.03, 0.01, 0.003] {
        let found = close(share * limit);
        let [bias, error] = [found.bias[1], found.error[1]].map(|x| 100.0 * x);
        println!("{share:<6} of the limit: {bias:+.3} ± {error:.3} %");
        // From the limit down to a tenth of it the device is right; at a three-hundredth it is
        // wrong by so much that one chance in a thousand is level enough.
        let (right, wrong) = (!found.exceeds(MAX_BIAS, ALPHA), found.exceeds(MAX_BIAS, 1e-3));
        assert!(right || share < 0.1, "{share}: {found:?}");
        assert!(wrong || share > 0.005, "{share}: {found:?}");
    }
}

/// Usual scenes are not refused: walls, things on the floor, things that overlap or hold
/// each other, cameras on surfaces and inside.
#[test]
fn usual_scenes_are_in_range() {
    let chalk = || diffuse(0.8);
    let scenes = [
        classic(size(8, 8)),
        with(vec![sphere([0.0, -2.99, 0.0], 0.01, chalk())]),
        with(vec![sphere([0.0, -2.9999, 0.0], 0.1, chalk())]),
        // Shells of 1e-4, the inner one unseen.
        with(vec![sphere(AIR, 0.3, chalk()), sphere(AIR, 0.3 - 1e-4, chalk())]),
        // A floor under the floor, by a step and by a hair; a ball that is hidden in it.
        with(vec![sphere([0.0, -1e5 - 3.5, 0.0], 1e5, chalk())]),
        with(vec![sphere([0.0, -1e5 - 3.0001, 0.0], 1e5, chalk())]),
        with(vec![sphere([0.0, -4.0, 0.0], 1.0, chalk())]),
        // A lamp in the middle of a hollow sphere around all.
        with(vec![sphere(DVec3::ZERO, 50.0, chalk())]),
        // A camera on a floor, and on a planet.
        with(vec![sphere([0.0, -1e5, 9.0], 1e5, chalk())]),
        with(vec![sphere([0.0, -50.0, 9.0], 50.0, chalk())]),
        support::scenes::room(1e5, true),
        support::scenes::room(1e9, true),
        support::scenes::many(size(8, 8)),
    ];
    for (i, scene) in scenes.iter().enumerate() {
        for arithmetic in [Arithmetic::Single, Arithmetic::Double] {
            assert_eq!(judged(scene, arithmetic), Ok(()), "scene {i}, {arithmetic:?}");
        }
    }
}

/// Two surfaces that lie side by side, from whichever side they are seen, and cameras beside a
/// rim: rounding would say what is seen.
#[test]
fn what_rounding_would_decide_is_refused() {
    let refusal = |scene: &Scene| judged(scene, Arithmetic::Single).expect_err("refused").what;
    let apart = |scene: &Scene, words: &str| assert!(refusal(scene).contains(words), "{words}");
    let close = "lies so close to the surface of";
    // A ball in a lamp that it fills, and the other way round; centred and touching.
    for (inner, outer) in [(diffuse(0.8), emitter([9.0; 3])), (emitter([9.0; 3]), diffuse(0.8))] {
        for off in [0.0, 1e-6] {
            let ball = sphere(AIR + off * DVec3::X, 0.3 - 1e-6, inner);
            apart(&with(vec![ball, sphere(AIR, 0.3, outer)]), close);
        }
    }
    // A lining of a room that holds the camera, and floors that touch each other.
    let lining = [(10.0, 0.5), (10.0 - 1e-6, 0.6)];
    let lining = lining.map(|(r, rho)| sphere(DVec3::ZERO, 2.0 * r, diffuse(rho)));
    apart(&with(lining.to_vec()), close);
    apart(&with(vec![sphere([0.0, -1e7 - 3.0, 0.0], 1e7, diffuse(0.1))]), close);
    // A floor that crosses the other at 1e-5 radians.
    apart(&with(vec![sphere([1.0, -1e5 - 3.0, 0.0], 1e5, diffuse(0.1))]), close);
    // A speck right beside the camera.
    let speck = sphere([2e-3 + 1e-5, 0.0, 9.0], 2e-3, diffuse(0.0));
    apart(&with(vec![speck]), "is too near to the camera");
    // The same under the camera, whose horizon is seen.
    let speck = sphere([2e-3, 0.0, 9.0], 2e-3, diffuse(0.0));
    apart(&with(vec![speck]), "is too near to the camera");
    // A lamp of a speck in a hollow that is large beside all else.
    let hollow =
        with(vec![sphere(DVec3::ZERO, 1e3, diffuse(0.5)), sphere(AIR, 1e-3, diffuse(0.5))]);
    apart(&hollow, "is too small for");
}

/// A ball of which a sliver of 3e-4 shows: refused where it is large, and over in the picture
/// where it is a speck; likewise where the other one is like it, and both are one to the eye.
#[test]
fn what_is_not_seen_is_in_range() {
    let pair = |size: f64, rho| {
        let (radius, off) = (size * (1.0 - 5e-3), size * 5e-3 + 3e-4);
        let hidden = sphere(AIR + off * DVec3::X, radius, diffuse(rho));
        judged(&with(vec![sphere(AIR, size, diffuse(0.8)), hidden]), Arithmetic::Single)
    };
    let refusal = pair(0.2, 0.3).expect_err("a sliver of another colour");
    assert!(refusal.what.contains("is hidden by"), "{refusal}");
    assert_eq!((pair(0.2, 0.8), pair(4e-3, 0.3)), (Ok(()), Ok(())));
    // Specks that lie in each other are told, whatever their size.
    let inside = [sphere(AIR, 0.02, diffuse(0.8)), sphere(AIR, 0.02 - 1e-7, diffuse(0.3))];
    judged(&with(inside.to_vec()), Arithmetic::Single).expect_err("rounding says which is seen");
}

/// The twin's centre form loses the surface of a wall that is huge even for `f64`, and the
/// device's does not.
#[test]
fn planes_are_for_devices() {
    let scene = with(vec![sphere([0.0, -1e14 - 3.5, 0.0], 1e14, diffuse(0.5))]);
    assert_eq!(judged(&scene, Arithmetic::Single), Ok(()));
    let refusal = judged(&scene, Arithmetic::Double).expect_err("53 bits");
    assert!(
        refusal.to_string().ends_with("(`candor render` takes this scene on a device)"),
        "{refusal}"
    );
}
