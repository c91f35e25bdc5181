//! The kernel: WGSL composed for one scene, and the scene packed for it.

mod compose;
pub mod layout;
mod pack;
mod probes;
mod search;
mod spirv;
mod text;
mod tile;
mod turns;
mod unrolled;
mod validate;
mod wide;

pub use compose::{Kernel, UNROLLED_BOUNCES, UNROLLED_SPHERES};
pub use layout::SPHERE_CAPACITY;
pub use pack::{KernelUnits, Packed, pack};
pub use probes::{hierarchy_probe_source, probe_source};
pub use spirv::spirv;
pub use tile::Tile;
pub use validate::validate;
