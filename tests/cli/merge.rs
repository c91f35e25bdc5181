//! `merge`: films of the same picture, each of other samples, are one film.

use crate::candor::{Folder, SCENE};
#[cfg(target_os = "linux")]
use crate::candor::{Running, limited};
use crate::film::{assert_same, attributes, patch};

const RENDER: &str = "render scene.toml --device cpu --quiet";

/// A folder with films of these samples, each named after them.
fn parts(ranges: &[&str]) -> Folder {
    let folder = Folder::new();
    for range in ranges {
        folder.candor(&format!("{RENDER} --samples {range} -o {range}.exr")).silently_done();
    }
    folder
}

#[test]
fn parts_in_any_order_and_nested_are_the_single_run() {
    let folder = parts(&["0..3", "3..7", "7..8", "8..36"]);
    let arguments = format!("{RENDER} --json -o whole.exr --spp 36");
    let whole = folder.candor(&arguments).with_code(0).json();
    let merge = |films: &str, output: &str| {
        let ended = folder.candor(&format!("merge --json {films} -o {output}")).with_code(0);
        assert_eq!(ended.stderr, "");
        ended.json()
    };
    for (number, films) in [
        "0..3.exr 3..7.exr 7..8.exr 8..36.exr",
        "8..36.exr 7..8.exr 3..7.exr 0..3.exr",
        "7..8.exr 0..3.exr 8..36.exr 3..7.exr",
    ]
    .iter()
    .enumerate()
    {
        let name = format!("{number}.exr");
        let merged = merge(films, &name);
        assert_same(&folder, &name, "whole.exr");
        for field in ["spp", "samples", "relative_error", "error_bound", "unproven_pixels"] {
            assert_eq!(merged[field], whole[field], "{field}");
        }
        assert_eq!((&merged["missing"], &merged["outputs"]), (&().into(), &[name].into()));
    }
    folder.candor("merge --quiet 8..36.exr 0..3.exr -o ends.exr").silently_done();
    folder.candor("merge --quiet 7..8.exr 3..7.exr -o middle.exr").silently_done();
    merge("middle.exr ends.exr", "nested.exr");
    assert_same(&folder, "nested.exr", "whole.exr");
    // One film alone is that film.
    merge("nested.exr", "alone.exr");
    assert_same(&folder, "alone.exr", "whole.exr");
}

/// What is merged may have been chosen by what it shows: but for the first samples at one of the
/// fixed counts, nothing is said of how large the error is at most.
#[test]
fn chosen_samples_have_no_bound() {
    let folder = parts(&["0..32", "32..33", "33..64", "64..96"]);
    let has_bound = |films: &str| {
        let merge = format!("merge --quiet --json --force {films} -o sum.exr");
        folder.candor(&merge).with_code(0).json()["error_bound"].is_number()
    };
    assert!(has_bound("0..32.exr"));
    assert!(!has_bound("0..32.exr 32..33.exr"));
    assert!(has_bound("0..32.exr 32..33.exr 33..64.exr"));
    assert!(!has_bound("0..32.exr 64..96.exr"));
    assert!(!has_bound("64..96.exr"));
}

#[test]
fn gaps_are_said() {
    let folder = parts(&["2..3", "5..9"]);
    let merge = "merge 5..9.exr 2..3.exr";
    let ended = folder.candor(&format!("{merge} -o a.exr --json")).with_code(0);
    assert_eq!(ended.stderr, "warning: samples 0..2,3..5 are in none of the films\n");
    let json = ended.json();
    assert_eq!((&json["missing"], &json["samples"]), (&"0..2,3..5".into(), &"2..3,5..9".into()));
    assert_eq!(json["spp"], 5);
    folder.candor(&format!("{merge} -o b.exr --quiet")).silently_done();
}

