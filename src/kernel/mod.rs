//! The kernel: WGSL composed for one scene, and the scene packed for it.

mod compose;
pub mod layout;
mod pack;
mod search;
mod text;
mod tile;
mod turns;
mod unrolled;
mod validate;
mod wide;

pub use compose::{Kernel, UNROLLED_SPHERES, hierarchy_probe_source, probe_source};
pub use layout::SPHERE_CAPACITY;
pub use pack::{KernelUnits, Packed, pack};
pub use tile::Tile;
pub use validate::validate;
