//! Whether a picture fits into memory, asked before anything is allocated.

use super::{Refusal, refuse, units};
use crate::film::BYTES_PER_PIXEL;
use crate::scene::{ImageSize, Scene};
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Bytes per pixel of the developed picture and of the files on their way out: four
/// `f32` channels twice, and the PNG.
const PICTURE_BYTES: u64 = 2 * 16 + 3;

/// Bytes per pixel while two pictures are compared: one as it is kept and the other as it
/// comes from its file, four `f32` channels, and as it is kept.
const COMPARISON_BYTES: u64 = 3 * 16;

/// Bytes for each sphere, beside the scene itself, while a tracer is made ready: a million take
/// 0.35 to 0.5 GB in all on their way to a device or to the twin.
const SPHERE_BYTES: u64 = 400;

/// Bytes of this machine's memory that a render of a scene takes, with so many films in it at a
/// time.
pub(super) fn needed(scene: &Scene, films: u64) -> u64 {
    let picture = films * BYTES_PER_PIXEL + PICTURE_BYTES;
    u64::from(scene.size().pixels()) * picture + scene.spheres().len() as u64 * SPHERE_BYTES
}

/// Refuses a picture that does not fit.
pub(super) fn check(size: ImageSize, needed: u64) -> Result<(), Refusal> {
    match lack(size, needed) {
        None => Ok(()),
        Some(lack) => refuse(format_args!("{lack}; render a smaller --size")),
    }
}

/// Refuses to merge films of `size` that do not fit: two of them are in memory, the whole and a
/// part of it.
pub(super) fn check_merge(size: ImageSize) -> Result<(), Refusal> {
    let bytes = 2 * BYTES_PER_PIXEL + PICTURE_BYTES;
    lack(size, u64::from(size.pixels()) * bytes).map_or(Ok(()), refuse)
}

/// Refuses to compare two pictures of `size` that do not fit.
pub(super) fn check_comparison(size: ImageSize) -> Result<(), Refusal> {
    match lack(size, u64::from(size.pixels()) * COMPARISON_BYTES) {
        None => Ok(()),
        Some(lack) => refuse(lack),
    }
}

/// What is lacking for a picture that takes `needed` bytes, if anything.
fn lack(size: ImageSize, needed: u64) -> Option<String> {
    let available = available();
    (needed > available).then(|| {
        format!(
            "{size} pixels need {} of memory, {} are available",
            units::bytes(needed),
            units::bytes(available)
        )
    })
}

/// Free memory of this machine or of the container; where the system does not say, no
/// picture is refused.
fn available() -> u64 {
    let refresh = RefreshKind::nothing().with_memory(MemoryRefreshKind::nothing().with_ram());
    System::new_with_specifics(refresh).map_or(u64::MAX, |system| {
        let limit = system.cgroup_limits().map_or(u64::MAX, |limits| limits.free_memory);
        system.available_memory().min(limit)
    })
}
