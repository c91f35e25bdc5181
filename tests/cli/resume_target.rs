//! `--resume` with `--target-error` and `--log`: the looks go on as planned, and so does the log.

use crate::candor::Folder;
use crate::film::{assert_same, attributes};

const RENDER: &str = "render scene.toml --device cpu --quiet";

/// Wherever a limit cut a render to a target short, at a look or between two, who goes on ends
/// with the samples of a render that nothing interrupted.
#[test]
fn a_target_is_reached_with_the_same_samples() {
    let folder = Folder::new();
    let target = "--target-error 3%";
    folder.candor(&format!("{RENDER} {target} -o whole.exr")).silently_done();
    let spp: u64 = attributes(&folder.path("whole.exr"))["candor.spp"].parse().expect("a count");
    assert!(spp > 128, "{spp} samples have too few looks in them");
    for limit in [1, 7, 15, 16, 17, 31, 32, 33, 100, 128, spp - 1] {
        let name = format!("{limit}.exr");
        let arguments = format!("{RENDER} {target} -o {name}");
        let limited = folder.candor(&format!("{arguments} --spp {limit}"));
        assert!(matches!(limited.code, Some(0 | 1)), "{limited:?}");
        folder.candor(&format!("{arguments} --resume")).silently_done();
        assert_same(&folder, &name, "whole.exr");
    }
}

/// The same in several pieces, each with a limit of its own.
#[test]
fn a_target_is_reached_in_pieces() {
    let folder = Folder::new();
    let target = "--target-error 3%";
    folder.candor(&format!("{RENDER} {target} -o whole.exr")).silently_done();
    for limit in [3, 16, 40, 41, 90] {
        let arguments = format!("{RENDER} {target} -o a.exr --resume --spp {limit}");
        folder.candor(&arguments).with_code(1);
    }
    folder.candor(&format!("{RENDER} {target} -o a.exr --resume")).silently_done();
    assert_same(&folder, "a.exr", "whole.exr");
    // It is reached, and stays so.
    folder.candor(&format!("{RENDER} {target} -o a.exr --resume")).silently_done();
    assert_same(&folder, "a.exr", "whole.exr");
}

/// The count at which a render that goes on ends was chosen when the picture was known: a bound is
/// stated there only if it is one of those that are fixed beforehand.
#[test]
fn a_film_that_was_gone_on_from_is_bounded_at_fixed_counts() {
    let folder = Folder::new();
    let bound = |arguments: &str| {
        let arguments = format!("{RENDER} --json -o a.exr --target-error 0.1% {arguments}");
        let json = folder.candor(&arguments).with_code(1).json();
        json["error_bound"].is_number()
    };
    assert!(bound("--spp 37"));
    assert!(!bound("--spp 65 --resume"));
    assert!(bound("--spp 68 --resume"));
    let line = format!("{RENDER} -o a.exr --target-error 0.1% --spp 69 --resume");
    let said = folder.candor(&line).with_code(1).stdout;
    assert!(said.contains("known at certain counts only, such as 72 spp"), "{said}");
}

/// The film of a target that was reached is that of as many samples, and a lower target goes on.
#[test]
fn a_lower_target_goes_on() {
    let folder = Folder::new();
    let render = |arguments: &str| {
        let arguments = format!("{RENDER} --json -o a.exr --target-error {arguments}");
        folder.candor(&arguments).with_code(0).json()
    };
    let spp = |json: &serde_json::Map<_, serde_json::Value>| json["spp"].as_u64().expect("a count");
    let coarse = render("20%");
    let fine = render("5% --resume");
    assert!(spp(&fine) > spp(&coarse));
    assert_eq!((&fine["target_reached"], &fine["target_error"]), (&true.into(), &0.05.into()));
    folder.candor(&format!("{RENDER} -o whole.exr --spp {}", spp(&fine))).silently_done();
    assert_same(&folder, "a.exr", "whole.exr");
    // A higher one is reached by what is there, at the first look that is possible.
    let again = render("20% --resume --spp 4294967295");
    assert!(spp(&again) - spp(&fine) <= spp(&fine) / 16, "{again:?}");
}

/// The rows of `log.csv`, without the header.
fn rows(folder: &Folder) -> Vec<String> {
    let log = String::from_utf8(folder.read("log.csv")).expect("a text");
    log.lines().skip(1).map(str::to_owned).collect()
}

fn counts(folder: &Folder) -> Vec<u64> {
    let rows = rows(folder);
    let count = |row: &String| row.split(',').next().expect("a column").parse().expect("a count");
    rows.iter().map(count).collect()
}

#[test]
fn a_log_goes_on() {
    let folder = Folder::new();
    let render = |arguments: &str| {
        folder.candor(&format!("{RENDER} --log log.csv {arguments}")).silently_done();
    };
    render("--spp 8");
    let before = rows(&folder);
    render("--spp 33 --resume");
    assert_eq!(counts(&folder), [1, 2, 4, 8, 16, 32, 33]);
    assert_eq!(rows(&folder)[..4], before);
    let seconds = |row: &String| row.split(',').nth(1).expect("a column").parse().expect("seconds");
    let seconds: Vec<f64> = rows(&folder).iter().map(seconds).collect();
    assert!(seconds.is_sorted(), "{seconds:?}");
    // Nothing more was traced, and nothing is logged twice.
    render("--spp 33 --resume");
    assert_eq!(counts(&folder), [1, 2, 4, 8, 16, 32, 33]);
    // Without --resume it starts anew.
    render("--spp 33");
    assert_eq!(counts(&folder), [1, 2, 4, 8, 16, 32, 33]);
}

/// A render that was killed has logged samples that are in no film, and half a row: they are
/// traced and logged again. What the film holds and the log does not is added.
#[test]
fn a_log_has_the_rows_of_the_film() {
    let header = "samples,seconds,relative_error,error_bound,luminance,unproven_pixels\n";
    for (log, logged) in [
        ("1,0.001,,,1,0\n2,0.002,0.5,,1,0\n4,0.003,0.4,,1,0\n8,0.004,0.3,,1,0\n", vec![1, 2, 4, 6]),
        ("1,0.001,,,1,0\n2,0.002,0.5,,1,0\n4,0.00", vec![1, 2, 6]),
        ("", vec![6]),
    ] {
        let folder = Folder::new();
        folder.candor(&format!("{RENDER} --spp 6")).silently_done();
        folder.write("log.csv", &format!("{header}{log}"));
        let arguments = format!("{RENDER} --log log.csv --resume");
        folder.candor(&format!("{arguments} --spp 6")).silently_done();
        assert_eq!(counts(&folder), logged);
        folder.candor(&format!("{arguments} --spp 8")).silently_done();
        assert_eq!(counts(&folder), [logged, vec![8]].concat());
    }
}
