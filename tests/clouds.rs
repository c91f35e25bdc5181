//! Spheres from data files: what is read, where it stands, and how much of it.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use candor::scene::{
    Albedo, Exponent, Scene, SceneFileError, Sphere, Surface, load, load_with_source, parse,
};
use csv::{QuoteStyle, ReaderBuilder, WriterBuilder};
use glam::DVec3;
use tempfile::TempDir;

#[path = "../examples/particles.rs"]
#[allow(dead_code, reason = "its main function is for the command line")]
mod particles;

const HEAD: &str = "camera = { position = [0, 0, 9], look_at = [0, 0, 0], vertical_fov = 50 }
image = { width = 64, height = 48 }
materials.red.diffuse = [0.75, 0.25, 0.25]
materials.gloss = { glossy = [0.9, 0.9, 0.9], exponent = 7 }
";

/// A folder with `files`, and with a scene whose clouds are `clouds`.
fn folder(clouds: &str, files: &[(&str, &str)]) -> TempDir {
    let folder = tempfile::tempdir().expect("a temporary folder");
    for (name, data) in files {
        fs::write(folder.path().join(name), data).expect("a temporary file can be written");
    }
    let scene = format!("{HEAD}{clouds}");
    fs::write(folder.path().join("scene.toml"), scene).expect("a temporary file can be written");
    folder
}

fn read(folder: &TempDir) -> Result<Scene, SceneFileError> {
    load(&folder.path().join("scene.toml"))
}

fn scene(clouds: &str, files: &[(&str, &str)]) -> Scene {
    read(&folder(clouds, files)).unwrap_or_else(|error| panic!("{error}"))
}

/// The message, without the name of the folder.
fn refused(clouds: &str, files: &[(&str, &str)]) -> String {
    let folder = folder(clouds, files);
    let error = read(&folder).expect_err("something is wrong with it");
    error.to_string().replace(&folder.path().join("").display().to_string(), "")
}

fn diffuse(rgb: [f64; 3]) -> Surface {
    Surface::Diffuse(Albedo::new(rgb.into()).expect("an albedo"))
}

/// Centre, radius and surface of each sphere.
fn parts(scene: &Scene) -> Vec<([f64; 3], f64, Surface)> {
    let part = |s: &Sphere| (s.center().to_array(), s.radius(), s.surface());
    scene.spheres().iter().map(part).collect()
}

const ONE_CSV: &str = "clouds = [{ file = \"a.csv\", material = \"red\", radius = 0.5 }]";

#[test]
fn columns_are_found_by_name() {
    let expected = [
        ([1.0, 2.0, -3.5], 0.25, diffuse([0.1, 0.2, 0.3])),
        ([4.0, 0.0, 1e-3], 2.0, diffuse([1.0, 0.0, 0.5])),
    ];
    let clouds = "clouds = [{ file = \"a.csv\" }]";
    let written = [
        "x,y,z,radius,r,g,b\n1,2,-3.5,0.25,0.1,0.2,0.3\n4,0,1e-3,2,1,0,0.5\n",
        "x,y,z,radius,r,g,b\n1,2,-3.5,0.25,0.1,0.2,0.3\n4,0,1e-3,2,1,0,0.5",
        "\u{feff}X, Y ,Z,Radius,R,G,B\r\n1,2,-3.5,.25,.1,.2,.3\r\n\r\n4,0,0.001,2.,1,0,0.5\r\n",
        "# found\nb,id,g,z,r,radius,y,x,\n0.3,p1,0.2,-3.5,0.1,0.25,2,1,\n  \n# and\n\
         0.5,\"p, \"\"2\"\"\",0,0.001,1,2,0,4,\n",
        "x,y,z,radius,r,g,b\n1,2,-3.5,0.25,0.1,0.2,0.3\n,,,,,,\n4,0,1e-3,2,1,0,0.5\n , ,,,,,\n",
        "\"x\",\"y\",\"z\",\"radius\",\"r\",\"g\",\"b\"\n\"1\",\"2\",\"-3.5\",\"0.25\",\"0.1\",\
         \"0.2\",\"0.3\"\n 4 ,\t0, \"1e-3\" ,\"2\",+1,-0,0.5\n",
    ];
    for text in written {
        assert_eq!(parts(&scene(clouds, &[("a.csv", text)])), expected, "{text}");
    }
}

