//! What renders, and what cannot.

use crate::candor::{Folder, SCENE, dark_scene};
#[cfg(target_os = "linux")]
use crate::candor::{Running, without_vulkan};

#[test]
fn devices_lists_what_is_here() {
    let list = Folder::new().candor("devices").silently_done();
    assert!(list.contains("\ncpu\n    the f64 reference"), "{list}");
    let takes = list.lines().last().expect("it has lines");
    let name = takes.strip_prefix("--device auto takes: ").expect("the last line");
    assert_eq!(list.lines().next(), Some(name));
    assert_ne!(name, "cpu", "a device beside the twin is needed for the tests");
}

#[test]
fn a_device_is_found_by_a_part_of_its_name() {
    let folder = Folder::new();
    let list = folder.candor("devices").silently_done();
    let name = list.lines().next().expect("it has lines");
    let word = name.split_whitespace().next().expect("a name has words").to_uppercase();
    let json = folder.candor(&format!("render scene.toml --json --device {word}")).json();
    assert_eq!(json["device"], name);
}

#[test]
fn an_unknown_device_lists_those_that_are_here() {
    let folder = Folder::new();
    let list = folder.candor("devices").silently_done();
    let name = list.lines().next().expect("it has lines");
    let ended = folder.candor("render scene.toml --device Voodoo2");
    ended.refused(&["no device named \"Voodoo2\"", name, "--device cpu"]);
}

#[cfg(target_os = "linux")]
#[test]
fn the_twin_takes_over_where_there_is_no_vulkan() {
    let folder = Folder::new();
    for device in ["auto", "cpu"] {
        let arguments = format!("render scene.toml --json --device {device}");
        let ended = Running::start(without_vulkan(&mut folder.command(&arguments))).end();
        let ended = ended.with_code(0);
        let name = ended.json()["device"].as_str().unwrap_or_default().to_owned();
        assert!(name.starts_with("CPU twin"), "{name}");
        let taken_over = ended.stderr.contains("the CPU twin takes over");
        assert_eq!(taken_over, device == "auto", "{}", ended.stderr);
    }
    let list = Running::start(without_vulkan(&mut folder.command("devices"))).end();
    assert!(list.silently_done().ends_with("--device auto takes: cpu\n"));
}

#[cfg(target_os = "linux")]
#[test]
fn what_needs_a_device_is_refused_without_vulkan() {
    let table = [
        ("render scene.toml --device gpu", "use --device cpu"),
        ("render scene.toml --device llvmpipe", "there is only --device cpu here"),
        ("verify scene.toml", "install a graphics driver"),
    ];
    let folder = Folder::new();
    for (arguments, part) in table {
        Running::start(without_vulkan(&mut folder.command(arguments))).end().refused(&[part]);
        assert_eq!(folder.files(), [""; 0]);
    }
}

/// 597 GB; a machine that has them would have to try.
#[test]
fn a_picture_that_does_not_fit_is_refused_at_once() {
    let folder = Folder::new();
    for device in ["gpu", "cpu"] {
        let arguments = format!("render scene.toml --size 65535x65535 --device {device}");
        let parts = ["65535x65535 pixels need ", " GB of memory, ", "B are available", "--size"];
        folder.candor(&arguments).refused(&parts);
        assert_eq!(folder.files(), [""; 0]);
    }
}

#[test]
fn many_spheres_render_on_every_device() {
    let folder = Folder::new();
    let sphere = |i| {
        format!("\n[[spheres]]\ncenter = [0.0, -{i}.0, 0.0]\nradius = 1.0\nmaterial = \"grey\"\n")
    };
    let many: String = (100..100 + 600 - 2).map(sphere).collect();
    folder.write("many.toml", &(SCENE.to_owned() + &many));
    for device in ["gpu", "cpu"] {
        folder.candor(&format!("render many.toml --device {device} --quiet")).silently_done();
    }
}

#[test]
fn verify_finds_that_this_device_agrees() {
    let folder = Folder::new();
    let report = folder.candor("verify scene.toml --size 16x16 --spp 256 --quiet").silently_done();
    assert!(report.ends_with("verdict   the device agrees with the twin\n"), "{report}");
    let ended = folder.candor("verify scene.toml --size 16x16 --spp 256 --json").with_code(0);
    let json = ended.json();
    assert_eq!((&json["agrees"], &json["conclusive"]), (&true.into(), &true.into()));
    assert_eq!(folder.files(), [""; 0], "verify writes no files");
}

/// Without light in either film there is no evidence, though the films are the same.
#[test]
fn verify_with_too_few_hits_is_a_failed_check() {
    let folder = Folder::new();
    for arguments in ["--size 1x1 --spp 2", "--size 8x8 --spp 2"] {
        let ended = folder.candor(&format!("verify scene.toml {arguments}")).with_code(1);
        assert!(ended.stdout.contains("too few hits to tell; use more --spp"), "{ended:?}");
    }
}

#[test]
fn verify_refuses_a_scene_without_lights() {
    let folder = Folder::new();
    folder.write("dark.toml", dark_scene());
    folder.candor("verify dark.toml").refused(&["the scene has no lights"]);
}
