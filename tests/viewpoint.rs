//! Focus, extent and sides: what is decided about a scene before anything is traced.

use candor::bound::sample_scale;
use candor::effects::{Effect, Effects};
use candor::kernel::{KernelUnits, Packed, pack};
use candor::scene::{
    Albedo, Camera, Exponent, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface, load,
};
use candor::viewpoint::{Form, Viewpoint};
use glam::DVec3;

fn white() -> Surface {
    Surface::Diffuse(Albedo::new(DVec3::ONE).expect("an albedo"))
}

fn sphere(center: [f64; 3], radius: f64, surface: Surface) -> Sphere {
    Sphere::new(DVec3::from(center), radius, surface).expect("a sphere")
}

fn scene(position: [f64; 3], look_at: [f64; 3], spheres: Vec<Sphere>) -> Scene {
    let camera = Camera::new(position.into(), look_at.into(), DVec3::Y, 45.0).expect("a camera");
    let size = ImageSize::new(8, 8).expect("a size");
    Scene::new(camera, size, RenderSettings::default(), spheres)
}

fn effects(scene: &Scene) -> Effects {
    Effects::of(scene, &Viewpoint::of(scene))
}

fn packed(scene: &Scene) -> Packed {
    pack(scene, &Viewpoint::of(scene), effects(scene), sample_scale(scene))
}

fn classic(wall: f64) -> Scene {
    let text = std::fs::read_to_string("scenes/two-spheres.toml").expect("the classic scene");
    let text = text
        .replace("100003.0", &format!("{:?}", wall + 3.0))
        .replace("100004.0", &format!("{:?}", wall + 4.0))
        .replace("100000.0", &format!("{wall:?}"));
    candor::scene::parse("classic", &text).expect("a scene")
}

/// The box of §3 of DESIGN.md, by hand: x and y from -3 to 3, z from the back wall at -4
/// to the camera at 9.
#[test]
fn the_classic_scene_has_the_box_as_its_extent_whatever_its_walls() {
    for wall in [1e3, 1e5, 1e7, 1e9] {
        let viewpoint = Viewpoint::of(&classic(wall));
        assert!(viewpoint.focus().distance(DVec3::new(0.0, 0.0, 2.5)) < 1e-2, "{viewpoint:?}");
        let diagonal = DVec3::new(6.0, 6.0, 13.0).length() / 2.0;
        assert!((viewpoint.extent() - diagonal).abs() < 1e-2, "{viewpoint:?}");
    }
    assert_eq!(load("scenes/two-spheres.toml".as_ref()).expect("a scene"), classic(1e5));
}

/// Walls need no small sphere beside them to be walls: six of them around the camera, a
/// floor alone, and a floor that the camera stands on under one that it does not.
#[test]
fn walls_alone_do_not_count_with_their_far_sides() {
    let room: Vec<Sphere> = DVec3::AXES
        .into_iter()
        .flat_map(|axis| [axis, -axis])
        .map(|axis| sphere((axis * 100_003.0).to_array(), 1e5, white()))
        .collect();
    let extent = |at, spheres| Viewpoint::of(&scene(at, [0.0; 3], spheres)).extent();
    assert!(extent([1.0, 0.5, 0.25], room) < 10.0);
    let floor = || sphere([0.0, -1e5, 0.0], 1e5, white());
    assert!(extent([0.0, 3.0, 1.0], vec![floor()]) < 10.0);
    let ceiling = sphere([0.0, 1e6 + 4.0, 0.0], 1e6, white());
    assert!(extent([0.0, 0.0, 1.0], vec![floor(), ceiling]) < 10.0);
}

/// On the only sphere there is, that sphere is all there is.
#[test]
fn a_camera_on_the_only_sphere_has_it_as_its_extent() {
    let ball = vec![sphere([0.0; 3], 2.0, white())];
    let viewpoint = Viewpoint::of(&scene([0.0, 0.0, 2.0], [0.0, 0.0, 9.0], ball));
    assert!((viewpoint.extent() - 2.0 * 3.0_f64.sqrt()).abs() < 1e-9, "{viewpoint:?}");
}

