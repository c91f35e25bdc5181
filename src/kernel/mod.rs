//! The kernel: WGSL composed for one scene, and the scene packed for it.

mod compose;
pub mod layout;
mod pack;
mod unrolled;

pub use compose::{Kernel, Lights, Nearest, Tile, UNROLLED_SPHERES, probe_source, validate};
pub use layout::SPHERE_CAPACITY;
pub use pack::{Form, KernelUnits, Packed, TooManySpheres, check_count, pack};
