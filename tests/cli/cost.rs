//! `candor cost`: what it writes, prints and refuses. Nothing here depends on how fast the
//! machine is.

use crate::candor::{Folder, Running, SCENE, dark_scene};
use serde_json::Value;
use std::collections::BTreeSet;

const FILES: [&str; 4] = ["cost.csv", "cost.html", "cost.png", "cost.svg"];

const ESTIMATORS: [&str; 4] = ["implicit", "cosine", "explicit", "mis"];

fn text(folder: &Folder, name: &str) -> String {
    String::from_utf8(folder.read(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
}

/// An interval that holds its value; both are positive.
#[track_caller]
fn check_interval(measured: &Value) {
    let [low, value, high] = ["low", "value", "high"].map(|end| measured[end].as_f64());
    assert!(low > Some(0.0) && low <= value && value <= high, "{measured}");
}

/// One study, from every side: JSON, files, and that a second one replaces them.
#[test]
fn a_study_on_a_device() {
    let folder = Folder::new();
    let ended = folder.candor("cost scene.toml --budget 5s --json --device gpu").with_code(0);
    for phase in ["estimators in turns", "bounce ladder", "device against f64", "picture strip"] {
        assert!(ended.stderr.contains(phase), "{}", ended.stderr);
    }
    let json = ended.json();
    assert_eq!(
        (&json["width"], &json["height"], &json["bounces"]),
        (&8.into(), &6.into(), &2.into())
    );
    assert_eq!(
        json["outputs"],
        serde_json::json!(["cost.csv", "cost.html", "cost.svg", "cost.png"])
    );
    assert_eq!(json["interrupted"], false);
    check_estimators(&json["estimators"]);
    let rungs = json["ladder"].as_array().expect("a ladder");
    let bounces: Vec<_> = rungs.iter().map(|rung| rung["bounces"].as_u64()).collect();
    assert_eq!(bounces, [0, 1, 2, 3, 4, 8].map(Some));
    for rung in rungs {
        check_interval(&rung["seconds_per_sample"]);
    }
    assert!(rungs[..5].iter().all(|rung| rung["missing"]["value"].is_number()), "{rungs:?}");
    check_interval(&json["twin"]["slowdown"]);
    // The device's f32 and f64 differ by rounding alone.
    for bias in json["twin"]["bias"].as_array().expect("three channels") {
        assert!(bias.as_f64().is_some_and(|bias| bias.abs() < 1e-3), "{bias}");
    }
    let pictures = json["strips"][0]["pictures"].as_array().expect("pictures");
    assert_eq!(pictures.len(), 6, "48 pixels 1024 times take no time");

    assert_eq!(folder.files(), FILES);
    check_csv(&text(&folder, "cost.csv"));
    check_html(&text(&folder, "cost.html"));
    assert!(text(&folder, "cost.svg").contains("relative RMS error"));
    assert_eq!(folder.read("cost.png")[..8], *b"\x89PNG\r\n\x1a\n");

    let results = folder.candor("cost scene.toml --budget 5s --quiet --device cpu").silently_done();
    for part in ["Which estimator?", "time to (measured)", "the f64 twin itself is the device"] {
        assert!(results.contains(part), "no \"{part}\" in: {results}");
    }
    assert_eq!(folder.files(), FILES);
}

fn check_estimators(estimators: &Value) {
    let estimators = estimators.as_array().expect("estimators");
    let names: Vec<_> = estimators.iter().map(|cost| cost["estimator"].as_str()).collect();
    assert_eq!(names, ESTIMATORS.map(Some));
    for cost in estimators {
        check_interval(&cost["seconds_per_sample"]);
        check_interval(&cost["noise"]["variance"]);
        check_interval(&cost["noise"]["efficiency"]);
        assert_eq!(cost["unproven_pixels"].as_u64().map(|pixels| pixels <= 48), Some(true));
        let predictions = cost["predictions"].as_array().expect("predictions");
        let targets: Vec<_> = predictions.iter().map(|p| p["target"].as_f64()).collect();
        assert_eq!(targets, [0.1, 0.03, 0.01, 0.003, 0.001].map(Some));
        for prediction in predictions {
            check_interval(&prediction["seconds"]);
        }
    }
}

fn check_csv(table: &str) {
    let mut reader = csv::Reader::from_reader(table.as_bytes());
    let columns = reader.headers().expect("a header").clone();
    assert_eq!(columns, vec!["part", "subject", "at", "quantity", "unit", "value", "low", "high"]);
    let mut parts = BTreeSet::new();
    for row in reader.records() {
        let row = row.expect("as many cells as columns");
        parts.insert(row[0].to_owned());
        let is_text = &row[0] == "left_out" || &row[0] == "study";
        assert!(is_text || row[5].parse::<f64>().is_ok_and(f64::is_finite), "{row:?}");
    }
    for part in ["study", "estimator", "convergence", "prediction", "ladder", "twin", "strip"] {
        assert!(parts.contains(part), "{parts:?}");
    }
}

/// Nothing is fetched: no address but the name of the SVG namespace, no script.
fn check_html(page: &str) {
    let addresses: Vec<_> = page.match_indices("http").map(|(at, _)| &page[at..at + 26]).collect();
    assert_eq!(addresses, ["http://www.w3.org/2000/svg"]);
    for part in ["<script", "<link", "@import", "url(", "src=\"/"] {
        assert!(!page.contains(part), "{part}");
    }
    for part in ["<svg", "data:image/png;base64,", "prefers-color-scheme: dark", "explicit", "10 %"]
    {
        assert!(page.contains(part), "no \"{part}\"");
    }
}

/// A lamp of a ten-thousandth of the distance, behind the camera: only estimators that aim at
/// it know their error. What is not known is not a number.
#[test]
fn what_met_no_light_is_unproven() {
    let folder = Folder::new();
    folder.write(
        "dim.toml",
        &dark_scene().replace(
            "[materials",
            "[[spheres]]\ncenter = [0.0, 9.0, 9.0]\nradius = 0.001\n\
         emission = [1e6, 1e6, 1e6]\n\n[materials",
        ),
    );
    let ended = folder.candor("cost dim.toml --budget 5s --json --device cpu").with_code(0);
    let json = ended.json();
    for cost in json["estimators"].as_array().expect("estimators") {
        let blind = ["implicit", "cosine"].contains(&cost["estimator"].as_str().unwrap_or(""));
        assert_eq!(cost["noise"].is_null(), blind, "{cost}");
        assert_eq!(cost["predictions"] == serde_json::json!([]), blind, "{cost}");
    }
    assert!(["explicit", "mis"].contains(&json["used"].as_str().unwrap_or("")), "{json:?}");
    assert!(text(&folder, "cost.html").contains("unproven"));
}

/// The camera stands in a closed grey sphere, the lamp outside: no sample finds light, and
/// nothing is called good, or zero, or the measure of something.
#[test]
fn a_picture_without_light_proves_nothing() {
    let folder = Folder::new();
    let wall = "[[spheres]]\ncenter = [0.0, 1.0, 5.0]\nradius = 0.5\nmaterial = \"grey\"\n\n";
    let lamp = "[[spheres]]\nname = \"lamp\"";
    folder.write("closed.toml", &SCENE.replace(lamp, &format!("{wall}{lamp}")));
    let ended = folder.candor("cost closed.toml --budget 5s --json --device gpu").with_code(0);
    let json = ended.json();
    for rung in json["ladder"].as_array().expect("a ladder") {
        assert!(rung["missing"].is_null() && rung["seconds_to_one_percent"].is_null(), "{rung}");
    }
    let twin = &json["twin"];
    assert!(twin["slowdown"]["value"].is_number(), "{twin}");
    assert!(twin["bias"].is_null() && twin["bias_error"].is_null(), "{twin}");
    let page = text(&folder, "cost.html");
    assert!(page.contains("Unproven: in ") && !page.contains("the measure"), "{page}");
    assert!(!page.contains("<dd>Yes"), "{page}");
    for absent in ["missing_light", "bias_", "seconds_to_one_percent", "NaN"] {
        assert!(!text(&folder, "cost.csv").contains(absent), "{absent}");
    }
}

/// The camera stands in the lamp: all samples are alike, which is no noise and not no number.
#[test]
fn a_picture_without_noise_needs_no_predictions() {
    let folder = Folder::new();
    let around = "center = [0.0, 1.0, 5.0]\nradius = 0.5";
    folder.write("inside.toml", &SCENE.replace("center = [0.0, 3.0, 0.0]\nradius = 1.5", around));
    let arguments = "cost inside.toml --budget 5s --quiet --device cpu";
    let results = folder.candor(arguments).silently_done();
    let found = |part: &str| results.matches(part).count();
    assert_eq!(found("NaN"), 0, "{results}");
    // Four estimators, each with its efficiency and five targets.
    assert_eq!(found("no noise  ") + found("no noise\n"), 4 * 6, "{results}");
    assert!(found(" none ") >= 4 && found(" 0 s") == 0, "{results}");
    let table = text(&folder, "cost.csv");
    assert!(!table.contains("NaN") && !table.contains("prediction"), "{table}");
    assert!(!text(&folder, "cost.html").contains("± NaN"));
    assert!(text(&folder, "cost.svg").contains("no noise"));
}

/// Bright walls and many bounces are more than the film resolves of some estimators; the
/// others go on, and their reason is given.
#[test]
fn estimators_that_the_film_refuses_are_left_out() {
    let folder = Folder::new();
    folder.write("bright.toml", &SCENE.replace("[0.5, 0.5, 0.5]\n\n", "[0.95, 0.95, 0.95]\n\n"));
    let arguments = "cost bright.toml --bounces 64 --budget 5s --device cpu --json";
    let json = folder.candor(arguments).with_code(0).json();
    let costs = json["estimators"].as_array().expect("estimators");
    let names: Vec<_> = costs.iter().filter_map(|cost| cost["estimator"].as_str()).collect();
    assert!(!names.contains(&"implicit") && names.contains(&"mis"), "{names:?}");
    let used = json["used"].as_str().expect("a name");
    assert!(names.contains(&used), "{used}");
    let left_out = json["left_out"].as_array().expect("a list");
    let implicit = left_out.iter().find(|left_out| left_out["what"] == "estimator implicit");
    let why = implicit.and_then(|left_out| left_out["why"].as_str()).expect("implicit");
    assert!(why.contains("takes at most"), "{why}");
    for strip in json["strips"].as_array().expect("strips") {
        assert_ne!(strip["estimator"], "implicit");
    }
}

/// The folder is gone when the files are to be written: what was measured is still said.
#[test]
fn results_outlive_files_that_cannot_be_written() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("out")).expect("a folder can be made");
    let arguments = "cost scene.toml --budget 5s --device cpu -o out";
    let mut running = Running::start(&mut folder.command(arguments));
    running.wait_for("\nbounce ladder\n");
    std::fs::remove_dir(folder.path("out")).expect("an empty folder can be removed");
    let ended = running.end().with_code(2);
    assert!(ended.stdout.contains("Which estimator?"), "{}", ended.stdout);
    assert!(!ended.stdout.contains("wrote"), "{}", ended.stdout);
    assert!(ended.stderr.contains("error: "), "{}", ended.stderr);
}

