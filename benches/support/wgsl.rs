//! Pieces of the kernel's text: other bodies for its functions, and calls to be timed.

#![allow(dead_code, reason = "each benchmark uses some of them")]

use candor::gpu::Gpu;
use std::time::Instant;

pub const MATH: &str = concat!(
    include_str!("../../shaders/azimuth.wgsl"),
    include_str!("../../shaders/exponential.wgsl"),
    include_str!("../../shaders/exp_minus.wgsl")
);
pub const SPHERE: &str = concat!(
    include_str!("../../shaders/sphere.wgsl"),
    include_str!("../../shaders/entry.wgsl"),
    include_str!("../../shaders/factored.wgsl"),
    include_str!("../../shaders/anchored.wgsl")
);

/// The text with another body for a function.
///
/// # Panics
/// If there is no such function, or the text does not parse as the kernel's does: a closing
/// brace alone at the start of a line.
pub fn with_body(wgsl: &str, function: &str, body: &str) -> String {
    let head = format!("fn {function}(");
    assert_eq!(wgsl.matches(&head).count(), 1, "functions called {function}");
    let start = wgsl.find(&head).expect("counted above");
    let open = start + wgsl[start..].find("{\n").expect("a body") + 2;
    let close = open + wgsl[open..].find("\n}").expect("its end");
    format!("{}    {body}{}", &wgsl[..open], &wgsl[close..])
}

/// Calls of one invocation.
const CALLS: u32 = 64;
/// Invocations of one measurement.
const INVOCATIONS: u32 = 1 << 19;

/// A function on the device that is called again and again, with nothing compiled in between.
pub struct Calls {
    gpu: Gpu,
    pipeline: wgpu::ComputePipeline,
    group: wgpu::BindGroup,
}

impl Calls {
    /// `expression` is an `f32` made of `u`, a multiple of 2⁻²⁴ in [0, 1); the functions that
    /// it calls are in `functions`.
    ///
    /// # Panics
    /// If the device refuses the text.
    pub fn new(gpu: Gpu, functions: &str, expression: &str) -> Self {
        let text = format!(
            "{functions}
@group(0) @binding(0) var<storage, read_write> outputs: array<f32>;

@compute @workgroup_size(64)
fn call(@builtin(global_invocation_id) id: vec3<u32>) {{
    var sum = 0.0;
    for (var i = 0u; i < {CALLS}u; i++) {{
        let u = f32(((id.x * {CALLS}u + i) * 2654435761u) >> 8u) * 5.9604644775390625e-8;
        sum += {expression};
    }}
    outputs[id.x] = sum;
}}
"
        );
        let device = gpu.device();
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("calls"),
            source: wgpu::ShaderSource::Wgsl(text.into()),
        });
        let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
            label: Some("calls"),
            layout: None,
            module: &module,
            entry_point: Some("call"),
            compilation_options: wgpu::PipelineCompilationOptions::default(),
            cache: None,
        });
        let outputs = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("outputs"),
            size: u64::from(INVOCATIONS) * 4,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("calls"),
            layout: &pipeline.get_bind_group_layout(0),
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: outputs.as_entire_binding() }],
        });
        gpu.check().expect("the device takes the calls");
        let calls = Self { gpu, pipeline, group };
        // The first dispatch may still compile.
        calls.nanoseconds();
        calls
    }

    /// Nanoseconds of one call, on all of the device.
    pub fn nanoseconds(&self) -> f64 {
        let started = Instant::now();
        let mut encoder =
            self.gpu.device().create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        {
            let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
            pass.set_pipeline(&self.pipeline);
            pass.set_bind_group(0, &self.group, &[]);
            pass.dispatch_workgroups(INVOCATIONS / 64, 1, 1);
        }
        self.gpu.run(encoder).expect("the device runs");
        started.elapsed().as_secs_f64() * 1e9 / f64::from(CALLS) / f64::from(INVOCATIONS)
    }
}
