//! What a valid scene file says, and what its hash depends on.

use std::path::Path;

use candor::scene::{
    Albedo, Estimator, Exponent, Radiance, Scene, SceneHash, Sphere, Surface, load, parse,
};
use glam::DVec3;

fn classic() -> String {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml");
    std::fs::read_to_string(path).expect("the classic scene can be read")
}

fn scene(text: &str) -> Scene {
    parse("test.toml", text).unwrap_or_else(|error| panic!("{error}"))
}

fn hash(text: &str) -> SceneHash {
    scene(text).hash()
}

/// The classic scene with `from`, which it must contain, replaced by `to`.
fn changed(from: &str, to: &str) -> String {
    let text = classic();
    assert!(text.contains(from), "the classic scene has {from}");
    text.replace(from, to)
}

fn sphere(name: &str, center: [f64; 3], radius: f64, surface: Surface) -> Sphere {
    Sphere::new(center.into(), radius, surface).expect("a valid sphere").named(name)
}

#[test]
fn the_classic_scene_is_read_as_it_is_written() {
    let diffuse = |rgb: [f64; 3]| Surface::Diffuse(Albedo::new(rgb.into()).expect("an albedo"));
    let light = Radiance::new(DVec3::splat(10.0)).expect("a radiance");
    let gloss = Surface::Glossy(
        Albedo::new(DVec3::splat(0.9)).expect("an albedo"),
        Exponent::new(100.0).expect("an exponent"),
    );
    let white = diffuse([0.75; 3]);
    let expected = [
        sphere("lamp", [0.0, 2.0, 0.0], 0.6, Surface::Emitter(light)),
        sphere("left wall", [-100_003.0, 0.0, 0.0], 1e5, diffuse([0.75, 0.25, 0.25])),
        sphere("right wall", [100_003.0, 0.0, 0.0], 1e5, diffuse([0.25, 0.25, 0.75])),
        sphere("floor", [0.0, -100_003.0, 0.0], 1e5, white),
        sphere("ceiling", [0.0, 100_003.0, 0.0], 1e5, white),
        sphere("back wall", [0.0, 0.0, -100_004.0], 1e5, white),
        sphere("left sphere", [-1.3, -2.0, -1.0], 1.0, diffuse([0.9; 3])),
        sphere("right sphere", [1.3, -2.0, 0.5], 1.0, gloss),
    ];
    let scene = scene(&classic());
    // In a scene, spheres have numbers.
    let expected =
        Scene::new(scene.camera().clone(), scene.size(), scene.settings(), expected.into());
    assert_eq!(scene.spheres(), expected.spheres());
    assert_eq!(scene.camera().position(), DVec3::new(0.0, 0.0, 9.0));
    assert_eq!(scene.camera().forward(), DVec3::NEG_Z);
    assert_eq!(scene.camera().up(), DVec3::Y);
    assert!((scene.camera().vertical_fov().to_degrees() - 48.455).abs() < 1e-12);
    assert_eq!((scene.size().width(), scene.size().height()), (512, 512));
    let settings = scene.settings();
    assert_eq!((settings.spp(), settings.bounces(), settings.seed()), (256, 2, 0));
    assert_eq!(settings.estimator(), Estimator::Implicit);
}

#[test]
fn load_reads_what_parse_reads() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml");
    assert_eq!(load(&path).expect("a valid scene"), scene(&classic()));
}

const CAMERA: &str = "camera = { position = [0, 0, 9], look_at = [0, 0, 0], vertical_fov = 50 }
image = { width = 0x40, height = 4_8 }
";

