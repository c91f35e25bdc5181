//! Any bytes as an EXR picture: read and compared with itself.

#![no_main]

#[path = "../../tests/support/hostile.rs"]
mod hostile;

use libfuzzer_sys::fuzz_target;
use std::path::PathBuf;
use std::sync::LazyLock;

static SCRATCH: LazyLock<PathBuf> = LazyLock::new(|| hostile::scratch("exr"));

fuzz_target!(|bytes: &[u8]| {
    hostile::check_picture(bytes, &SCRATCH);
});
