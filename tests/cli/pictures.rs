//! What is in the files.

use crate::candor::{Folder, SCENE, dark_scene};
use exr::meta::attribute::{AttributeValue, Chromaticities};
use exr::prelude::{FlatSamples, Vec2, read_first_flat_layer_from_file};
use std::collections::BTreeMap;
use std::path::Path;

/// A film, as any reader of EXR sees it.
struct Film {
    size: (usize, usize),
    /// Bits of the samples, so that equal means equal.
    channels: BTreeMap<String, Vec<u32>>,
    attributes: BTreeMap<String, String>,
    chromaticities: Option<Chromaticities>,
}

impl Film {
    fn read(path: &Path) -> Self {
        let image = read_first_flat_layer_from_file(path).expect("the film can be read");
        let layer = image.layer_data;
        let channels = layer.channel_data.list.into_iter().map(|channel| {
            let bits = match channel.sample_data {
                FlatSamples::F32(samples) => samples.into_iter().map(f32::to_bits).collect(),
                FlatSamples::U32(samples) => samples,
                FlatSamples::F16(_) => panic!("{} is half", channel.name),
            };
            (channel.name.to_string(), bits)
        });
        let texts = layer.attributes.other.into_iter().filter_map(|(name, value)| match value {
            AttributeValue::Text(text) => {
                let text = String::from_utf8(text.as_slice().to_vec()).expect("UTF-8");
                Some((name.to_string(), text))
            }
            _ => None,
        });
        Self {
            size: (layer.size.x(), layer.size.y()),
            channels: channels.collect(),
            attributes: texts.collect(),
            chromaticities: image.attributes.chromaticities,
        }
    }
}

/// The channels of the picture, without the sums.
const PICTURE: [&str; 4] = ["B", "G", "R", "stderr.L"];

#[test]
fn a_film_has_the_mean_and_its_error() {
    let folder = Folder::new();
    folder.candor("render scene.toml --device cpu --quiet").silently_done();
    let film = Film::read(&folder.path("scene.exr"));
    assert_eq!(film.size, (8, 6));
    let (sums, rest): (Vec<_>, Vec<_>) =
        film.channels.iter().partition(|(name, _)| name.starts_with("sum."));
    assert_eq!(sums.len(), 3 * 3 + 4);
    assert_eq!(rest.iter().map(|(name, _)| name.as_str()).collect::<Vec<_>>(), PICTURE);
    for (name, bits) in rest {
        assert_eq!(bits.len(), 8 * 6, "{name}");
        let values = || bits.iter().map(|&bits| f32::from_bits(bits));
        assert!(values().all(|x| x >= 0.0), "{name}");
        assert!(values().any(|x| x.is_finite() && x > 0.0), "{name}");
    }
}

#[test]
fn a_film_says_where_it_comes_from() {
    let folder = Folder::new();
    let arguments = "render scene.toml --device cpu --json --seed 7 --bounces 3 --samples 2..9";
    let json = folder.candor(arguments).with_code(0).json();
    let film = Film::read(&folder.path("scene.exr"));
    let table = [
        ("version", env!("CARGO_PKG_VERSION")),
        ("scene", "scene.toml"),
        ("estimator", "implicit"),
        ("bounces", "3"),
        ("seed", "7"),
        ("samples", "2..9"),
        ("spp", "7"),
        ("device", json["device"].as_str().expect("a name")),
        ("driver", json["driver"].as_str().expect("a name")),
        ("invalidSamples", "0"),
        ("relativeError", &json["relative_error"].to_string()),
    ];
    for (name, value) in table {
        assert_eq!(film.attributes[&format!("candor.{name}")], value, "{name}");
    }
    for name in ["sceneHash", "filmShift", "seconds"] {
        assert!(!film.attributes[&format!("candor.{name}")].is_empty(), "{name}");
    }
    let rec_709 = Chromaticities {
        red: Vec2(0.64, 0.33),
        green: Vec2(0.30, 0.60),
        blue: Vec2(0.15, 0.06),
        white: Vec2(0.3127, 0.3290),
    };
    assert!(film.chromaticities == Some(rec_709));
}

