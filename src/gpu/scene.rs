//! A packed scene on a device: its buffers, and how kernels are given them.

use super::device::Gpu;
use crate::kernel::{Packed, SPHERE_CAPACITY, layout};
use crate::tracer::TraceError;
use bytemuck::{NoUninit, Zeroable};
use wgpu::util::DeviceExt;

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
    /// If it has more spheres than the device binds, or has no memory for them.
    pub(super) fn new(gpu: &Gpu, packed: &Packed) -> Result<Self, TraceError> {
        check_size(gpu, packed)?;
        let header = uniform(gpu, "scene", std::slice::from_ref(&packed.scene));
        let mut bindings = vec![Binding::new(0, wgpu::BufferBindingType::Uniform, &header)];
        if packed.is_stored() {
            bindings.push(Binding::new(6, READ, &stored(gpu, "spheres", &packed.spheres)));
            bindings.push(Binding::new(7, READ, &stored(gpu, "lights", &packed.lights)));
        } else {
            let spheres = filled(&packed.spheres, SPHERE_CAPACITY);
            let lights = filled(&packed.lights, SPHERE_CAPACITY);
            let kind = wgpu::BufferBindingType::Uniform;
            bindings.push(Binding::new(6, kind, &uniform(gpu, "spheres", &spheres)));
            bindings.push(Binding::new(7, kind, &uniform(gpu, "lights", &lights)));
        }
        if !packed.nodes.is_empty() {
            bindings.push(Binding::new(8, READ, &stored(gpu, "hierarchy", &packed.nodes)));
        }
        gpu.check()?;
        Ok(Self(bindings))
    }

    /// Bytes of all of them.
    pub(super) fn bytes(&self) -> u64 {
        self.0.iter().map(|binding| binding.buffer.size()).sum()
    }

    pub(super) fn bindings(&self) -> &[Binding] {
        &self.0
    }
}

/// Refuses more spheres than fit into one binding.
fn check_size(gpu: &Gpu, packed: &Packed) -> Result<(), TraceError> {
    let limits = gpu.device().limits();
    let binding = limits.max_storage_buffer_binding_size.min(limits.max_buffer_size);
    let most = binding / size_of::<layout::Sphere>() as u64;
    if packed.spheres.len() as u64 <= most {
        return Ok(());
    }
    Err(TraceError::Device(format!(
        "the scene has {} spheres; {} takes at most {most} (--device cpu takes any number)",
        packed.spheres.len(),
        gpu.description().device
    )))
}

/// `values`, and zeros up to `count`.
fn filled<T: Zeroable + Clone>(values: &[T], count: usize) -> Vec<T> {
    let mut filled = values.to_vec();
    filled.resize_with(count, T::zeroed);
    filled
}

fn uniform<T: NoUninit>(gpu: &Gpu, label: &str, values: &[T]) -> wgpu::Buffer {
    create(gpu, label, bytemuck::cast_slice(values), wgpu::BufferUsages::UNIFORM)
}

/// A binding cannot be empty.
fn stored<T: NoUninit + Zeroable>(gpu: &Gpu, label: &str, values: &[T]) -> wgpu::Buffer {
    let nothing = [T::zeroed()];
    let values = if values.is_empty() { &nothing } else { values };
    create(gpu, label, bytemuck::cast_slice(values), wgpu::BufferUsages::STORAGE)
}

fn create(gpu: &Gpu, label: &str, contents: &[u8], usage: wgpu::BufferUsages) -> wgpu::Buffer {
    gpu.device().create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some(label),
        contents,
        usage,
    })
}