#[test]
fn the_scene_places_and_colours_rows() {
    let clouds = "
[[spheres]]
center = [0, 0, 0]
radius = 1
material = \"red\"
[[clouds]]
file = \"a.csv\"
radius = 0.1
material = \"red\"
scale = 0.5
offset = [10, 20, 30]
[[clouds]]
file = \"sub/b.CSV\"
material = \"gloss\"
scale = 0.1
";
    let folder = folder(clouds, &[("a.csv", "x,y,z\n1,2,3\n\n-3,0,0.25\n")]);
    fs::create_dir(folder.path().join("sub")).expect("a folder can be made");
    let coloured = "x,y,z,radius,r,g,b\n3,0,0,0.7,0.1,0.2,0.3\n";
    fs::write(folder.path().join("sub/b.CSV"), coloured).expect("a file can be written");
    let scene = read(&folder).unwrap_or_else(|error| panic!("{error}"));
    let albedo = Albedo::new(DVec3::new(0.1, 0.2, 0.3)).expect("an albedo");
    let red = diffuse([0.75, 0.25, 0.25]);
    let expected = [
        ([0.0; 3], 1.0, red),
        ([10.5, 21.0, 31.5], 0.1, red),
        ([8.5, 20.0, 30.125], 0.1, red),
        ([0.1 * 3.0, 0.0, 0.0], 0.1 * 0.7, Surface::Glossy(albedo, Exponent::new(7.0).expect("n"))),
    ];
    assert_eq!(parts(&scene), expected);
    let titles: Vec<String> = scene.spheres().iter().map(Sphere::title).collect();
    let expected = [
        "sphere 1",
        "sphere 2 (a.csv, line 2)",
        "sphere 3 (a.csv, line 4)",
        "sphere 4 (sub/b.CSV, line 2)",
    ];
    assert_eq!(titles, expected);
    assert_eq!(scene.spheres()[3].label(), "sub/b.CSV, line 2");
    assert_eq!(scene.spheres()[3].name(), None);
}

#[test]
fn atoms_have_the_size_and_colour_of_their_element() {
    let text = "5\nby symbol, number, and with more columns\nC 0 0 0\no 1 0 0 0.25 -0.5\n\
                \t17\t2.0\t0\t0\r\nFE 3 0 0\nD 4 0 0\n\n";
    // Mantina et al. 2009 and Alvarez 2013; sRGB 909090, FF0D0D, 1FF01F, E06633 and FFFFFF.
    let radii: [f64; 5] = [1.70, 1.52, 1.75, 2.44, 1.10];
    let linear = |byte: f64| {
        let x: f64 = byte / 255.0;
        if x > 0.04045 { ((x + 0.055) / 1.055).powf(2.4) } else { x / 12.92 }
    };
    let colours = [
        [144.0, 144.0, 144.0],
        [255.0, 13.0, 13.0],
        [31.0, 240.0, 31.0],
        [224.0, 102.0, 51.0],
        [255.0, 255.0, 255.0],
    ];
    let parts_of = |clouds: &str| parts(&scene(clouds, &[("m.xyz", text)]));
    let half = parts_of("clouds = [{ file = \"m.xyz\", scale = 0.5 }]");
    assert_eq!(half.len(), 5);
    for (n, &(center, radius, surface)) in half.iter().enumerate() {
        let expected = [[0.0, 0.5, 1.0, 1.5, 2.0][n], 0.0, 0.0];
        assert_eq!(center.map(f64::to_bits), expected.map(f64::to_bits));
        assert_eq!(radius.to_bits(), (0.5 * radii[n]).to_bits());
        let Surface::Diffuse(albedo) = surface else { panic!("{surface:?}") };
        let off = (albedo.rgb() - DVec3::from_array(colours[n].map(linear))).abs();
        assert!(off.max_element() < 1e-15, "{albedo:?}");
    }
    // A radius of the scene is in its unit, and takes the place of all.
    let equal = parts_of(
        "clouds = [{ file = \"m.xyz\", scale = 0.5, radius = 0.3, material = \"gloss\" }]",
    );
    assert!(equal.iter().all(|&(_, radius, _)| radius.to_bits() == 0.3_f64.to_bits()));
    assert!(equal.iter().all(
        |part| matches!(part.2, Surface::Glossy(_, n) if n.get().to_bits() == 7.0_f64.to_bits())
    ));
}

