//! `candor explain`: a scene's kernel, what is in it and what is not.

use crate::candor::{Folder, Running, dark_scene, without_vulkan};
use candor::kernel::validate;
use std::process::Command;

const SPHERES: [&str; 2] = ["floor", "lamp"];

fn output(command: &mut Command) -> Vec<u8> {
    let output = command.output().expect("runs");
    assert_eq!(output.status.code(), Some(0), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(output.stderr.is_empty());
    output.stdout
}

#[test]
fn effects_are_explained_in_80_columns() {
    let folder = Folder::new();
    let text = folder.candor("explain scene.toml --device cpu").silently_done();
    let widest = text.lines().map(|line| line.chars().count()).max();
    assert!(widest <= Some(80), "{widest:?} in: {text}");
    for part in [
        "diffuse surfaces        paths scatter at floor",
        "glossy surfaces         no glossy sphere",
        "search for a hit        written out: 2 spheres",
        "not timed: the CPU twin has no kernel",
    ] {
        assert!(text.contains(part), "no \"{part}\" in: {text}");
    }
    assert!(!text.contains("time per sample"), "{text}");
    assert_eq!(folder.files(), [""; 0]);
}

/// Both kernels run on the device and make the same bits; times are there, whatever they are.
#[test]
fn both_kernels_are_measured_on_a_device() {
    let folder = Folder::new();
    let json = folder.candor("explain scene.toml --estimator mis --json").with_code(0).json();
    assert_eq!((&json["estimator"], &json["bounces"]), (&"mis".into(), &2.into()));
    let measured = &json["measured"];
    assert_eq!(measured["films"], "same_bits");
    assert_eq!(measured["invalid_samples"], serde_json::json!([0, 0]));
    assert!(
        ["none", "saves", "costs"].contains(&measured["saving"]["verdict"].as_str().unwrap_or(""))
    );
    for pair in ["compile_seconds", "seconds_per_sample"] {
        for which in 0..2 {
            let [low, value, high] =
                ["low", "value", "high"].map(|end| measured[pair][which][end].as_f64());
            assert!(low.is_some() && low <= value && value <= high, "{measured}");
        }
    }
    assert!(json["device"].is_string() && json["not_measured"].is_null());
    let effects = json["effects"].as_array().expect("a list");
    let sampling = effects.iter().find(|effect| effect["effect"] == "light sampling");
    assert_eq!(sampling.expect("it is there")["named"], serde_json::json!(SPHERES[1..]));
    for kernel in ["specialised", "general"] {
        assert!(json[kernel]["spirv_bytes"].as_u64() > Some(1000), "{}", json[kernel]);
    }
}

#[test]
fn kernels_are_printed_alone() {
    let folder = Folder::new();
    let wgsl = output(&mut folder.command("explain scene.toml --wgsl"));
    let wgsl = String::from_utf8(wgsl).expect("text");
    validate(&wgsl).expect("a valid kernel");
    let spirv = output(&mut folder.command("explain scene.toml --spirv"));
    assert_eq!(spirv[..4], 0x0723_0203_u32.to_ne_bytes());
    assert_eq!(spirv.len() % 4, 0);
    let words = candor::kernel::spirv(&wgsl).expect("SPIR-V");
    assert_eq!(spirv.len(), 4 * words.len());
}

#[test]
fn what_is_not_run_is_said() {
    let folder = Folder::new();
    folder.write("dark.toml", dark_scene());
    let text = folder.candor("explain dark.toml").silently_done();
    assert!(text.contains("the scene has no lights"), "{text}");
}

#[cfg(target_os = "linux")]
#[test]
fn without_a_device_nothing_is_timed() {
    let folder = Folder::new();
    let mut command = folder.command("explain scene.toml");
    let text = Running::start(without_vulkan(&mut command)).end().silently_done();
    assert!(text.ends_with("no Vulkan, Metal or DX12 device opens here\n"), "{text}");
    for kernel in ["--wgsl", "--spirv"] {
        output(without_vulkan(&mut folder.command("explain scene.toml")).arg(kernel));
    }
}

#[test]
fn impossible_requests_are_refused() {
    let folder = Folder::new();
    for (arguments, part) in [
        ("--estimator auto", "--estimator auto is for render"),
        ("--wgsl --spirv", "cannot be used with"),
        ("--wgsl --json", "cannot be used with"),
        ("--bounces 65", "--bounces takes"),
        ("--device nonesuch", "no device named \"nonesuch\""),
    ] {
        folder.candor(&format!("explain scene.toml {arguments}")).refused(&[part]);
    }
    folder.candor("explain missing.toml").refused(&["missing.toml"]);
}