#[test]
fn walls_are_anchored_and_balls_are_factored() {
    let scene = classic(1e5);
    let packed = packed(&scene);
    let walls = 1..6;
    for (i, form) in packed.forms.iter().enumerate() {
        let expected = if walls.contains(&i) { Form::Anchored } else { Form::Factored };
        assert_eq!(*form, expected, "sphere {i}");
    }
    assert_eq!((packed.scene.factored_count, packed.scene.sphere_count), (3, 8));
    let order: Vec<u32> = packed.spheres.iter().map(|s| s.index).collect();
    assert_eq!(order, [0, 6, 7, 1, 2, 3, 4, 5]);
}

/// Scaling by powers of two and translation by what `f64` adds exactly leave the packed
/// scene as it is, to the bit.
#[test]
fn the_packed_scene_does_not_depend_on_where_and_how_large_the_scene_is() {
    let build = |scale: f64, shift: f64| {
        let place = |p: [f64; 3]| p.map(|x| x * scale + shift);
        let spheres = vec![
            sphere(place([1.0, 2.0, -3.0]), 0.5 * scale, white()),
            sphere(place([0.0, -1024.0, 0.0]), 1020.0 * scale, white()),
        ];
        let scene = scene(place([0.0, 0.0, 8.0]), place([0.0, 0.0, 0.0]), spheres);
        packed(&scene)
    };
    let reference = build(1.0, 0.0);
    for scale in [2.0_f64.powi(-20), 0.25, 2.0_f64.powi(20)] {
        assert_eq!(build(scale, 0.0), reference, "scaled by {scale}");
    }
    assert_eq!(build(1.0, 65_536.0), reference, "translated");
}

/// A sky around the scene, a sun far behind it and a speck farther away move nothing: not
/// the focus, not the extent, and not the sides of what is near.
#[test]
fn scenery_does_not_move_the_focus() {
    let near = || vec![sphere([0.0; 3], 1.0, white()), sphere([3.0, 0.0, 0.0], 0.5, white())];
    let viewpoint = |far: Option<Sphere>| {
        let spheres = near().into_iter().chain(far).collect();
        Viewpoint::of(&scene([0.0, 0.0, 4.0], [0.0; 3], spheres))
    };
    let reference = viewpoint(None);
    for far in [
        sphere([0.0; 3], 1e7, white()),
        sphere([0.0, 0.0, 1.5e11], 7e8, white()),
        sphere([0.0, 0.0, -3e7], 1e-3, white()),
    ] {
        let found = viewpoint(Some(far));
        assert_eq!(found.focus(), reference.focus());
        assert_eq!(found.extent().to_bits(), reference.extent().to_bits());
        assert_eq!(found.inside()[..2], [false, false]);
    }
}

/// Not a wall: where rays start many radii away, the centre form is the better one. They
/// start so far away only if the field is wide; a narrow one has its rays start nearer.
#[test]
fn spheres_far_from_where_rays_start_are_factored() {
    let spheres = || vec![sphere([0.0, 3.05, 0.0], 0.05, white()), sphere([0.0; 3], 3.0, white())];
    let cases = [
        (10.0, 45.0, Form::Anchored),
        (100.0, 45.0, Form::Anchored),
        (100.0, 179.0, Form::Factored),
    ];
    for (distance, fov, form) in cases {
        let camera = Camera::new(DVec3::Z * distance, DVec3::ZERO, DVec3::Y, fov);
        let size = ImageSize::new(8, 8).expect("a size");
        let camera = camera.expect("a camera");
        let scene = Scene::new(camera, size, RenderSettings::default(), spheres());
        let packed = packed(&scene);
        assert_eq!(packed.forms, [Form::Factored, form], "{distance}, {fov} degrees");
    }
}

