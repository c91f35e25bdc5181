//! Comparing two pictures.

use crate::candor::Folder;
use exr::prelude::{ReadChannels, ReadLayers, write_rgb_file};

/// A grey ball in a lamp: every path that scatters once meets light.
const BALL: &str = "\
[camera]
position = [0.0, 0.0, 3.0]
look_at = [0.0, 0.0, 0.0]
vertical_fov = 40.0

[image]
width = 64
height = 48

[render]
spp = 128
bounces = 1

[materials.grey]
diffuse = [0.5, 0.5, 0.5]

[[spheres]]
center = [0.0, 0.0, 0.0]
radius = 1.0
material = \"grey\"

[[spheres]]
center = [0.0, 0.0, 0.0]
radius = 100.0
emission = [1.0, 1.0, 1.0]
";

/// A folder with pictures of the ball: seeds 1 and 2, and seed 3 with an albedo 1 % higher.
/// Some 2000 pixels show it, with a relative variance of 1/3 per sample: the image is known
/// to 0.11 % of the ball, its difference to 0.16 %, and 1 % are 6 standard errors.
fn pictures() -> Folder {
    let folder = Folder::new();
    folder.write("ball.toml", BALL);
    folder.write(
        "brighter.toml",
        &BALL.replace("diffuse = [0.5, 0.5, 0.5]", "diffuse = [0.505, 0.505, 0.505]"),
    );
    for (scene, seed, output) in [("ball", 1, "a"), ("ball", 2, "b"), ("brighter", 3, "c")] {
        let arguments =
            format!("render {scene}.toml --device cpu --quiet --seed {seed} -o {output}.exr");
        folder.candor(&arguments).silently_done();
    }
    folder
}

/// The picture in `from` as another program writes it: colours alone.
fn strip(folder: &Folder, from: &str, to: &str) {
    let (width, height, pixels) = colours(folder, from);
    write_rgb_file(folder.path(to), width, height, |x, y| pixels[y * width + x]).expect("written");
}

fn colours(folder: &Folder, name: &str) -> (usize, usize, Vec<(f32, f32, f32)>) {
    let image = exr::prelude::read()
        .no_deep_data()
        .largest_resolution_level()
        .rgb_channels(
            |size, _| (size.x(), vec![(0.0, 0.0, 0.0); size.area()]),
            |(width, pixels), at, rgb: (f32, f32, f32)| pixels[at.y() * *width + at.x()] = rgb,
        )
        .first_valid_layer()
        .all_attributes()
        .from_file(folder.path(name))
        .expect("a picture");
    let (width, pixels) = image.layer_data.channel_data.pixels;
    (width, pixels.len() / width, pixels)
}

#[test]
fn two_seeds_agree_and_another_material_differs() {
    let folder = pictures();
    let results = folder.candor("diff a.exr b.exr").silently_done();
    for part in [
        "\nrmse      ",
        "expected from the error bars",
        "\nrel. mse ",
        "\nimage     z ",
        "\ntiles     largest z ",
        "wrote     a.diff.png",
        "verdict   they differ by no more than",
    ] {
        assert!(results.contains(part), "no \"{part}\" in {results}");
    }
    let json = folder.candor("diff a.exr b.exr --json").with_code(0).json();
    assert_eq!(
        (&json["verdict"], &json["shares_samples"]),
        (&"within-error-bars".into(), &false.into())
    );
    assert!(json["p"].as_f64() > Some(1e-3), "{json:?}");

    let ended = folder.candor("diff a.exr c.exr").with_code(1);
    assert!(ended.stdout.contains("verdict   THEY DIFFER by more than"), "{}", ended.stdout);
    assert_eq!(ended.stderr, "warning: the pictures are of different scenes\n");
    let ended = folder.candor("diff a.exr c.exr --quiet --json").with_code(1);
    assert_eq!(ended.stderr, "");
    let json = ended.json();
    assert!(json["image_z"].as_f64() < Some(-3.3), "{json:?}");
    assert_eq!(json["verdict"], "differ");
    assert_eq!(json["warnings"].as_array().map(Vec::len), Some(1));
}

#[test]
fn the_picture_of_the_differences_is_where_it_is_asked_for() {
    let folder = pictures();
    let before = folder.files();
    folder.candor("diff a.exr b.exr").silently_done();
    folder.candor("diff a.exr b.exr -o where.PNG").silently_done();
    let new: Vec<_> = folder.files().into_iter().filter(|name| !before.contains(name)).collect();
    assert_eq!(new, ["a.diff.png", "where.PNG"]);
    let picture = image::load_from_memory(&folder.read("a.diff.png")).expect("a PNG").into_rgb8();
    // As wide as the pictures, with the legend below: the two ends of the scale.
    assert_eq!(picture.dimensions(), (64, 48 + 16));
    assert_eq!(
        (picture.get_pixel(0, 63).0, picture.get_pixel(63, 63).0),
        ([5, 48, 97], [103, 0, 31])
    );
    // The lamp is the same in both, to the last bit.
    assert_eq!(picture.get_pixel(0, 0).0, [247; 3]);
}

