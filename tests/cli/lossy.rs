//! A Vulkan driver that loses its device, under the real program: the same film, or what was
//! whole before and exit code 2.

use crate::candor::{Ended, Folder, Running};
use exr::prelude::{FlatSamples, ReadChannels, ReadLayers, read};
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::OnceLock;

/// Where the loader finds software Vulkan: what the environment says, or where it always looks.
fn manifest() -> PathBuf {
    if let Ok(files) = std::env::var("VK_DRIVER_FILES") {
        return files.split(':').next().expect("a list has a first part").into();
    }
    let folder = std::fs::read_dir("/usr/share/vulkan/icd.d").expect("Vulkan drivers are there");
    let mut files = folder.map(|file| file.expect("it can be listed").path());
    let is_lavapipe = |path: &PathBuf| path.to_string_lossy().contains("/lvp_");
    files.find(is_lavapipe).expect("software Vulkan (Mesa's lavapipe) is there")
}

/// Compiles the driver once; its manifest, and the library of the driver that it hands on to.
fn lossy() -> &'static (PathBuf, String) {
    static LOSSY: OnceLock<(PathBuf, String)> = OnceLock::new();
    LOSSY.get_or_init(|| {
        let folder = Path::new(env!("CARGO_TARGET_TMPDIR"));
        let library = folder.join("liblossy_driver.so");
        let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/support/lossy_driver.c");
        let mut compile = Command::new("cc");
        compile.args(["-shared", "-fPIC", "-o"]).arg(&library).arg(source).arg("-ldl");
        assert!(compile.status().expect("there is a C compiler").success(), "{compile:?}");
        let text = std::fs::read(manifest()).expect("the manifest can be read");
        let mut json: serde_json::Value = serde_json::from_slice(&text).expect("it is JSON");
        let path = &mut json["ICD"]["library_path"];
        let real = path.as_str().expect("a library").to_owned();
        *path = library.to_str().expect("a path in UTF-8").into();
        let file = folder.join("lossy_driver.json");
        std::fs::write(&file, json.to_string()).expect("it can be written");
        (file, real)
    })
}

/// Renders a film with a log, which looks at every power of two. The calls of a function from
/// one on find the device lost, so many times.
fn render(folder: &Folder, arguments: &str, call: &str, first: u32, times: u32) -> Ended {
    Running::start(&mut command(folder, arguments, call, first, times)).end()
}

fn command(folder: &Folder, arguments: &str, call: &str, first: u32, times: u32) -> Command {
    let (manifest, real) = lossy();
    let render = "render scene.toml --device gpu --log log.csv --force -o";
    let mut command = folder.command(&format!("{render} {arguments}"));
    command.env("VK_DRIVER_FILES", manifest).env("VK_ICD_FILENAMES", manifest);
    command.env_remove("VK_ADD_DRIVER_FILES").env("LOSSY_DRIVER", real).env("LOSSY_CALL", call);
    command.env("LOSSY_FIRST", first.to_string()).env("LOSSY_TIMES", times.to_string());
    command
}

/// Names and values of a film's channels.
fn channels(folder: &Folder, name: &str) -> Vec<(String, FlatSamples)> {
    let reader = read().no_deep_data().largest_resolution_level().all_channels();
    let reader = reader.first_valid_layer().all_attributes();
    let image = reader.from_file(folder.path(name)).expect("a film");
    let channels = image.layer_data.channel_data.list.into_iter();
    channels.map(|channel| (channel.name.to_string(), channel.sample_data)).collect()
}

const SUBMIT: &str = "vkQueueSubmit";
const WAIT: &str = "vkWaitSemaphores";

#[test]
fn a_lost_device_changes_no_bit() {
    let folder = Folder::new();
    let whole = "a.exr --spp 64";
    // 0 is no call's number: nothing is lost.
    let ended = render(&folder, whole, SUBMIT, 0, 0).with_code(0);
    assert!(!ended.stderr.contains("lost"), "{}", ended.stderr);
    let expected = channels(&folder, "a.exr");
    let (mut from_start, mut from_whole) = (0, 0);
    for call in [SUBMIT, WAIT] {
        for (first, times) in [(1, 1), (2, 3), (3, 1), (6, 1), (9, 2), (14, 1)] {
            let ended = render(&folder, "b.exr --spp 64", call, first, times).with_code(0);
            let said = &ended.stderr;
            let losses = said.matches("the device was lost (its driver reports: ").count();
            assert_eq!(losses, times as usize, "{said}");
            assert!(!said.contains("error: "), "{said}");
            from_start += said.matches("open again: going on from the start,").count();
            from_whole += said.matches(" samples per pixel, with smaller dispatches").count();
            assert!(channels(&folder, "b.exr") == expected, "{call} {first} {times}: {said}");
        }
    }
    assert!(from_start > 0 && from_whole > 0, "{from_start} {from_whole}");
    // The judge sees a sample that is missing.
    render(&folder, "c.exr --samples 1..64", SUBMIT, 0, 0).with_code(0);
    assert!(channels(&folder, "c.exr") != expected);
}

/// There is one error, and what was whole is written.
#[test]
fn a_device_that_is_lost_for_ever_leaves_what_was_whole() {
    for call in [SUBMIT, WAIT] {
        let folder = Folder::new();
        // A round takes a submission and a look three more: some looks are over.
        let ended = render(&folder, "a.exr --spp 65536", call, 20, u32::MAX).with_code(2);
        let said = &ended.stderr;
        assert_eq!(said.matches("error: ").count(), 1, "{said}");
        assert!(said.contains("error: the device was lost: 6 times without a step for"), "{said}");
        assert!(!said.contains("mistake in candor"), "{said}");
        assert!(ended.stdout.starts_with("wrote a.exr\nfailed: error "), "{}", ended.stdout);
        let samples =
            ended.stdout.split(" spp, ").next().and_then(|text| text.split(' ').next_back());
        let samples: u32 = samples.and_then(|count| count.parse().ok()).expect("a count");
        assert!((1..65536).contains(&samples), "{samples}");
        render(&folder, &format!("b.exr --spp {samples}"), SUBMIT, 0, 0).with_code(0);
        assert!(channels(&folder, "a.exr") == channels(&folder, "b.exr"), "{said}");
    }
}

/// A device that never works: one error, and no film of nothing.
#[test]
fn a_device_that_never_works_writes_nothing() {
    for call in [SUBMIT, WAIT] {
        let folder = Folder::new();
        let ended = render(&folder, "a.exr --quiet", call, 1, u32::MAX);
        ended.refused(&["the device was lost: 6 times without a step forward"]);
        assert_eq!(folder.files(), ["log.csv"]);
    }
}

/// A device that is gone is not replaced by another one, which makes other bits; what was whole
/// is written.
#[test]
fn a_device_that_is_gone_leaves_what_was_whole() {
    let folder = Folder::new();
    let mut command = command(&folder, "a.exr --spp 65536 --quiet", SUBMIT, 20, 1);
    let ended = Running::start(command.env("LOSSY_GONE", "1")).end().with_code(2);
    let (start, end) =
        ("error: the device was lost and does not open again: ", ") is not there any more\n");
    assert!(ended.stderr.starts_with(start) && ended.stderr.ends_with(end), "{}", ended.stderr);
    assert_eq!(ended.stderr.lines().count(), 1, "{}", ended.stderr);
    assert!(ended.stdout.starts_with("wrote a.exr\nfailed: error "), "{}", ended.stdout);
}
