//! `--target-error` and `--log`: where a render stops, what it says, and what it logs.

use crate::candor::Folder;
#[cfg(unix)]
use crate::candor::Running;

const RENDER: &str = "render scene.toml --device cpu --quiet";

#[test]
fn a_target_is_reached_and_stated() {
    let folder = Folder::new();
    let results = folder.candor(&format!("{RENDER} --target-error 20%")).silently_done();
    let last = results.lines().last().expect("a line");
    assert!(last.starts_with("20 % reached: error "), "{last}");
    let bound = last.split_once("at most ").and_then(|(_, rest)| rest.split_once(" % with 99 %"));
    let bound: f64 = bound.expect(last).0.parse().expect(last);
    assert!(bound > 0.0 && bound <= 20.0, "{last}");
    assert_eq!(folder.files(), ["scene.exr", "scene.png"]);
}

/// The bound is in the results and in the film; and the samples do not depend on how fast
/// they were traced.
#[test]
fn a_target_gives_the_same_picture_again() {
    let folder = Folder::new();
    let render = |arguments: &str| {
        let arguments = format!("{RENDER} --json --target-error 0.2 {arguments}");
        folder.candor(&arguments).with_code(0).json()
    };
    let one = render("-o one.exr --threads 1");
    let two = render("-o two.exr --threads 2 --log log.csv");
    for field in ["spp", "relative_error", "error_bound"] {
        assert_eq!(one[field], two[field], "{field}");
    }
    assert_eq!((&one["target_error"], &one["target_reached"]), (&0.2.into(), &true.into()));
    let [error, bound] = ["relative_error", "error_bound"].map(|f| one[f].as_f64().expect(f));
    assert!(error < bound && bound <= 0.2, "{one:?}");
    let film = exr::prelude::read_first_flat_layer_from_file(folder.path("one.exr"));
    let attributes = film.expect("a film").layer_data.attributes.other;
    let stated = attributes.iter().find(|(name, _)| *name == "candor.errorBound");
    assert!(format!("{stated:?}").contains(&bound.to_string()), "{stated:?}");
}

/// Limits that come first: the picture is there all the same, and the last line says what was
/// reached.
#[test]
fn a_target_out_of_reach_fails_with_a_picture() {
    let table =
        [("--spp 20", "done, 0.01 % not reached: error "), ("--time 300ms", "time is up, ")];
    for (limit, part) in table {
        let folder = Folder::new();
        let ended = folder.candor(&format!("{RENDER} --target-error 0.01% {limit}"));
        let ended = ended.with_code(1);
        assert_eq!(ended.stderr, "");
        let last = ended.stdout.lines().last().expect("a line");
        assert!(last.starts_with(part), "{last}");
        for part in ["0.01 % not reached: ", ", 0.01 % takes ", " more, half the error"] {
            assert!(last.contains(part), "no \"{part}\" in: {last}");
        }
        assert_eq!(folder.files(), ["scene.exr", "scene.png"]);
    }
    let folder = Folder::new();
    let json = folder.candor(&format!("{RENDER} --json --target-error 1e-9 --spp 32"));
    let json = json.with_code(1).json();
    assert_eq!((&json["spp"], &json["target_reached"]), (&32.into(), &false.into()));
}

/// Limits that come later change nothing.
#[test]
fn limits_beyond_the_target_are_not_met() {
    let folder = Folder::new();
    let spp = |limits: &str| {
        let arguments = format!("{RENDER} --json --target-error 20% {limits}");
        folder.candor(&arguments).with_code(0).json()["spp"].clone()
    };
    assert_eq!(spp(""), spp("--spp 1000000 --time 1h"));
}

/// Black for want of light is proven; nothing has to be traced for any target.
#[test]
fn a_scene_without_lights_reaches_every_target() {
    let folder = Folder::new();
    folder.write("dark.toml", crate::candor::dark_scene());
    let arguments = "render dark.toml --json --target-error 0.0001% --log log.csv";
    let json = folder.candor(arguments).with_code(0).json();
    assert_eq!((&json["error_bound"], &json["target_reached"]), (&0.0.into(), &true.into()));
    assert_eq!(rows(&folder), ["16,0.000,0,0,0,0"]);
}

/// Black for want of samples is not: a lamp that hardly any sample finds.
#[test]
fn a_picture_that_is_black_so_far_reaches_none() {
    let folder = Folder::new();
    let scene = crate::candor::SCENE.replace("[0.0, 3.0, 0.0]", "[0.0, 3000.0, 4000.0]");
    folder.write("black.toml", &scene);
    let arguments = "render black.toml --device cpu --json --target-error 100% --spp 64";
    let json = folder.candor(arguments).with_code(1).json();
    assert_eq!(json["unproven_pixels"], 48);
    assert_eq!((&json["relative_error"], &json["error_bound"]), (&().into(), &().into()));
}

