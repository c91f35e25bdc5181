//! Renders that are cut short: by `--time`, Ctrl-C or SIGTERM.

use crate::candor::{Folder, Running};
use std::process::Command;
use std::thread::sleep;
use std::time::Duration;

/// Sends a signal, with the `kill` that every shell has built in.
pub fn signal(running: &Running, name: &str) {
    let kill = format!("kill -{name} {}", running.id());
    assert!(Command::new("sh").args(["-c", &kill]).status().expect("sh runs").success(), "{kill}");
}

#[test]
fn a_signal_writes_what_is_there() {
    for (device, name) in [("gpu", "INT"), ("cpu", "INT"), ("cpu", "TERM")] {
        let folder = Folder::new();
        let arguments = format!("render scene.toml --spp 4294967296 --json --device {device}");
        let mut running = Running::start(&mut folder.command(&arguments));
        running.wait_for(" spp, ");
        signal(&running, name);
        let ended = running.end().with_code(130);
        let json = ended.json();
        assert!(json["spp"].as_u64().is_some_and(|spp| (1..4_294_967_296).contains(&spp)));
        assert_eq!(json["outputs"], serde_json::json!(["scene.exr", "scene.png"]));
        assert_eq!(folder.files(), ["scene.exr", "scene.png"]);
    }
}

/// A supervisor may send a signal to the process and one to its group: within a second
/// they are one request, and the picture is written.
#[test]
fn two_signals_at_once_are_one() {
    let folder = Folder::new();
    let arguments = "render scene.toml --spp 4294967296 --json --device cpu --size 512x512";
    let mut running = Running::start(&mut folder.command(arguments));
    running.wait_for(" spp, ");
    signal(&running, "TERM");
    sleep(Duration::from_millis(5));
    signal(&running, "TERM");
    running.end().with_code(130);
    assert_eq!(folder.files(), ["scene.exr", "scene.png"]);
}

/// A closed room with many bounces: the first sample of every pixel alone, which the
/// first signal waits for, takes long enough for a second one.
#[test]
fn a_second_signal_stops_at_once() {
    let folder = Folder::new();
    folder.write(
        "room.toml",
        "[camera]\nposition = [0.5, 0.0, 0.0]\nlook_at = [0.0, 0.0, 0.0]\nvertical_fov = 90.0\n\
         [image]\nwidth = 2048\nheight = 1024\n[render]\nbounces = 64\n\
         [materials.white]\ndiffuse = [0.7, 0.7, 0.7]\n\
         [[spheres]]\ncenter = [0.0, 0.0, 0.0]\nradius = 1.0\nmaterial = \"white\"\n\
         [[spheres]]\ncenter = [0.9, 0.0, 0.0]\nradius = 0.001\nemission = [1.0, 1.0, 1.0]\n",
    );
    let arguments = "render room.toml --device cpu --threads 1";
    let mut running = Running::start(&mut folder.command(arguments));
    running.wait_for(" of memory");
    signal(&running, "INT");
    // What comes within a second is taken for the same request.
    sleep(Duration::from_millis(1200));
    signal(&running, "INT");
    let ended = running.end().with_code(130);
    assert_eq!(ended.stdout, "");
    assert_eq!(folder.files(), ["room.toml"]);
}

#[test]
fn time_stops_a_render_as_asked() {
    let folder = Folder::new();
    for device in ["gpu", "cpu"] {
        let arguments = format!("render scene.toml --time 50ms --quiet --force --device {device}");
        let results = folder.candor(&arguments).silently_done();
        assert!(results.contains("\ntime is up: "), "{results}");
    }
}

/// Samples that are done before the time is up end the render.
#[test]
fn time_is_a_limit_beside_the_samples() {
    let folder = Folder::new();
    let arguments = "render scene.toml --time 1h --spp 4 --json --device cpu";
    assert_eq!(folder.candor(arguments).with_code(0).json()["spp"], 4);
}