/// The plane on which rays start lies before all that is in the field, and near it.
#[test]
fn rays_of_a_far_camera_start_just_before_what_they_see() {
    let approach = |distance: f64, fov: f64, spheres: Vec<Sphere>| {
        let camera = Camera::new(DVec3::Z * distance, DVec3::ZERO, DVec3::Y, fov);
        let size = ImageSize::new(8, 8).expect("a size");
        let camera = camera.expect("a camera");
        let scene = Scene::new(camera, size, RenderSettings::default(), spheres);
        Viewpoint::of(&scene).approach()
    };
    let balls = || vec![sphere([0.0; 3], 1.0, white()), sphere([3.0, 0.0, 0.0], 0.5, white())];
    assert!(approach(9.0, 45.0, balls()) == 0.0, "a near camera has its rays start at itself");
    let far = approach(1e6, 1e-4, balls());
    assert!((1e6 - 10.0..1e6 - 1.0).contains(&far), "{far}");
    // Something in the field that is nearer holds the plane back; beside the field it does not.
    let held = |x: f64| {
        let mut spheres = balls();
        spheres.push(sphere([x, 0.0, 9e5], 0.5, white()));
        approach(1e6, 1e-4, spheres)
    };
    assert!(held(0.0) < 1e5, "{}", held(0.0));
    // Inside of a shell, rays start before they reach it.
    let mut shell = balls();
    shell.push(sphere([0.0, 0.0, 1e6 - 10.0], 500.0, white()));
    assert!(approach(1e6, 1e-4, shell) <= 510.0);
    // Nothing is in the field.
    assert!(approach(1e6, 1e-4, vec![sphere([1e3, 0.0, 0.0], 1.0, white())]) == 0.0);
}

/// Only the first of spheres in one place can be seen.
#[test]
fn coincident_spheres_are_one() {
    let lamp = Surface::Emitter(Radiance::new(DVec3::ONE).expect("a radiance"));
    let spheres = vec![
        sphere([0.0, 1.0, 0.0], 2.0, white()),
        sphere([-0.0, 1.0, 0.0], 2.0, lamp),
        sphere([0.0, 1.0, 0.0], 2.5, white()),
    ];
    let scene = scene([0.0, 0.0, 9.0], [0.0; 3], spheres);
    assert_eq!((scene.spheres().len(), scene.has_lights()), (2, false));
}

/// -0.0 is a radiance and an albedo like 0.0; as a bit pattern it would be out of bounds.
#[test]
fn minus_zero_is_zero() {
    let rgb = DVec3::new(-0.0, 1.0, 1.0);
    let radiance = Radiance::new(rgb).expect("a radiance").rgb();
    let albedo = Albedo::new(rgb).expect("an albedo").rgb();
    assert!(radiance.x.is_sign_positive() && albedo.x.is_sign_positive());
}

/// 2·0.9 to the 64th leaves the film's step far above a millionth of the light.
#[test]
fn more_bounces_than_the_film_resolves_are_refused() {
    let lamp = Surface::Emitter(Radiance::new(DVec3::ONE).expect("a radiance"));
    let chalk = Surface::Diffuse(Albedo::new(DVec3::splat(0.9)).expect("an albedo"));
    let spheres = vec![sphere([0.0; 3], 9.0, chalk), sphere([0.0; 3], 1.0, lamp)];
    let scene = scene([0.0, 0.0, 4.0], [0.0; 3], spheres);
    let check = |bounces| {
        let settings = scene.settings().with_bounces(bounces).expect("bounces");
        candor::bound::check(&scene.clone().with_settings(settings))
    };
    // 2⁻⁶³·1.8^k <= 1e-6 up to k = 50.8, and the step is that or half of it.
    assert!(check(50).is_ok() && check(52).is_err());
    assert!(check(64).expect_err("too many").0.contains("at most 5"));
}

#[test]
fn a_far_camera_does_not_move_the_focus() {
    let ball = vec![sphere([0.0, 0.0, 0.0], 1.0, white())];
    let viewpoint = Viewpoint::of(&scene([0.0, 0.0, 1e6], [0.0; 3], ball));
    assert!(viewpoint.focus().length() < 1e-9, "{viewpoint:?}");
    assert!((viewpoint.extent() - 3.0_f64.sqrt()).abs() < 1e-9, "{viewpoint:?}");
}