#[test]
fn mistakes_are_refused_before_work() {
    let folder = Folder::new();
    folder.write("dark.toml", dark_scene());
    folder.write("cost.svg", "a drawing of somebody's");
    let table = [
        ("cost", "<SCENE>"),
        ("cost scene.toml --budget 4s", "at least 5s"),
        ("cost scene.toml --budget soon", "such as 30s"),
        ("cost scene.toml --spp 4", "unexpected argument '--spp'"),
        ("cost scene.toml --estimator mis", "unexpected argument '--estimator'"),
        ("cost dark.toml", "no lights"),
        ("cost scene.toml -o nowhere", "not a folder that exists"),
        ("cost scene.toml", "not a report of candor's"),
        ("cost scene.toml -o scene.toml", "not a folder that exists"),
    ];
    for (arguments, part) in table {
        folder.candor(arguments).refused(&[part]);
        assert_eq!(folder.files(), ["cost.svg", "dark.toml"], "{arguments}");
    }
}

/// Four estimators times five samples of two million pixels in 1.25 s are 33 million samples
/// a second, which one thread is far from.
#[test]
fn a_budget_that_is_too_short_is_refused() {
    let folder = Folder::new();
    let arguments = "cost scene.toml --budget 5s --device cpu --threads 1 --size 2048x1024 --quiet";
    folder.candor(arguments).refused(&["the budget is too short", "it takes at least"]);
    assert_eq!(folder.files(), [""; 0]);
}

/// Interrupted in the pilot, there is nothing to report; later, what is there is reported.
#[cfg(unix)]
#[test]
fn an_interrupted_study_reports_what_is_complete() {
    for (phase, files) in [("estimators in turns", &[][..]), ("bounce ladder", &FILES[..])] {
        let folder = Folder::new();
        let arguments = "cost scene.toml --budget 6s --device cpu";
        let mut running = Running::start(&mut folder.command(arguments));
        running.wait_for(&format!("\n{phase}\n"));
        crate::signals::signal(&running, "INT");
        running.end().with_code(130);
        assert_eq!(folder.files(), files, "{phase}");
    }
}