#[test]
fn every_way_to_write_toml_is_the_same_scene() {
    let inline = format!(
        "{CAMERA}materials = {{ m = {{ glossy = [1, 0.5, 0], exponent = 7 }} }}
spheres = [{{ center = [1, 2, 3], radius = 1e1, material = \"m\" }}]"
    );
    let dotted = format!(
        "{CAMERA}materials.m.glossy = [1.0, 5e-1, -0.0]\r\nmaterials.m.exponent = 7.0\r\n
[[spheres]] # the only one\r\ncenter = [\n  +1,\n  2,\n  3,\n]\r\nradius = 0xA\r\nmaterial = 'm'"
    );
    assert_eq!(scene(&inline), scene(&dotted));
    assert_eq!(hash(&inline), hash(&dotted));
    assert_eq!(scene(&inline), scene(&format!("\u{feff}{inline}")));
}

#[test]
fn what_may_be_left_out() {
    let empty = scene(CAMERA);
    assert!(empty.spheres().is_empty() && !empty.has_lights());
    assert_eq!(empty.settings().spp(), 256);
    let partly = scene(&format!("{CAMERA}render = {{ seed = 4294967295 }}"));
    assert_eq!((partly.settings().seed(), partly.settings().bounces()), (u32::MAX, 2));
    let unused = scene(&format!("{CAMERA}[materials.unused]\ndiffuse = [0, 0, 0]"));
    assert_eq!(unused, empty);
}

#[test]
fn columns_do_not_count_a_byte_order_mark() {
    let error = parse("bom.toml", "\u{feff}camera = 1\r\n").expect_err("not a camera");
    assert!(error.to_string().contains("bom.toml:1:10\n"), "{error}");
}

#[test]
fn the_hash_is_fixed() {
    // Computed from the documented encoding by another program. A film written by one
    // version must be known to the next, so a change here needs a new tag.
    let expected = "4ee2bd84b865347812bc9986442c27cf54144cb145f22855f4519d99b3972dad";
    assert_eq!(hash(&classic()).to_string(), expected);
}

#[test]
fn names_comments_and_render_do_not_change_the_hash() {
    let classic = hash(&classic());
    let same = [
        changed("name = \"lamp\"", "name = \"sun\""),
        changed("name = \"floor\"\n", "# nameless\n"),
        changed("spp = 256", "spp = 1"),
        changed("bounces = 2", "bounces = 5\nseed = 3"),
        changed("white", "wall"),
        changed("[materials.chalk]", "[materials.unused]\ndiffuse = [0, 0, 0]\n[materials.chalk]"),
        changed("[0.0, 2.0, 0.0]", "[-0.0, 2, 0]"),
        changed("vertical_fov", "up = [0, 2, 0]\nvertical_fov"),
    ];
    for text in same {
        assert_eq!(hash(&text), classic, "{text}");
    }
}

#[test]
fn whatever_the_picture_depends_on_changes_the_hash() {
    let mut seen = vec![hash(&classic())];
    let different = [
        changed("position = [0.0, 0.0, 9.0]", "position = [0.0, 0.0, 9.000000000000002]"),
        changed("look_at = [0.0, 0.0, 0.0]", "look_at = [0.0, 0.1, 0.0]"),
        changed("vertical_fov", "up = [0.1, 1.0, 0.0]\nvertical_fov"),
        changed("48.455", "48.456"),
        changed("width = 512", "width = 511"),
        changed("height = 512", "height = 511"),
        changed("radius = 0.6", "radius = 0.6000000000000001"),
        changed("[-1.3, -2.0, -1.0]", "[-1.3, -2.0, -1.1]"),
        changed("[10.0, 10.0, 10.0]", "[10.0, 10.0, 10.1]"),
        changed("diffuse = [0.75, 0.75, 0.75]", "diffuse = [0.75, 0.75, 0.76]"),
        changed("exponent = 100.0", "exponent = 101.0"),
        changed("glossy = [0.9, 0.9, 0.9]", "glossy = [0.8, 0.9, 0.9]"),
        changed("glossy = [0.9, 0.9, 0.9]\nexponent = 100.0", "diffuse = [0.9, 0.9, 0.9]"),
        changed("material = \"chalk\"", "emission = [0.9, 0.9, 0.9]"),
        changed("material = \"red\"", "material = \"blue\""),
        changed(
            "[[spheres]]\nname = \"lamp\"",
            "[[spheres]]\ncenter = [0, 0, 0]\nradius = 0.1\nmaterial = \"red\"\n\n[[spheres]]",
        ),
        swapped_walls(),
    ];
    for text in different {
        let hash = hash(&text);
        assert!(!seen.contains(&hash), "{text}");
        seen.push(hash);
    }
}

/// The classic scene with the left and the right wall in each other's place in the list.
fn swapped_walls() -> String {
    let text = classic();
    let [before, left, right, after] = {
        let left = text.find("[[spheres]]\nname = \"left wall\"").expect("a left wall");
        let right = text.find("[[spheres]]\nname = \"right wall\"").expect("a right wall");
        let floor = text.find("[[spheres]]\nname = \"floor\"").expect("a floor");
        [&text[..left], &text[left..right], &text[right..floor], &text[floor..]]
    };
    [before, right, left, after].concat()
}
