//! The files that the fuzzers found worth keeping, read once more: each takes another way
//! through candor's readers, and those that once did harm are among them.

mod support {
    pub mod hostile;
}

use std::fs;
use std::path::Path;
use support::hostile::{check_data, check_picture, check_scene};

/// Runs `check` over the files in `tests/corpus/NAME`; returns how many there are and how
/// many it accepts.
fn over(name: &str, check: fn(&[u8], &Path) -> bool) -> (usize, usize) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/corpus").join(name);
    let scratch = tempfile::tempdir().expect("a temporary folder can be made");
    let entries = fs::read_dir(&folder).expect("the corpus can be listed");
    let (mut files, mut accepted) = (0, 0);
    for entry in entries {
        let path = entry.expect("the corpus can be listed").path();
        println!("{}", path.display());
        let bytes = fs::read(&path).expect("the corpus can be read");
        files += 1;
        accepted += usize::from(check(&bytes, &scratch.path().join("scratch")));
    }
    (files, accepted)
}

#[test]
fn scenes_are_read_or_refused() {
    let (files, accepted) = over("scene", check_scene);
    assert!(files > 1000 && accepted > 40, "{files} files, {accepted} scenes");
}

#[test]
fn data_is_read_or_refused() {
    let (files, accepted) = over("data", check_data);
    assert!(files > 30 && accepted > 5, "{files} files, {accepted} of them data");
}

#[test]
fn pictures_are_read_or_refused() {
    let (files, accepted) = over("picture", check_picture);
    assert!(files > 500 && accepted > 20, "{files} files, {accepted} pictures");
}
