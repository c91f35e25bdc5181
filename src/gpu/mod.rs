//! The GPU tracer: device, buffers and dispatches, by way of wgpu.

mod bands;
mod device;
mod pace;
pub mod probe;
mod replay;
mod tracer;

pub use device::{Adapter, Gpu, adapters};
pub use replay::Replayer;
pub use tracer::GpuTracer;
