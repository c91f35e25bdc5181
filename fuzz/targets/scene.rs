//! Any bytes as a scene file: read, and taken as far as to the device.

#![no_main]

#[path = "../../tests/support/hostile.rs"]
mod hostile;

use libfuzzer_sys::fuzz_target;
use std::path::PathBuf;
use std::sync::LazyLock;

static SCRATCH: LazyLock<PathBuf> = LazyLock::new(|| hostile::scratch("toml"));

fuzz_target!(|bytes: &[u8]| {
    hostile::check_scene(bytes, &SCRATCH);
});