#[test]
fn any_scene_name_will_do() {
    let folder = Folder::new();
    folder.write("シーン é.toml", SCENE);
    let mut command = folder.command("render --device cpu --quiet");
    let ended = command.arg("シーン é.toml").output().expect("runs");
    assert!(ended.status.success());
    assert_eq!(folder.files(), ["シーン é.exr", "シーン é.png", "シーン é.toml"]);
    let film = Film::read(&folder.path("シーン é.exr"));
    assert_eq!(film.attributes["candor.scene"], "シーン é.toml");
}

#[test]
fn a_seed_gives_the_same_bits_again() {
    let folder = Folder::new();
    for device in ["gpu", "cpu"] {
        let render = |seed: &str, output: &str| {
            let arguments = format!("render scene.toml --device {device} --quiet --seed {seed}");
            folder.candor(&format!("{arguments} -o {output}")).silently_done();
            Film::read(&folder.path(output)).channels
        };
        let first = render("1", "first.exr");
        assert!(first == render("1", "again.exr"), "{device}");
        assert!(first != render("2", "other.exr"), "{device}");
    }
}

#[test]
fn sample_ranges_are_different_samples() {
    let folder = Folder::new();
    let render = |arguments: &str| {
        let arguments =
            format!("render scene.toml --device cpu --quiet --force -o a.exr {arguments}");
        folder.candor(&arguments).silently_done();
        Film::read(&folder.path("a.exr")).channels
    };
    let whole = render("--spp 4");
    assert!(whole == render("--samples 0..4"));
    assert!(whole != render("--samples 4..8"));
}

fn png(folder: &Folder, name: &str) -> image::RgbImage {
    let picture = image::load_from_memory(&folder.read(name)).expect("a PNG");
    assert_eq!(picture.color(), image::ColorType::Rgb8);
    picture.into_rgb8()
}

#[test]
fn exposure_brightens_the_png_alone() {
    let folder = Folder::new();
    let mut films = Vec::new();
    let mut sums = Vec::new();
    for stops in ["-2", "0", "1.5"] {
        let arguments = format!("render scene.toml --device cpu --quiet --exposure {stops}");
        folder.candor(&arguments).silently_done();
        let picture = png(&folder, "scene.png");
        assert_eq!(picture.dimensions(), (8, 6));
        sums.push(picture.iter().map(|&byte| u64::from(byte)).sum::<u64>());
        films.push(Film::read(&folder.path("scene.exr")).channels);
    }
    assert!(0 < sums[0] && sums[0] < sums[1] && sums[1] < sums[2], "{sums:?}");
    assert!(films.windows(2).all(|pair| pair[0] == pair[1]));
}

/// Without light everything is known: exact zeros, error 0, and the samples as asked for.
/// No device is needed, and none is asked for one.
#[test]
fn a_scene_without_lights_is_exactly_black() {
    let folder = Folder::new();
    folder.write("dark.toml", dark_scene());
    for device in ["auto", "gpu", "cpu"] {
        let arguments = format!("render dark.toml --spp 1000000000 --json --device {device}");
        let json = folder.candor(&arguments).with_code(0).json();
        assert_eq!(json["relative_error"], 0.0);
        assert_eq!((&json["spp"], &json["unproven_pixels"]), (&1_000_000_000.into(), &0.into()));
        let film = Film::read(&folder.path("dark.exr"));
        assert_eq!(film.attributes["candor.spp"], "1000000000");
        assert_eq!(film.channels.len(), 4 + 3 * 3 + 4);
        assert!(film.channels.values().flatten().all(|&bits| bits == 0));
        assert!(png(&folder, "dark.png").iter().all(|&byte| byte == 0));
    }
}

#[test]
fn the_size_can_be_chosen() {
    let folder = Folder::new();
    folder.candor("render scene.toml --size 5x9 --device gpu --quiet").silently_done();
    assert_eq!(Film::read(&folder.path("scene.exr")).size, (5, 9));
    assert_eq!(png(&folder, "scene.png").dimensions(), (5, 9));
}