/// A picture without error bars is taken as exact, noise and all: one of 32 times the
/// samples is exact enough, one of the same number is not. Without any bars there is no verdict.
#[test]
fn pictures_of_other_programs_are_taken_as_exact() {
    let folder = pictures();
    let render = "render ball.toml --device cpu --quiet --seed 4 --spp 4096 -o fine.exr";
    folder.candor(render).silently_done();
    strip(&folder, "fine.exr", "exact.exr");
    strip(&folder, "a.exr", "noisy.exr");
    strip(&folder, "c.exr", "brighter.exr");
    let results = folder.candor("diff b.exr exact.exr").silently_done();
    assert!(results.contains("exact.exr: no error bars; taken as exact"), "{results}");
    folder.candor("diff b.exr noisy.exr").with_code(1);
    folder.candor("diff b.exr brighter.exr").with_code(1);
    let ended = folder.candor("diff exact.exr brighter.exr").with_code(2);
    assert!(ended.stdout.contains("verdict   none: neither picture has error bars"), "{ended:?}");
    assert!(ended.stdout.contains("full colour at 50 % of b"), "{}", ended.stdout);
    let json = folder.candor("diff exact.exr brighter.exr --json").with_code(2).json();
    assert!(json["rmse"].as_f64() > Some(0.0) && json["p"].is_null(), "{json:?}");
}

#[test]
fn identical_pictures_are_said_to_be() {
    let folder = pictures();
    strip(&folder, "a.exr", "exact.exr");
    for other in ["a.exr", "exact.exr"] {
        let results = folder.candor(&format!("diff a.exr {other}")).silently_done();
        assert!(results.contains("verdict   identical"), "{results}");
    }
}

/// The tests take errors for independent; where they are not, the user is told.
#[test]
fn shared_samples_are_told() {
    let folder = pictures();
    folder
        .candor("render ball.toml --device cpu --quiet --seed 1 --samples 100..300 -o more.exr")
        .silently_done();
    let ended = folder.candor("diff a.exr more.exr").with_code(0);
    assert!(
        ended.stderr.starts_with("warning: both pictures hold samples 100..128 of seed 1"),
        "{}",
        ended.stderr
    );
    assert!(
        ended.stdout.contains("which says little where samples are shared"),
        "{}",
        ended.stdout
    );
    folder
        .candor("render ball.toml --device cpu --quiet --seed 1 --samples 128..300 -o rest.exr")
        .silently_done();
    folder.candor("diff a.exr rest.exr").silently_done();
}

#[test]
fn too_few_hits_are_no_verdict() {
    let folder = Folder::new();
    for seed in [1, 2] {
        let render =
            format!("render scene.toml --spp 2 --device cpu --quiet --seed {seed} -o {seed}.exr");
        folder.candor(&render).silently_done();
    }
    let ended = folder.candor("diff 1.exr 2.exr").with_code(2);
    assert!(ended.stdout.contains("verdict   none: too few hits to tell"), "{}", ended.stdout);
}

#[test]
fn what_cannot_be_compared_is_refused() {
    let folder = Folder::new();
    for (arguments, output) in [("", "a"), ("--size 5x9", "small"), ("--spp 1", "single")] {
        let render = format!("render scene.toml --device cpu --quiet {arguments} -o {output}.exr");
        folder.candor(&render).silently_done();
    }
    let whole = folder.read("a.exr");
    std::fs::write(folder.path("torn.exr"), &whole[..whole.len() - 100]).expect("written");
    std::fs::create_dir(folder.path("folder.exr")).expect("a folder can be made");
    let before = folder.files();
    let table: [(&str, &[&str]); 8] = [
        ("a.exr small.exr", &["a.exr has 8x6 pixels, small.exr has 5x9"]),
        ("a.exr single.exr", &["single.exr: pixel ", "one sample says nothing of it"]),
        ("a.exr torn.exr", &["torn.exr: its pixels cannot be read"]),
        ("folder.exr a.exr", &["folder.exr: is a folder"]),
        ("a.exr none.exr", &["none.exr: No such file"]),
        ("scene.toml a.exr", &["scene.toml: is not a readable EXR"]),
        ("a.exr a.exr -o a.jpg", &["a.jpg: the ending must be .png"]),
        ("a.exr a.exr -o missing/a.png", &["the folder missing does not exist"]),
    ];
    for (arguments, parts) in table {
        folder.candor(&format!("diff {arguments}")).refused(parts);
    }
    assert_eq!(folder.files(), before);
    folder.candor("diff a.exr").with_code(2);
}