/// A sphere is the same wherever it was read from.
#[test]
fn the_hash_counts_spheres_and_not_files() {
    let by_rows = scene(ONE_CSV, &[("a.csv", "x,y,z\n1,2,3\n")]);
    let by_hand =
        scene("spheres = [{ center = [1, 2, 3], radius = 0.5, material = \"red\" }]", &[]);
    assert_eq!(by_rows.hash(), by_hand.hash());
    let moved = scene(ONE_CSV, &[("a.csv", "x,y,z\n1,2,3.5\n")]);
    assert_ne!(moved.hash(), by_hand.hash());
}

/// Rows that are written by the csv crate, in quotes and without, are what that crate reads.
#[test]
fn tables_of_another_writer_are_read_as_by_another_reader() {
    let mut state = 7_u64;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
        state >> 11
    };
    for style in [QuoteStyle::Necessary, QuoteStyle::Always, QuoteStyle::NonNumeric] {
        let mut writer = WriterBuilder::new().quote_style(style).from_writer(Vec::new());
        writer.write_record(["z", "na\"me", "x", "y"]).expect("memory takes every write");
        for _ in 0..20_000 {
            let [x, y, z] = [0; 3].map(|_| {
                let scale = 10.0_f64.powi(i32::try_from(next() % 29).expect("small") - 14);
                (f64::from_bits(next() | 0x3FF0_0000_0000_0000) - 1.5) * scale
            });
            let name =
                ["", "a,b", "\"", " \"\"x\", ", "é"][usize::try_from(next() % 5).expect("small")];
            let record = [z.to_string(), name.to_owned(), format!("{x:e}"), y.to_string()];
            writer.write_record(record).expect("memory takes every write");
        }
        let text = String::from_utf8(writer.into_inner().expect("memory")).expect("text");
        let differences = |text: &str, other: &str| {
            let scene = scene(ONE_CSV, &[("a.csv", text)]);
            let mut reader = ReaderBuilder::new().from_reader(other.as_bytes());
            let records: Vec<csv::StringRecord> =
                reader.records().collect::<Result<_, _>>().expect("records");
            assert_eq!(scene.spheres().len(), records.len());
            let same = |(sphere, record): &(&Sphere, &csv::StringRecord)| {
                let center = [2, 3, 0].map(|at| record[at].parse::<f64>().expect("a number"));
                sphere.center().to_array().map(f64::to_bits) != center.map(f64::to_bits)
            };
            scene.spheres().iter().zip(&records).filter(same).count()
        };
        assert_eq!(differences(&text, &text), 0);
        // A digit that is read as another is seen.
        let wrong = text.replacen("e-", "e-1", 1);
        assert_eq!(differences(&text, &wrong), 1);
    }
}

/// The first mistakes of a long file and the number of the others, in order, however many cores
/// found them.
#[test]
fn mistakes_are_counted_and_the_first_shown() {
    let mut text = "x,y,z,note\n".to_owned();
    for n in 0..60_000 {
        let z = if n % 2 == 1 { "?" } else { "0" };
        let _ = writeln!(text, "{n},0,{z},something of no use that makes the row long");
    }
    let message = refused(ONE_CSV, &[("a.csv", &text)]);
    let places: Vec<&str> = message.lines().filter(|line| line.contains("--> a.csv:")).collect();
    assert_eq!(places.len(), 20);
    for (n, place) in places.iter().enumerate() {
        assert!(place.contains(&format!("--> a.csv:{}:", 3 + 2 * n)), "{place}");
    }
    assert!(message.ends_with("\n\n... and 29980 more"), "{message}");
}

