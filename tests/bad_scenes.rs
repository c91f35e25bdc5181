//! Every mistake in a scene file, with the message that its author sees.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

use candor::scene::{SceneFileError, load, parse};

/// Fewer files than this mean that the folder was not found as it is.
const AT_LEAST: usize = 80;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/bad")
}

/// The names, without ending, of the files in `scenes/bad` that end in `ending`.
fn names(ending: &str) -> BTreeSet<String> {
    let entries = fs::read_dir(folder()).expect("scenes/bad can be listed");
    let paths = entries.map(|entry| entry.expect("scenes/bad can be listed").path());
    paths
        .filter(|path| path.extension().is_some_and(|e| e == ending))
        .map(|path| path.file_stem().expect("a name").to_string_lossy().into_owned())
        .collect()
}

/// The message for `scenes/bad/NAME.toml`, without the folder of the files that it names, and
/// with a newline at its end as in the file.
fn message(name: &str) -> String {
    let file = folder().join(format!("{name}.toml"));
    match load(&file) {
        Ok(_) => panic!("{name}.toml is accepted"),
        Err(error) => {
            let folder = folder().join("");
            format!("{error}\n").replace(&folder.display().to_string(), "")
        }
    }
}

/// With `CANDOR_BLESS=1` in the environment the expected texts are written anew, and
/// the test fails so that this cannot be mistaken for a check.
#[test]
fn messages_are_as_expected() {
    let scenes = names("toml");
    assert!(scenes.len() >= AT_LEAST, "only {} bad scenes found", scenes.len());
    if std::env::var_os("CANDOR_BLESS").is_some_and(|value| value == "1") {
        for name in &scenes {
            let path = folder().join(format!("{name}.txt"));
            fs::write(path, message(name)).expect("a message can be written");
        }
        panic!("wrote {} messages; read them, then test without CANDOR_BLESS", scenes.len());
    }
    assert_eq!(scenes, names("txt"), "each .toml has its .txt and the reverse");
    let wrong: Vec<String> = scenes.iter().filter_map(|name| difference(name)).collect();
    assert!(wrong.is_empty(), "{} of {} differ:\n{}", wrong.len(), scenes.len(), wrong.join("\n"));
}

/// What differs between the message for `name` and the expected one.
fn difference(name: &str) -> Option<String> {
    let path = folder().join(format!("{name}.txt"));
    let expected = fs::read_to_string(path).expect("an expected message can be read");
    let found = message(name);
    (found != expected).then(|| format!("== {name}\n-- expected\n{expected}-- found\n{found}"))
}

#[test]
fn every_kind_of_mistake_has_a_message_of_its_own() {
    let mut seen = BTreeSet::new();
    for name in names("toml") {
        let message = message(&name);
        assert!(seen.insert(message), "{name} repeats another file's message");
    }
}

/// A file in the folder that cargo keeps for tests.
fn temporary(name: &str, bytes: &[u8]) -> PathBuf {
    let path = Path::new(env!("CARGO_TARGET_TMPDIR")).join(name);
    fs::write(&path, bytes).expect("a temporary file can be written");
    path
}

#[test]
fn a_missing_file_is_named() {
    let path = Path::new("no/such/scene.toml");
    let error = load(path).expect_err("there is no such file");
    assert!(matches!(&error, SceneFileError::Read { path: p, .. } if p == path));
    assert!(error.to_string().starts_with("error: cannot read no/such/scene.toml: "), "{error}");
}

#[test]
fn a_folder_is_not_a_scene() {
    assert!(matches!(load(&folder()), Err(SceneFileError::Read { .. })));
}

#[test]
fn a_huge_file_is_refused_unread() {
    let path = temporary("huge.toml", b"");
    // A file of nothing but a hole: it has the length, and takes no room on the disk.
    let file = fs::OpenOptions::new().write(true).open(&path).expect("the file was just written");
    file.set_len((16 << 20) + 1).expect("a file can be made longer");
    let error = load(&path).expect_err("the file is too large");
    fs::remove_file(&path).expect("a temporary file can be removed");
    let expected =
        format!("error: {} is too large: a scene file has at most 16 MiB", path.display());
    assert_eq!(error.to_string(), expected);
}

#[cfg(unix)]
#[test]
fn a_file_without_end_is_refused() {
    let error = load(Path::new("/dev/zero")).expect_err("zeros are no scene");
    assert!(matches!(error, SceneFileError::TooLarge { .. }));
}

#[test]
fn text_in_another_encoding_is_refused_with_the_place() {
    let path = temporary("latin1.toml", b"[camera]\n# caf\xe9\n");
    let error = load(&path).expect_err("the file is not UTF-8");
    let expected = format!(
        "error: this file is not UTF-8 text
  --> {}:2:6
  |
2 | # caf\u{fffd}
  |      ^ the byte here is 0xE9
  |
  = save it as plain text with the encoding UTF-8",
        path.display()
    );
    assert_eq!(error.to_string(), expected);
}

/// Brackets, tables and keys, nested without end or as deep as the parser lets them.
#[test]
fn deep_nesting_is_an_error_and_not_a_crash() {
    let dotted = vec!["a"; 79].join(".");
    let deepest = format!("{dotted} = {}1{}", format!("{{{dotted} = ").repeat(78), "}".repeat(78));
    let texts = [
        format!("a = {}", "[".repeat(100_000)),
        format!("a = {}{}", "[".repeat(100_000), "]".repeat(100_000)),
        format!("a = {}", "{a=".repeat(100_000)),
        format!("{} = 1", vec!["a"; 100_000].join(".")),
        format!("[{}]", vec!["a"; 100_000].join(".")),
        format!("[{dotted}]\n{deepest}"),
    ];
    for text in texts {
        let error = parse("deep.toml", &text).expect_err("nothing in a scene nests so deeply");
        assert!(error.to_string().len() < 2000);
    }
}
