//! The film on the device: bands of whole rows, because one storage binding is
//! limited (128 MiB on lavapipe, 2.5 Mpixel).

use super::device::Gpu;
use crate::film::{BYTES_PER_PIXEL, PixelWords};
use crate::scene::ImageSize;
use crate::tracer::TraceError;
use std::ops::Range;

/// Bytes read back at a time; a small share of the film, so that a picture takes
/// little more than its 52 bytes per pixel on the device.
const STAGING_BYTES: u64 = 1 << 20;

/// Some rows of the film.
#[derive(Debug)]
pub(super) struct Band {
    /// Which rows.
    pub rows: Range<u32>,
    /// Their words.
    pub buffer: wgpu::Buffer,
}

/// Makes the film's buffers, filled with zeros.
pub(super) fn allocate(gpu: &Gpu, size: ImageSize) -> Result<Vec<Band>, TraceError> {
    let limits = gpu.device().limits();
    let binding = limits
        .max_storage_buffer_binding_size
        .min(limits.max_buffer_size)
        // The kernel counts words in 32 bits.
        .min(u64::from(u32::MAX));
    let row_bytes = u64::from(size.width()) * BYTES_PER_PIXEL;
    let rows = u32::try_from(binding / row_bytes).unwrap_or(u32::MAX).min(size.height());
    if rows == 0 {
        return Err(TraceError::Device(format!(
            "{} binds at most {binding} bytes, one row of this picture takes {row_bytes}",
            gpu.description().device
        )));
    }
    let mut bands = Vec::new();
    for start in (0..size.height()).step_by(rows as usize) {
        let rows = start..size.height().min(start + rows);
        let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
            label: Some("film"),
            size: u64::from(rows.end - rows.start) * row_bytes,
            usage: wgpu::BufferUsages::STORAGE
                | wgpu::BufferUsages::COPY_SRC
                | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        gpu.check()?;
        bands.push(Band { rows, buffer });
    }
    Ok(bands)
}

/// Bytes of one piece of a band of `largest` bytes on its way: whole pixels.
pub(super) fn staging_bytes(largest: u64) -> u64 {
    largest.min(STAGING_BYTES / BYTES_PER_PIXEL * BYTES_PER_PIXEL)
}

/// Copies the bands, in order, over `pixels`.
pub(super) fn read(
    gpu: &Gpu,
    bands: &[&Band],
    pixels: &mut [PixelWords],
) -> Result<(), TraceError> {
    let largest = bands.iter().map(|band| band.buffer.size()).max().unwrap_or(0);
    let piece = staging_bytes(largest);
    let staging = staging_buffer(gpu, piece)?;
    let mut rest: &mut [u8] = bytemuck::cast_slice_mut(pixels);
    for band in bands {
        let mut offset = 0;
        while offset < band.buffer.size() {
            let bytes = piece.min(band.buffer.size() - offset);
            let (target, others) = rest.split_at_mut(index(bytes));
            read_piece(gpu, &band.buffer, offset, &staging, target)?;
            rest = others;
            offset += bytes;
        }
    }
    Ok(())
}

/// Writes `pixels` over the bands, in order.
pub(super) fn write(gpu: &Gpu, bands: &[&Band], pixels: &[PixelWords]) -> Result<(), TraceError> {
    let mut rest: &[u8] = bytemuck::cast_slice(pixels);
    for band in bands {
        let mut offset = 0;
        while offset < band.buffer.size() {
            let bytes = staging_bytes(band.buffer.size() - offset);
            let (piece, others) = rest.split_at(index(bytes));
            gpu.queue().write_buffer(&band.buffer, offset, piece);
            // Each piece waits in a buffer of its own until something is submitted.
            let encoder =
                gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            gpu.run(encoder)?;
            rest = others;
            offset += bytes;
        }
    }
    Ok(())
}

/// Copies a whole buffer to the host.
pub(super) fn read_buffer(gpu: &Gpu, buffer: &wgpu::Buffer) -> Result<Vec<u8>, TraceError> {
    let staging = staging_buffer(gpu, buffer.size())?;
    let mut bytes = vec![0; index(buffer.size())];
    read_piece(gpu, buffer, 0, &staging, &mut bytes)?;
    Ok(bytes)
}

fn staging_buffer(gpu: &Gpu, size: u64) -> Result<wgpu::Buffer, TraceError> {
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some("read back"),
        size,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    gpu.check()?;
    Ok(buffer)
}

fn read_piece(
    gpu: &Gpu,
    buffer: &wgpu::Buffer,
    offset: u64,
    staging: &wgpu::Buffer,
    target: &mut [u8],
) -> Result<(), TraceError> {
    let bytes = target.len() as u64;
    let mut encoder =
        gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    encoder.copy_buffer_to_buffer(buffer, offset, staging, 0, bytes);
    encoder.map_buffer_on_submit(staging, wgpu::MapMode::Read, 0..bytes, |_| ());
    gpu.run(encoder)?;
    let mapped = staging
        .get_mapped_range(0..bytes)
        .map_err(|error| gpu.unmapped(format!("the film cannot be read: {error}")))?;
    target.copy_from_slice(&mapped);
    drop(mapped);
    staging.unmap();
    gpu.check()
}

fn index(bytes: u64) -> usize {
    usize::try_from(bytes).expect("the host film of the same size was allocated")
}
