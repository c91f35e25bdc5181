//! Runs single functions of the kernel over tables of inputs, for the tests.

use super::bands::read_buffer;
use super::device::Gpu;
use super::scene::SceneBuffers;
use crate::film::{PixelWords, WORDS};
use crate::kernel::{Packed, probe_source, validate};
use crate::tracer::TraceError;
use wgpu::util::DeviceExt;

/// One row of a probe's table.
pub type Row = [u32; 4];

/// The probe kernel on a device.
#[derive(Debug)]
pub struct Probe<'gpu> {
    gpu: &'gpu Gpu,
    wgsl: String,
    module: wgpu::ShaderModule,
    scene: SceneBuffers,
}

impl<'gpu> Probe<'gpu> {
    /// Compiles the probe; `scene` is what its functions find in the scene's buffers.
    ///
    /// # Errors
    /// If the device refuses the kernel.
    pub fn new(gpu: &'gpu Gpu, scene: &Packed) -> Result<Self, TraceError> {
        Self::with_source(gpu, scene, probe_source())
    }

    /// Compiles another text whose entry points use the bindings of `shaders/probe.wgsl`:
    /// what is compared with the kernel, or a kernel that is wrong on purpose.
    ///
    /// # Errors
    /// If the device refuses the text.
    pub fn with_source(gpu: &'gpu Gpu, scene: &Packed, wgsl: String) -> Result<Self, TraceError> {
        let module = gpu.device().create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("probe"),
            source: wgpu::ShaderSource::Wgsl(wgsl.as_str().into()),
        });
        gpu.check()?;
        let scene = SceneBuffers::new(gpu, scene)?;
        Ok(Self { gpu, wgsl, module, scene })
    }

    /// Runs the entry point once for each of the `results` rows that it writes.
    ///
    /// Rows that it does not write read as all ones, so that a zero that was written
    /// and a row that was forgotten look different.
    ///
    /// # Errors
    /// If the device fails.
    pub fn run(&self, entry: &str, inputs: &[Row], results: usize) -> Result<Vec<Row>, TraceError> {
        let outputs = vec![[u32::MAX; 4]; results];
        let output = self.storage(bytemuck::cast_slice(&outputs));
        let input = self.storage(bytemuck::cast_slice(inputs));
        self.dispatch(entry, &[(4, &input), (5, &output)], results)?;
        Ok(bytemuck::pod_collect_to_vec(&read_buffer(self.gpu, &output)?))
    }

    /// Adds every row (r, g, b, pixel) to a film, all at once, and returns its words.
    ///
    /// # Errors
    /// If the device fails.
    pub fn add_to_film(
        &self,
        film: &[PixelWords],
        rows: &[Row],
    ) -> Result<Vec<PixelWords>, TraceError> {
        let words = self.storage(bytemuck::cast_slice(film));
        let input = self.storage(bytemuck::cast_slice(rows));
        self.dispatch("probe_film", &[(2, &words), (4, &input)], rows.len())?;
        let bytes = read_buffer(self.gpu, &words)?;
        let words: Vec<u32> = bytemuck::pod_collect_to_vec(&bytes);
        Ok(words.as_chunks::<WORDS>().0.to_vec())
    }

    fn storage(&self, contents: &[u8]) -> wgpu::Buffer {
        self.gpu.device().create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: None,
            contents,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_SRC,
        })
    }

    /// Binds what the entry point uses (a default layout holds nothing else) and runs it.
    fn dispatch(
        &self,
        entry: &str,
        buffers: &[(u32, &wgpu::Buffer)],
        invocations: usize,
    ) -> Result<(), TraceError> {
        let device = self.gpu.device();
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some(entry),
            layout: None,
            module: &self.module,
            entry_point: Some(entry),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let used = bindings_of(&self.wgsl, entry);
        let scene = self.scene.bindings().iter().map(|binding| (binding.number, &binding.buffer));
        let entries: Vec<wgpu::BindGroupEntry> = scene
            .chain(buffers.iter().copied())
            .filter(|(binding, _)| used.contains(binding))
            .map(|(binding, buffer)| wgpu::BindGroupEntry {
                binding,
                resource: buffer.as_entire_binding(),
            })
            .collect();
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some(entry),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &entries,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&pipeline);
            pass.set_bind_group(0, &group, &[]);
            let groups = u32::try_from(invocations.div_ceil(64)).expect("a table fits a dispatch");
            pass.dispatch_workgroups(groups, 1, 1);
        }
        self.gpu.run(encoder)
    }
}

/// The bindings that an entry point reaches, from naga.
fn bindings_of(wgsl: &str, entry: &str) -> Vec<u32> {
    let (module, info) = validate(wgsl).expect("compiled before");
    let index = module
        .entry_points
        .iter()
        .position(|e| e.name == entry)
        .expect("the probe has this entry point");
    module
        .global_variables
        .iter()
        .filter(|(handle, _)| !info.get_entry_point(index)[*handle].is_empty())
        .filter_map(|(_, variable)| variable.binding.as_ref().map(|b| b.binding))
        .collect()
}
