//! Input made to exhaust time or memory: refused at once, with what is allowed.

use crate::candor::Folder;
use std::fs::File;

/// A sparse file, which takes no room on the disk.
fn huge(folder: &Folder, name: &str) {
    let file = File::create(folder.path(name)).expect("a file can be made");
    file.set_len(1 << 30).expect("a file can be made longer");
}

#[test]
fn pictures_larger_than_any_memory_are_refused() {
    let folder = Folder::new();
    for device in ["cpu", "gpu"] {
        let render = format!("render scene.toml --device {device} --size");
        folder.candor(&format!("{render} 1000000x1000000")).with_code(2);
        folder.candor(&format!("{render} 65535x65535")).refused(&["65535x65535 pixels need"]);
    }
    assert!(folder.files().is_empty());
}

#[test]
fn huge_files_are_not_read() {
    let folder = Folder::new();
    huge(&folder, "huge.toml");
    huge(&folder, "huge.exr");
    folder.candor("render huge.toml").refused(&["is too large", "at most 16 MiB"]);
    folder.candor("diff huge.exr huge.exr").refused(&["huge.exr: is not a readable EXR"]);
}

#[cfg(unix)]
#[test]
fn what_is_no_file_is_refused() {
    let folder = Folder::new();
    folder.candor("render .").refused(&["cannot read .:"]);
    folder.candor("render /dev/zero").refused(&["is too large"]);
    folder.candor("render /dev/null").refused(&["has no `[camera]`"]);
    folder.candor("diff /dev/zero /dev/zero").refused(&["is not a readable EXR"]);
}

#[test]
fn deep_nesting_and_long_lines_are_refused() {
    let folder = Folder::new();
    let long = 1 << 20;
    let table = [
        (format!("a = {}", "[".repeat(long)), "nested too deeply"),
        (format!("a = {}", "{ a = ".repeat(long / 6)), "nested too deeply"),
        (format!("a{} = 1", ".a".repeat(long / 2)), "has too many parts"),
        (format!("a = \"{}", "x".repeat(long)), "closing quote"),
    ];
    for (text, reason) in table {
        folder.write("bad.toml", &text);
        let ended = folder.candor("render bad.toml");
        assert!(ended.stderr.len() < 2000, "{} bytes", ended.stderr.len());
        ended.refused(&[reason]);
    }
}

#[test]
fn more_bounces_than_a_device_takes_are_refused() {
    let folder = Folder::new();
    let scene = std::fs::read_to_string(folder.path("scene.toml")).expect("it was written");
    let more = |i| format!("[[spheres]]\ncenter = [{i}, 9, 9]\nradius = 0.3\nemission = [1, 1, 1]");
    let more: Vec<String> = (0..2000).map(more).collect();
    folder.write("many.toml", &format!("{scene}{}", more.join("\n")));
    let paths = "--spp 1 --estimator mis --bounces 64";
    let parts = ["64 bounces among 2002 spheres", "it takes fewer than", "--device cpu"];
    folder.candor(&format!("render many.toml --device gpu {paths}")).refused(&parts);
    folder.candor("render many.toml --device gpu --spp 1 --quiet -o gpu.png").with_code(0);
    folder.candor("render many.toml --device cpu --spp 1 --quiet -o many.png").with_code(0);
}
