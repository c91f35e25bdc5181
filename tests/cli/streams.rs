//! Results on stdout, everything else on stderr, and readers that leave early.

use crate::candor::{Folder, Running};
use serde_json::Value;
use std::process::Stdio;

#[test]
fn results_and_messages_are_apart() {
    let folder = Folder::new();
    let ended = folder.candor("render scene.toml --device cpu").with_code(0);
    let results: Vec<&str> = ended.stdout.lines().collect();
    assert_eq!(results[..2], ["wrote scene.exr", "wrote scene.png"]);
    assert!(results[2].starts_with("done: error "), "{results:?}");
    for part in [" spp, ", " s on CPU twin", " invalid samples", " unproven pixels", "half the"] {
        assert!(results[2].contains(part), "no \"{part}\" in: {}", results[2]);
    }
    assert_eq!(results.len(), 3);
    // Where it renders and what it takes, said before the start; then progress.
    let messages: Vec<&str> = ended.stderr.lines().collect();
    assert!(messages[0].starts_with("8x6 pixels on CPU twin"), "{messages:?}");
    assert!(messages[0].ends_with(" kB of memory"), "{messages:?}");
    // The first round compiles the kernel and tells no rate, so the first line is a later one.
    assert!(messages[1].contains(" spp, "), "{messages:?}");
    assert!(messages[1].ends_with(" left"), "{messages:?}");
}

/// No colours, bars or carriage returns where nobody watches.
#[test]
fn streams_are_plain_text() {
    let ended = Folder::new().candor("render scene.toml --device cpu");
    let both = ended.stdout + &ended.stderr;
    assert!(both.chars().all(|c| c == '\n' || !c.is_control()), "{both:?}");
}

#[test]
fn quiet_silences_stderr() {
    let folder = Folder::new();
    let results = folder.candor("render scene.toml --device cpu --quiet").silently_done();
    assert_eq!(results.lines().count(), 3);
    folder.candor("render missing.toml --quiet").refused(&["missing.toml"]);
}

#[test]
fn json_is_one_object_with_the_documented_fields() {
    let folder = Folder::new();
    let ended = folder.candor("render scene.toml --device cpu --json -o a.exr -o b.png --spp 9");
    let json = ended.with_code(0).json();
    assert!(json["device"].as_str().is_some_and(|name| name.starts_with("CPU twin")));
    assert!(json["driver"].as_str().is_some_and(|name| name.starts_with("candor ")));
    assert_eq!((&json["width"], &json["height"]), (&Value::from(8), &Value::from(6)));
    assert_eq!(json["spp"], 9);
    assert_eq!(json["invalid_samples"], 0);
    assert_eq!(json["outputs"], serde_json::json!(["a.exr", "b.png"]));
    for name in ["seconds", "samples_per_second", "relative_error"] {
        assert!(json[name].as_f64().is_some_and(|x| x > 0.0), "{name}: {}", json[name]);
    }
}

/// One sample says nothing about its own error.
#[test]
fn an_unknown_error_is_null() {
    let folder = Folder::new();
    let json = folder.candor("render scene.toml --device cpu --json --spp 1").with_code(0).json();
    assert_eq!(json["relative_error"], Value::Null);
}

/// `candor … | head -0` and `candor … 2>&1 | head -0`: the render is done all the same.
#[test]
fn a_reader_that_leaves_stops_nothing() {
    for arguments in ["render scene.toml --device cpu", "render scene.toml --device cpu --json"] {
        let folder = Folder::new();
        let mut command = folder.command(arguments);
        let mut child =
            command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
        drop((child.stdout.take(), child.stderr.take()));
        assert_eq!(child.wait().expect("it is our child").code(), Some(0), "{arguments}");
        assert_eq!(folder.files(), ["scene.exr", "scene.png"]);
    }
    let folder = Folder::new();
    let mut devices = folder.command("devices");
    let mut child = devices.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().expect("runs");
    drop(child.stdout.take());
    let ended = child.wait_with_output().expect("it is our child");
    assert_eq!((ended.status.code(), ended.stderr.as_slice()), (Some(0), [].as_slice()));
}

/// A result that cannot be handed over is a failure; a lost message is none.
#[cfg(target_os = "linux")]
#[test]
fn a_full_disk_behind_a_stream() {
    let full = || std::fs::OpenOptions::new().write(true).open("/dev/full").expect("it is there");
    let folder = Folder::new();
    let render = "render scene.toml --device cpu";
    let ended = folder.command(render).arg("--quiet").stdout(full()).output().expect("runs");
    assert_eq!(ended.status.code(), Some(2));
    let message = String::from_utf8(ended.stderr).expect("messages are UTF-8");
    assert!(message.starts_with("error: cannot write to stdout: "), "{message}");
    let ended = folder.command(render).stderr(full()).output().expect("runs");
    assert_eq!(ended.status.code(), Some(0));
}

/// The layers around a Vulkan driver complain about a machine without a display.
#[test]
fn drivers_add_nothing_to_stderr() {
    let folder = Folder::new();
    for (name, value) in [("XDG_RUNTIME_DIR", "/nonexistent"), ("DISPLAY", ":99")] {
        for arguments in ["render scene.toml --device gpu --quiet", "devices"] {
            let mut command = folder.command(arguments);
            command.env_remove("XDG_RUNTIME_DIR").env_remove("DISPLAY");
            Running::start(&mut command).end().silently_done();
            Running::start(command.env(name, value)).end().silently_done();
        }
    }
}