#[cfg(unix)]
#[test]
fn an_interrupted_render_is_interrupted_and_nothing_else() {
    let folder = Folder::new();
    let arguments = "render scene.toml --device cpu --target-error 0.0001% --size 64x64";
    let mut running = Running::start(&mut folder.command(arguments));
    running.wait_for(" spp, ");
    let kill = format!("kill -INT {}", running.id());
    assert!(std::process::Command::new("sh").args(["-c", &kill]).status().expect("sh").success());
    let ended = running.end().with_code(130);
    assert!(ended.stdout.contains("interrupted, 0.0001 % not reached: "), "{}", ended.stdout);
    assert!(ended.stderr.lines().any(|line| line.contains(" to 0.0001 %")), "{}", ended.stderr);
}

/// The rows of `log.csv`.
fn rows(folder: &Folder) -> Vec<String> {
    let log = String::from_utf8(folder.read("log.csv")).expect("a text");
    let mut lines = log.lines().map(str::to_owned);
    let header = "samples,seconds,relative_error,error_bound,luminance,unproven_pixels";
    assert_eq!(lines.next().as_deref(), Some(header));
    lines.collect()
}

#[test]
fn a_log_has_a_row_at_each_power_of_two_and_at_the_end() {
    let folder = Folder::new();
    let arguments = format!("{RENDER} --json --spp 5000 --log log.csv");
    let json = folder.candor(&arguments).with_code(0).json();
    let rows = rows(&folder);
    let rows: Vec<Vec<&str>> = rows.iter().map(|row| row.split(',').collect()).collect();
    let samples: Vec<u64> = rows.iter().map(|row| row[0].parse().expect("a count")).collect();
    assert!(samples.is_sorted_by(|a, b| a < b), "{samples:?}");
    for count in (0..13).map(|k| 1 << k).chain([5000]) {
        assert!(samples.contains(&count), "{count} in {samples:?}");
    }
    assert_eq!(rows[0][2..4], ["", ""], "one sample says nothing about its error");
    assert_eq!((rows[1][3], rows[2][3], rows[3][3]), ("", "", ""), "no bound before 16");
    let last = rows.last().expect("rows");
    assert_eq!(last[2], json["relative_error"].to_string());
    assert_eq!(last[3], json["error_bound"].to_string());
    let seconds: Vec<f64> = rows.iter().map(|row| row[1].parse().expect("seconds")).collect();
    assert!(seconds.is_sorted(), "{seconds:?}");
}

/// A file that is no log is not lost to a mistake in typing; an older log makes way.
#[test]
fn only_a_log_is_replaced_by_a_log() {
    let folder = Folder::new();
    let refused = |log: &str, parts: &[&str]| {
        // So many samples that the test would hang if they were traced first.
        let arguments = format!("{RENDER} --spp 4294967296 --log {log}");
        folder.candor(&arguments).refused(parts);
    };
    refused("scene.toml", &["scene.toml: is no error log of candor"]);
    assert_eq!(folder.read("scene.toml"), crate::candor::SCENE.as_bytes());
    refused("missing/log.csv", &["the folder missing does not exist"]);
    refused(".", &["is a folder"]);
    refused("scene.exr", &["scene.exr: named both as output and as log"]);
    assert_eq!(folder.files(), [""; 0]);
    folder.write("log.csv", "");
    for spp in [64, 2] {
        folder.candor(&format!("{RENDER} --force --spp {spp} --log log.csv")).silently_done();
        let last = rows(&folder).pop().expect("rows");
        assert!(last.starts_with(&format!("{spp},")), "{last}");
    }
}

/// A disk that is full costs the log, not the picture; and it is said.
#[cfg(target_os = "linux")]
#[test]
fn a_log_that_fails_costs_no_picture() {
    let folder = Folder::new();
    let mut shell = std::process::Command::new("sh");
    // Files may have 512 bytes: enough for the header and a few rows.
    let render =
        folder.command(&format!("{RENDER} --spp 1000000000 --time 2s --no-state --log log.csv"));
    shell.args(["-c", "ulimit -f 1; exec \"$@\"", "sh"]).arg(render.get_program());
    shell.args(render.get_args()).args(["-o", "a.png"]).current_dir(folder.path(""));
    let ended = Running::start(&mut shell).end().with_code(2);
    assert!(ended.stdout.contains("wrote a.png"), "{}", ended.stdout);
    assert!(ended.stderr.starts_with("error: log.csv: cannot be written: "), "{}", ended.stderr);
    assert_eq!(folder.files(), ["a.png", "log.csv"]);
}