/// Whatever is refused, nothing is written.
#[test]
fn samples_are_counted_once() {
    let folder = parts(&["0..3", "2..5", "7..9"]);
    folder.candor("merge --quiet 0..3.exr 7..9.exr -o sum.exr").silently_done();
    let files = folder.files();
    for (films, shared, other) in [
        ("0..3.exr 2..5.exr", "2..5.exr: samples 2..3 are in ", "0..3.exr too"),
        ("2..5.exr 7..9.exr 0..3.exr", "0..3.exr: samples 2..3 are in ", "2..5.exr too"),
        ("7..9.exr 7..9.exr", "7..9.exr: samples 7..9 are in ", "7..9.exr too"),
        ("sum.exr 7..9.exr", "7..9.exr: samples 7..9 are in ", "sum.exr too"),
    ] {
        let ended = folder.candor(&format!("merge {films} -o new.exr"));
        ended.refused(&[shared, other, "would count twice"]);
        assert_eq!(folder.files(), files, "{films}");
    }
}

#[test]
fn other_pictures_are_refused_by_field_and_both_values() {
    let folder = parts(&["0..3"]);
    folder.write("other.toml", &SCENE.replace("radius = 1.5", "radius = 1.5001"));
    folder.candor("render other.toml --device cpu --quiet --samples 3..5").silently_done();
    let refused = |parts: &[&str]| {
        let first = "other.exr: cannot be added to 0..3.exr: the ";
        folder.candor("merge 0..3.exr other.exr -o new.exr").refused(&[&[first], parts].concat());
        assert!(!folder.path("new.exr").exists());
    };
    refused(&["scene differs: ", "… in 0..3.exr, ", "… in other.exr"]);
    for (arguments, difference) in [
        ("--seed 5", "seed differs: 0 in 0..3.exr, 5 in other.exr"),
        ("--bounces 1", "bounces differs: 2 in 0..3.exr, 1 in other.exr"),
        ("--estimator mis", "estimator differs: implicit in 0..3.exr, mis in other.exr"),
        ("--size 9x6", "size differs: 8x6 in 0..3.exr, 9x6 in other.exr"),
    ] {
        let render = format!("{RENDER} --force -o other.exr --samples 3..5 {arguments}");
        folder.candor(&render).silently_done();
        refused(&[difference]);
    }
}

#[test]
fn what_is_no_film_is_refused() {
    let folder = parts(&["0..3"]);
    folder.write("text.exr", "a text");
    folder.candor(&format!("{RENDER} --no-state -o flat.exr")).silently_done();
    std::fs::copy(folder.path("0..3.exr"), folder.path("torn.exr")).expect("copied");
    patch(&folder.path("torn.exr"), "samples", "0..3", "3..6");
    let whole = folder.read("torn.exr");
    std::fs::write(folder.path("torn.exr"), &whole[..whole.len() - 9]).expect("written");
    let files = folder.files();
    for (film, part) in [
        ("text.exr", "text.exr: is not a readable EXR: "),
        ("flat.exr", "flat.exr: holds no exact sums"),
        ("torn.exr", "torn.exr: is torn: "),
        ("gone.exr", "gone.exr: "),
        (".", ".: is a folder"),
    ] {
        folder.candor(&format!("merge 0..3.exr {film} -o new.exr")).refused(&[part]);
        assert_eq!(folder.files(), files);
    }
    folder.candor("merge 0..3.exr -o new.jpg").refused(&["it must be .exr or .png"]);
    folder.candor("merge -o new.exr").refused(&["<FILM>"]);
    folder.candor("merge 0..3.exr").refused(&["--output"]);
}

/// The sum may take the place of a part of it, and of nothing else that would be lost.
#[test]
fn a_film_is_replaced_by_what_holds_it() {
    let folder = parts(&["0..3", "3..5", "5..9"]);
    folder.candor(&format!("{RENDER} -o whole.exr --spp 5")).silently_done();
    let [more, whole] = ["5..9.exr", "whole.exr"].map(|name| folder.read(name));
    let merge = "merge --quiet 0..3.exr 3..5.exr -o";
    folder.candor(&format!("{merge} 5..9.exr")).refused(&["samples 5..9 of the same picture"]);
    assert_eq!(folder.read("5..9.exr"), more);
    folder.candor(&format!("{merge} whole.exr -o 0..3.exr")).silently_done();
    assert_same(&folder, "0..3.exr", "whole.exr");
    assert!(folder.read("whole.exr") != whole);
    folder.candor("merge --quiet 3..5.exr -o 5..9.exr --force").silently_done();
    assert_same(&folder, "5..9.exr", "3..5.exr");
}

