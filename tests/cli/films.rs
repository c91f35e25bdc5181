//! Which files a render writes, and which it leaves alone.

use crate::candor::Folder;
#[cfg(unix)]
use crate::candor::Running;

#[test]
fn outputs_are_named_after_the_scene_in_the_current_folder() {
    let folder = Folder::new();
    std::fs::create_dir(folder.path("scenes")).expect("a folder can be made");
    std::fs::copy(folder.path("scene.toml"), folder.path("scenes/box.1.toml")).expect("copied");
    folder.candor("render scenes/box.1.toml --device cpu --quiet").silently_done();
    assert_eq!(folder.files(), ["box.1.exr", "box.1.png", "scenes"]);
}

#[test]
fn every_output_is_written_and_nothing_else() {
    let folder = Folder::new();
    let arguments = "render scene.toml --device cpu --quiet -o a.exr --output b.PNG -o c.EXR";
    let results = folder.candor(arguments).silently_done();
    assert!(results.starts_with("wrote a.exr\nwrote c.EXR\nwrote b.PNG\ndone: "), "{results}");
    // No temporary file is left either.
    assert_eq!(folder.files(), ["a.exr", "b.PNG", "c.EXR"]);
}

/// Whatever is wrong with an output is said before the work, and the other one is not
/// written.
#[test]
fn impossible_outputs_are_refused_before_work() {
    let table = [
        ("picture.jpg", "it must be .exr or .png"),
        ("picture", "it must be .exr or .png"),
        (".exr", "it must be .exr or .png"),
        ("missing/picture.png", "the folder missing does not exist"),
        ("folder.exr", "is a folder"),
        ("scene.toml/picture.png", "the folder scene.toml does not exist"),
        ("good.exr", "named twice"),
    ];
    let folder = Folder::new();
    std::fs::create_dir(folder.path("folder.exr")).expect("a folder can be made");
    for (output, part) in table {
        // So many samples that the test would hang if they were traced first.
        let arguments = format!("render scene.toml --spp 4294967296 -o good.exr -o {output}");
        folder.candor(&arguments).refused(&[output, part]);
        assert_eq!(folder.files(), ["folder.exr"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_folder_without_write_permission_is_refused_before_work() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    let locked = folder.path("locked");
    std::fs::create_dir(&locked).expect("a folder can be made");
    std::fs::set_permissions(&locked, PermissionsExt::from_mode(0o555)).expect("it is ours");
    // Permissions do not bind root, but no one makes files in /proc.
    let bound = std::fs::write(locked.join("probe"), "").is_err();
    let output = if bound { locked.join("a.exr") } else { "/proc/a.exr".into() };
    let arguments = format!("render scene.toml --spp 4294967296 -o {}", output.display());
    folder.candor(&arguments).refused(&["a.exr: cannot be written: "]);
}

#[test]
fn a_film_with_more_samples_is_replaced_only_by_force() {
    let folder = Folder::new();
    let render = "render scene.toml --device cpu --quiet -o a.exr --spp";
    folder.candor(&format!("{render} 8")).silently_done();
    let eight = folder.read("a.exr");
    folder.candor(&format!("{render} 3")).refused(&[
        "a.exr",
        "8 samples",
        "more than 3",
        "--resume goes on from it",
        "--force",
    ]);
    assert_eq!(folder.read("a.exr"), eight);
    folder.candor(&format!("{render} 8")).silently_done();
    folder.candor(&format!("{render} 3 --force")).silently_done();
    assert!(folder.read("a.exr") != eight);
    folder.candor(&format!("{render} 4")).silently_done();
}

/// A render that stops early does not lose the better film: it goes beside it.
#[test]
fn a_short_render_goes_beside_a_better_film() {
    let folder = Folder::new();
    let render = "render scene.toml --device cpu --quiet -o a.exr -o a.png";
    folder.candor(&format!("{render} --spp 50")).silently_done();
    let better = [folder.read("a.exr"), folder.read("a.png")];
    let results = folder.candor(&format!("{render} --size 512x512 --time 1ms")).silently_done();
    assert!(results.starts_with("wrote a.1.exr\nwrote a.1.png\ntime is up: "), "{results}");
    assert_eq!([folder.read("a.exr"), folder.read("a.png")], better);
    assert_eq!(folder.files(), ["a.1.exr", "a.1.png", "a.exr", "a.png"]);
}

/// An EXR that candor did not write may be somebody's reference: it is replaced with `--force`
/// alone. A PNG is made anew from its film.
#[test]
fn other_programs_films_are_replaced_with_force_alone() {
    let folder = Folder::new();
    folder.write("scene.exr", "not of candor");
    folder.write("scene.png", "not a picture");
    let render = "render scene.toml --device cpu --quiet";
    folder.candor(render).refused(&["scene.exr: was not written by candor", "--force"]);
    assert_eq!(folder.read("scene.exr"), b"not of candor");
    assert_eq!(folder.read("scene.png"), b"not a picture");
    folder.candor(&format!("{render} --force")).silently_done();
    assert!(folder.read("scene.exr").starts_with(&[0x76, 0x2f, 0x31, 0x01]));
    assert!(folder.read("scene.png").starts_with(b"\x89PNG"));
}

/// The disk fills up in the middle of writing: the old film stays, whole, and no
/// temporary file is left.
#[cfg(unix)]
#[test]
fn a_film_survives_a_failed_write() {
    let folder = Folder::new();
    folder.candor("render scene.toml --device cpu --quiet -o a.exr").silently_done();
    let old = folder.read("a.exr");
    let render = folder.command("render scene.toml --device cpu --quiet -o a.exr --size 64x64");
    let mut shell = std::process::Command::new("sh");
    shell.args(["-c", "ulimit -f 1; exec \"$@\"", "sh"]);
    shell.arg(render.get_program()).args(render.get_args()).current_dir(folder.path(""));
    Running::start(&mut shell).end().refused(&["a.exr: cannot be written: "]);
    assert_eq!(folder.read("a.exr"), old);
    assert_eq!(folder.files(), ["a.exr"]);
}

#[cfg(unix)]
#[test]
fn pictures_are_readable_by_others() {
    use std::os::unix::fs::PermissionsExt;
    let folder = Folder::new();
    folder.candor("render scene.toml --device cpu --quiet").silently_done();
    for name in folder.files() {
        let metadata = std::fs::metadata(folder.path(&name)).expect("it is there");
        assert_eq!(metadata.permissions().mode() & 0o777, 0o644, "{name}");
    }
}
