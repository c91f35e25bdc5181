//! A packed scene on a device: its buffers, and how kernels are given them.

use super::device::Gpu;
use crate::kernel::{Packed, SPHERE_CAPACITY, layout};
use crate::tracer::TraceError;
use bytemuck::{NoUninit, Zeroable};
use std::borrow::Cow;

/// What a kernel is given at one binding.
#[derive(Debug, Clone)]
pub(super) struct Binding {
    /// Its number in the shaders.
    pub number: u32,
    /// Uniform, or storage that is read or written as well.
    pub kind: wgpu::BufferBindingType,
    /// The buffer.
    pub buffer: wgpu::Buffer,
}

impl Binding {
    /// A handle on the buffer goes in.
    pub(super) fn new(number: u32, kind: wgpu::BufferBindingType, buffer: &wgpu::Buffer) -> Self {
        Self { number, kind, buffer: buffer.clone() }
    }
}

const READ: wgpu::BufferBindingType = wgpu::BufferBindingType::Storage { read_only: true };
pub(super) const WRITTEN: wgpu::BufferBindingType =
    wgpu::BufferBindingType::Storage { read_only: false };

/// The buffers of one scene: bindings 0, and from 6 on.
#[derive(Debug)]
pub(super) struct SceneBuffers(Vec<Binding>);

impl SceneBuffers {
    /// Takes a scene to the device.
    ///
    /// # Errors
    /// If it has more spheres or lights than the device binds, or has no memory for them.
    pub(super) fn new(gpu: &Gpu, packed: &Packed) -> Result<Self, TraceError> {
        check_size(gpu, packed)?;
        let binding = |part: Part| Ok(Binding::new(part.number, part.kind, &filled(gpu, &part)?));
        Ok(Self(parts(packed).into_iter().map(binding).collect::<Result<_, TraceError>>()?))
    }

    /// Bytes of all of them.
    pub(super) fn bytes(&self) -> u64 {
        self.0.iter().map(|binding| binding.buffer.size()).sum()
    }

    pub(super) fn bindings(&self) -> &[Binding] {
        &self.0
    }
}

/// The light tree's nodes have numbers that an `f32` holds.
const MOST_LIGHT_NODES: u64 = 1 << 24;

/// Nodes that wait have 24 bits for their place.
const MOST_NODES: u64 = 1 << 24;

/// Refuses more spheres, or more lights, than fit into one binding.
fn check_size(gpu: &Gpu, packed: &Packed) -> Result<(), TraceError> {
    let limits = gpu.device().limits();
    let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let spheres = binding / size_of::<layout::Sphere>() as u64;
    let nodes = (binding / size_of::<layout::LightNode>() as u64).min(MOST_LIGHT_NODES);
    check(gpu, "spheres", packed.spheres.len(), spheres)?;
    check(gpu, "nodes in its hierarchy", packed.nodes.len(), MOST_NODES)?;
    check(gpu, "lights", packed.light_tree.len() / 2, nodes / 2)
}

fn check(gpu: &Gpu, what: &str, count: usize, most: u64) -> Result<(), TraceError> {
    if count as u64 <= most {
        return Ok(());
    }
    Err(TraceError::Device(format!(
        "the scene has {count} {what}; {} takes at most {most} (--device cpu takes any number)",
        gpu.description().device
    )))
}

/// A buffer with its contents. wgpu's own `create_buffer_init` panics where the device is lost or
/// has no memory.
fn filled(gpu: &Gpu, part: &Part) -> Result<wgpu::Buffer, TraceError> {
    let buffer = gpu.device().create_buffer(&wgpu::BufferDescriptor {
        label: Some(part.label),
        size: part.contents.len() as u64,
        usage: match part.kind {
            wgpu::BufferBindingType::Uniform => wgpu::BufferUsages::UNIFORM,
            wgpu::BufferBindingType::Storage { .. } => wgpu::BufferUsages::STORAGE,
        },
        mapped_at_creation: true,
    });
    gpu.check()?;
    let mut mapped = buffer
        .get_mapped_range_mut(..)
        .map_err(|error| gpu.unmapped(format!("the scene cannot be written: {error}")))?;
    mapped.copy_from_slice(&part.contents);
    drop(mapped);
    buffer.unmap();
    gpu.check()?;
    Ok(buffer)
}

/// One buffer of a scene.
struct Part<'a> {
    number: u32,
    label: &'static str,
    kind: wgpu::BufferBindingType,
    contents: Cow<'a, [u8]>,
}

/// What goes into the buffers of a scene.
fn parts(packed: &Packed) -> Vec<Part<'_>> {
    let mut parts = vec![uniform(0, "scene", std::slice::from_ref(&packed.scene), 1)];
    if packed.is_stored() {
        parts.push(stored(6, "spheres", &packed.spheres));
        parts.push(stored(7, "lights", &packed.lights));
    } else {
        parts.push(uniform(6, "spheres", &packed.spheres, SPHERE_CAPACITY));
        parts.push(uniform(7, "lights", &packed.lights, SPHERE_CAPACITY));
    }
    if !packed.nodes.is_empty() {
        parts.push(stored(8, "hierarchy", &packed.nodes));
    }
    if !packed.light_tree.is_empty() {
        parts.push(stored(9, "light tree", &packed.light_tree));
    }
    parts
}

/// Bytes of each of them.
pub(super) fn bytes(packed: &Packed) -> Vec<(&'static str, u64)> {
    parts(packed).iter().map(|part| (part.label, part.contents.len() as u64)).collect()
}

/// Some values, and zeros up to `count`.
fn uniform<T: NoUninit + Zeroable>(
    number: u32,
    label: &'static str,
    values: &[T],
    count: usize,
) -> Part<'static> {
    let mut filled = values.to_vec();
    filled.resize_with(count, T::zeroed);
    let contents = bytemuck::cast_slice(&filled).to_vec().into();
    Part { number, label, kind: wgpu::BufferBindingType::Uniform, contents }
}

/// A binding cannot be empty.
fn stored<'a, T: NoUninit + Zeroable>(
    number: u32,
    label: &'static str,
    values: &'a [T],
) -> Part<'a> {
    let contents = if values.is_empty() {
        bytemuck::bytes_of(&T::zeroed()).to_vec().into()
    } else {
        Cow::Borrowed(bytemuck::cast_slice(values))
    };
    Part { number, label, kind: READ, contents }
}
