//! `candor cost`: what it writes, prints and refuses. Nothing here depends on how fast the
//! machine is.

use crate::candor::{Folder, Running, dark_scene};
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
