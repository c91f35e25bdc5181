//! What is typed: help, mistakes in arguments, mistakes in scene files.

use crate::candor::{Folder, Running};
use std::fs;
use std::path::Path;

#[test]
fn help_and_version_go_to_stdout() {
    let folder = Folder::new();
    for arguments in
        ["--help", "-h", "help", "render --help", "verify -h", "diff --help", "devices --help"]
    {
        assert!(folder.candor(arguments).silently_done().contains("Usage: candor"), "{arguments}");
    }
    let version = concat!("candor ", env!("CARGO_PKG_VERSION"), "\n");
    assert_eq!(folder.candor("--version").silently_done(), version);
}

#[test]
fn help_names_the_exit_codes() {
    let help = Folder::new().candor("--help").silently_done();
    assert!(
        help.contains("Exit codes: 0 done; 1 a check failed or a target was not reached; 2"),
        "{help}"
    );
}

#[test]
fn no_arguments_show_the_usage() {
    let ended = Folder::new().candor("").with_code(2);
    assert_eq!(ended.stdout, "");
    assert!(ended.stderr.contains("Usage: candor"), "{}", ended.stderr);
}

/// Each mistake is refused before anything is rendered, and the message says what is
/// allowed.
#[test]
fn mistakes_in_arguments_are_refused() {
    let table = [
        ("paint scene.toml", "unrecognized subcommand"),
        ("render", "<SCENE>"),
        ("render scene.toml --frobnicate", "unexpected argument"),
        ("render scene.toml --size 640", "such as 640x480"),
        ("render scene.toml --size 0x5", "from 1 to 65535"),
        ("render scene.toml --spp 0", "1..="),
        ("render scene.toml --spp 4294967297", "1..=4294967296"),
        ("render scene.toml --spp 1.5", "invalid digit"),
        ("render scene.toml --seed=-1", "0..=4294967295"),
        ("render scene.toml --seed 4294967296", "0..=4294967295"),
        ("render scene.toml --bounces 65", "from 0 to 64"),
        ("render scene.toml --estimator magic", "expected \"implicit\", \"cosine\""),
        ("render scene.toml --samples 7..5", "the range is empty"),
        ("render scene.toml --samples 5", "such as 0..256"),
        ("render scene.toml --samples 0..4294967297", "at most 4294967296 samples"),
        ("render scene.toml --samples 0..99999999999999999", "below 2^56"),
        ("render scene.toml --samples 0..4 --spp 4", "cannot be used with"),
        ("render scene.toml --time 30", "such as 30s"),
        ("render scene.toml --time 0s", "longer than zero"),
        ("render scene.toml --target-error 5", "a percentage such as 1%, or a fraction"),
        ("render scene.toml --target-error 0%", "above 0 and up to 1"),
        ("render scene.toml --target-error nan", "such as 0.01"),
        ("render scene.toml --target-error 1% --samples 0..4", "cannot be used with"),
        ("render scene.toml --exposure nan", "from -100 to 100"),
        ("render scene.toml --threads 0", "from 1 to 1024"),
        ("render scene.toml --threads 100000", "from 1 to 1024"),
        ("verify scene.toml --spp 1", "at least 2 samples"),
        ("verify scene.toml --device cpu", "--device cpu is the twin itself"),
    ];
    let folder = Folder::new();
    for (arguments, part) in table {
        folder.candor(arguments).refused(&[part]);
        assert_eq!(folder.files(), [""; 0], "{arguments}");
    }
}

#[test]
fn a_missing_scene_is_named() {
    Folder::new().candor("render no/such.toml").refused(&["cannot read no/such.toml: "]);
}

#[test]
fn a_folder_is_not_a_scene() {
    Folder::new().candor("render .").refused(&["cannot read .: "]);
}

/// Every file of `scenes/bad` ends with exactly the message beside it.
#[test]
fn bad_scenes_are_refused_with_their_message() {
    let bad = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/bad");
    let folder = Folder::new();
    let mut seen = 0;
    for entry in fs::read_dir(&bad).expect("scenes/bad can be listed") {
        let name = entry.expect("scenes/bad can be listed").file_name();
        let Some(stem) = name.to_str().and_then(|name| name.strip_suffix(".toml")) else {
            continue;
        };
        let expected = fs::read_to_string(bad.join(format!("{stem}.txt")));
        let expected = expected.unwrap_or_else(|error| panic!("{stem}.txt: {error}"));
        let mut command = folder.command(&format!("render {stem}.toml --json -o"));
        // The message names the file as it was typed.
        command.arg(folder.path("out.exr")).current_dir(&bad);
        let ended = Running::start(&mut command).end().with_code(2);
        assert_eq!((ended.stdout.as_str(), ended.stderr), ("", expected), "{stem}");
        seen += 1;
    }
    assert!(seen > 50, "only {seen} bad scenes found");
    assert_eq!(folder.files(), [""; 0]);
}
