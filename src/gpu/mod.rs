//! The GPU tracer: device, buffers and dispatches, by way of wgpu.

mod bands;
mod device;
mod iterations;
mod pace;
mod pipeline;
pub mod probe;
mod replay;
mod scene;
mod tracer;

pub use device::{Adapter, Gpu, adapters};
pub use replay::Replayer;
pub use tracer::GpuTracer;