/// Time is what was paid for on all machines together.
#[test]
fn times_and_invalid_samples_add_up() {
    let folder = parts(&["0..20", "20..40", "40..60"]);
    let mut spent = 0.0;
    for (name, invalid) in [("0..20.exr", "2"), ("20..40.exr", "0"), ("40..60.exr", "5")] {
        patch(&folder.path(name), "invalidSamples", "0", invalid);
        let seconds = attributes(&folder.path(name))["candor.seconds"].clone();
        spent += seconds.parse::<f64>().expect("a number");
    }
    let merge = "merge --quiet --json 40..60.exr 0..20.exr 20..40.exr -o sum.exr";
    let json = folder.candor(merge).with_code(0).json();
    let header = attributes(&folder.path("sum.exr"));
    assert_eq!(
        (header["candor.invalidSamples"].as_str(), &json["invalid_samples"]),
        ("7", &7.into())
    );
    let seconds: f64 = header["candor.seconds"].parse().expect("a number");
    // Three decimals are written.
    assert!((seconds - spent).abs() < 0.0006, "{seconds} of {spent}");
    // No bound holds over samples that are wrong.
    assert_eq!(json["error_bound"], serde_json::Value::Null);
}

/// A sum of parts from two tracers names both, and says what that means.
#[test]
fn parts_of_several_devices_are_said() {
    let folder = parts(&["0..3"]);
    folder.candor("render scene.toml --device gpu --quiet --samples 3..5 -o b.exr").silently_done();
    let ended = folder.candor("merge 0..3.exr b.exr -o sum.exr").with_code(0);
    assert!(ended.stderr.starts_with("warning: 0..3.exr was made on "), "{}", ended.stderr);
    let device = |name: &str| attributes(&folder.path(name))["candor.device"].clone();
    assert_eq!(device("sum.exr"), format!("{}; {}", device("0..3.exr"), device("b.exr")));
}

/// Twelve films of 1024x1024, of 52 MiB each. Under a limit on the process's own memory that holds
/// three of them beside the program, which takes 6 MiB with two threads, all are added; under one
/// that holds a single film they are not, so that the limit is seen to bind.
#[cfg(target_os = "linux")]
#[test]
fn three_films_are_in_memory_at_most() {
    const KIB_OF_FILM: usize = 1024 * candor::film::WORDS * 4;
    const KIB_OF_PROGRAM: usize = 16 * 1024;
    let folder = Folder::new();
    let render = format!("{RENDER} --size 1024x1024 --samples 10..11 -o 10.exr");
    folder.candor(&render).silently_done();
    for first in 11..22 {
        let path = folder.path(&format!("{first}.exr"));
        std::fs::copy(folder.path("10.exr"), &path).expect("copied");
        patch(&path, "samples", "10..11", &format!("{first}..{}", first + 1));
    }
    let films: Vec<String> = (10..22).map(|first| format!("{first}.exr")).collect();
    let merge = folder.command(&format!("merge --quiet {} -o sum.exr", films.join(" ")));
    let with_films = |count: usize| {
        let kib = KIB_OF_PROGRAM + count * KIB_OF_FILM;
        let mut command = limited(&format!("ulimit -c 0; ulimit -d {kib}"), &merge);
        // Each thread takes its stack out of the limit.
        Running::start(command.env("RAYON_NUM_THREADS", "2")).end()
    };
    with_films(3).silently_done();
    assert_eq!(attributes(&folder.path("sum.exr"))["candor.samples"], "10..22");
    assert!(with_films(1).code != Some(0));
}
