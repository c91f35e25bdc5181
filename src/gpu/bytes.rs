//! How many bytes a scene and its picture take on a device, part by part.

use super::bands;
use super::scene;
use crate::film::BYTES_PER_PIXEL;
use crate::kernel::{Packed, layout};
use crate::scene::ImageSize;

/// The buffers that a packed scene and a picture of `size` take, each with its bytes; together
/// they are [`GpuTracer::device_bytes`](super::GpuTracer::device_bytes).
#[must_use]
pub fn device_parts(packed: &Packed, size: ImageSize) -> Vec<(&'static str, u64)> {
    let film = u64::from(size.pixels()) * BYTES_PER_PIXEL;
    let mut parts = scene::bytes(packed);
    parts.push(("film", film));
    parts.push(("reading back", bands::staging_bytes(film)));
    parts.push((
        "work and ledger",
        (size_of::<layout::Dispatch>() + size_of::<layout::Ledger>()) as u64,
    ));
    parts
}