#[test]
fn sides_follow_the_camera() {
    let at = |z: f64| {
        let spheres = vec![
            sphere([0.0; 3], 10.0, white()),
            sphere([0.0, 0.0, z], 1.0, white()),
            sphere([20.0, 0.0, 0.0], 1.0, white()),
        ];
        scene([0.0, 0.0, z], [0.0, 0.0, z - 1.0], spheres)
    };
    let inside = |scene: &Scene| Viewpoint::of(scene).inside().to_vec();
    assert_eq!(inside(&at(5.0)), [true, true, false]);
    assert_eq!(inside(&at(15.0)), [false, true, false]);
    assert!(effects(&at(5.0)).has(Effect::Interior));
}

/// Standing on a surface, the camera is on the side that it looks to.
#[test]
fn a_camera_on_a_surface_is_on_the_side_that_it_looks_to() {
    let ball = || vec![sphere([5.0, 0.0, 0.0], 0.1, white()), sphere([0.0; 3], 1.0, white())];
    for off in [0.0, 2e-16, -2e-16] {
        let position = [0.0, 0.0, 1.0 + off];
        let outward = Viewpoint::of(&scene(position, [0.0, 0.0, 9.0], ball()));
        assert_eq!(outward.inside(), [false, false], "{off}");
        let inward = Viewpoint::of(&scene(position, [0.0, 0.0, -9.0], ball()));
        assert_eq!(inward.inside(), [false, true], "{off}");
    }
    for (height, inside) in [(1e-12, false), (-1e-12, true)] {
        let off = Viewpoint::of(&scene([0.0, 0.0, 1.0 + height], [0.0, 0.0, -9.0], ball()));
        assert_eq!(off.inside(), [false, inside], "{height}");
    }
}

#[test]
fn effects_are_what_the_surfaces_are() {
    let gloss = Surface::Glossy(
        Albedo::new(DVec3::ONE).expect("an albedo"),
        Exponent::new(3.0).expect("an exponent"),
    );
    let lamp = Surface::Emitter(Radiance::new(DVec3::ONE).expect("a radiance"));
    let of = |surface| {
        let s = scene([0.0, 0.0, 9.0], [0.0; 3], vec![sphere([0.0; 3], 1.0, surface)]);
        let found = effects(&s);
        [Effect::Diffuse, Effect::Glossy, Effect::Interior].map(|effect| found.has(effect))
    };
    assert_eq!(of(white()), [true, false, false]);
    assert_eq!(of(gloss), [false, true, false]);
    assert_eq!(of(lamp), [false, false, false]);
}

/// §7 of DESIGN.md by hand: 10·(2·0.75)² and the rounding's share, so that the next power
/// of two above 22.5 is 2⁵ and the shift 64 - 5.
#[test]
fn the_bound_is_the_product_of_the_largest_weights() {
    let lamp = Surface::Emitter(Radiance::new(DVec3::splat(10.0)).expect("a radiance"));
    let grey = Surface::Diffuse(Albedo::new(DVec3::splat(0.75)).expect("an albedo"));
    let spheres = vec![sphere([0.0; 3], 1.0, lamp), sphere([3.0, 0.0, 0.0], 1.0, grey)];
    let scale = sample_scale(&scene([0.0, 0.0, 9.0], [0.0; 3], spheres));
    assert!((f64::from(scale.bound()) / 22.5 - 1.0).abs() < 4e-6, "{scale:?}");
    assert!(f64::from(scale.bound()) > 22.5);
    assert_eq!(scale.shift(), 64 - 5);
    assert!(scale.admits([scale.bound(), 0.0, 1.0]));
    for bad in [scale.bound().next_up(), -1e-30, f32::NAN, f32::INFINITY] {
        assert!(!scale.admits([0.0, bad, 0.0]), "{bad}");
    }
}

#[test]
fn kernel_units_put_the_extent_between_one_and_two() {
    for extent_of in [1e-6, 3.0, 1e6] {
        let ball = vec![sphere([0.0; 3], extent_of, white())];
        let viewpoint = Viewpoint::of(&scene([0.0, 0.0, 9.0], [0.0; 3], ball));
        let extent = KernelUnits::of(&viewpoint).length(viewpoint.extent());
        assert!((1.0..2.0).contains(&extent), "{extent}");
    }
}
