//! What a benchmark is told on its command line, and the device that it measures.

#![allow(dead_code, reason = "each benchmark uses some of them")]

use candor::gpu::{Adapter, Gpu, adapters};
use std::path::Path;

/// The word after `--name` on the command line.
pub fn option(name: &str) -> Option<String> {
    let args: Vec<String> = std::env::args().collect();
    args.iter().position(|arg| arg == name).and_then(|at| args.get(at + 1)).cloned()
}

/// A whole number after `--name`, such as 1000000 or 1e6.
///
/// # Panics
/// If it is none.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "checked")]
pub fn count(name: &str) -> Option<u64> {
    let number = |text: String| {
        let value: f64 = text.parse().unwrap_or(f64::NAN);
        assert!(
            (1.0..=1e15).contains(&value) && value.fract() == 0.0,
            "{name} takes a whole number from 1 to 1e15, such as 1000000 or 1e6, not {text}"
        );
        value as u64
    };
    option(name).map(number)
}

/// The device that `--device` names a part of, or the first one.
///
/// # Panics
/// If there is none.
pub fn adapter() -> Adapter {
    let wanted = option("--device").map(|name| name.to_lowercase());
    adapters()
        .into_iter()
        .find(|a| wanted.as_ref().is_none_or(|name| a.name().to_lowercase().contains(name)))
        .expect("a device is needed")
}

/// Opens a device.
///
/// # Panics
/// If its driver refuses.
pub fn open(adapter: &Adapter) -> Gpu {
    Gpu::open(adapter).expect("the device opens")
}

/// The repository.
pub fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}
