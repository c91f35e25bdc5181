//! The kernel: WGSL composed for one scene, and the scene packed for it.

mod compose;
pub mod layout;
mod pack;
mod search;
mod spirv;
mod text;
mod tile;
mod turns;
mod unrolled;
mod validate;
mod wide;

pub use compose::{
    Kernel, UNROLLED_BOUNCES, UNROLLED_SPHERES, hierarchy_probe_source, probe_source,
};
pub use layout::SPHERE_CAPACITY;
pub use pack::{KernelUnits, Packed, pack};
pub use spirv::spirv;
pub use tile::Tile;
pub use validate::validate;
