//! The GPU tracer: device, buffers and dispatches, by way of wgpu.

mod bands;
mod bytes;
mod device;
mod iterations;
mod pace;
mod pipeline;
mod poll;
pub mod probe;
mod replay;
mod scene;
mod tracer;

pub use bytes::device_parts;
pub use device::{Adapter, Gpu, adapters};
pub use poll::is_polling;
pub use replay::Replayer;
pub use tracer::GpuTracer;