/// What turns out wrong with a sphere later is shown in its data file.
#[test]
fn complaints_show_the_row() {
    let clouds = "spheres = [{ center = [0, 0, 5], radius = 1, material = \"red\" }]
clouds = [
  { file = \"a.csv\", radius = 0.5, material = \"red\" },
  { file = \"m.xyz\" },
]";
    let csv = "# a comment\r\nx,y,z\r\n0,0,0\r\n\r\n0,0,0\r\n7,0,0\r\n";
    let folder = folder(clouds, &[("a.csv", csv), ("m.xyz", "2\n\nC 1 0 0\nO 2 0 0\n")]);
    let (scene, source) =
        load_with_source(&folder.path().join("scene.toml")).expect("a valid scene");
    let titles: Vec<String> = scene.spheres().iter().map(Sphere::title).collect();
    // The second row is where the first is, and can never be seen.
    let expected = [
        "sphere 1",
        "sphere 2 (a.csv, line 3)",
        "sphere 4 (a.csv, line 6)",
        "sphere 5 (m.xyz, line 3)",
        "sphere 6 (m.xyz, line 4)",
    ];
    assert_eq!(titles, expected);
    let shown = ["scene.toml:5:43", "a.csv:3:1", "a.csv:6:1", "m.xyz:3:1", "m.xyz:4:1"];
    let lines = ["radius = 1", "0,0,0", "7,0,0", "C 1 0 0", "O 2 0 0"];
    for (sphere, (shown, line)) in scene.spheres().iter().zip(shown.into_iter().zip(lines)) {
        let error = source.complain(Some(sphere.ordinal()), "it is wrong", "make it right");
        let message = error.to_string();
        assert!(message.contains(&format!("{shown}\n")), "{message}");
        assert!(message.contains(line), "{message}");
    }
    let message = source.complain(Some(7), "it is wrong", "make it right").to_string();
    assert!(message.contains("scene.toml:1:1"), "there is no sphere 7: {message}");
}

#[test]
fn text_has_no_data_files() {
    let error = parse("a.toml", &format!("{HEAD}{ONE_CSV}")).expect_err("no file is read");
    let message = error.to_string();
    assert!(
        message.starts_with("error: there is no folder in which to look for `a.csv`"),
        "{message}"
    );
}

#[test]
fn more_data_than_is_allowed_is_refused() {
    let two = "clouds = [
  { file = \"a.csv\", radius = 1, material = \"red\" },
  { file = \"b.csv\", radius = 1, material = \"red\" },
]";
    let folder = folder(two, &[("a.csv", "x,y,z\n0,0,0\n"), ("b.csv", "")]);
    let large = fs::OpenOptions::new().write(true).open(folder.path().join("b.csv"));
    let large = large.expect("the file was just written");
    // A file of nothing but a hole takes no room on the disk.
    large.set_len((512 << 20) - 11).expect("a file can be made longer");
    let message = read(&folder).expect_err("one byte too many").to_string();
    assert!(message.starts_with("error: `b.csv` is too large\n"), "{message}");
    assert!(message.contains("the data files of a scene have at most 512 MiB together"));
    let rows = format!("x,y,z\n{}", "\n".repeat(9_999_998));
    let message = refused(two, &[("a.csv", "x,y,z\n0,0,0\n"), ("b.csv", &rows)]);
    assert!(message.starts_with("error: `b.csv` has too many lines, 9999999\n"), "{message}");
    // One line less, and what is wrong is that there are no rows among them.
    let message = refused(two, &[("a.csv", "x,y,z\n0,0,0\n"), ("b.csv", &rows[..rows.len() - 1])]);
    assert!(message.starts_with("error: there are no rows under the header"), "{message}");
}

#[cfg(unix)]
#[test]
fn data_may_come_from_a_pipe() {
    let folder = folder(ONE_CSV, &[]);
    let pipe = folder.path().join("a.csv");
    let made = std::process::Command::new("mkfifo").arg(&pipe).status().expect("mkfifo runs");
    assert!(made.success());
    let writer = std::thread::spawn(move || fs::write(pipe, "x,y,z\n1,2,3\n"));
    assert_eq!(read(&folder).expect("a scene").spheres().len(), 1);
    writer.join().expect("it ends").expect("the pipe takes it");
}

/// The example scenes' data: what the generator writes, and an atom for each of caffeine's.
#[test]
fn the_examples_are_whole() {
    let scenes = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes");
    let data = fs::read_to_string(scenes.join("particles.csv")).expect("the data can be read");
    assert!(data == particles::csv(), "write it anew: cargo run --release --example particles");
    for (name, least) in [("particles", 10_000), ("molecule", 24)] {
        let scene = load(&scenes.join(name).with_extension("toml"));
        let scene = scene.unwrap_or_else(|error| panic!("{error}"));
        assert!(scene.has_lights() && scene.spheres().len() > least, "{name}");
    }
}
