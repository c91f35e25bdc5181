//! Packed scenes made by hand: what single functions of the kernel read, and nothing else.

use candor::kernel::{Packed, layout};

/// A header and these spheres.
pub fn bare(scene: layout::Scene, spheres: Vec<layout::Sphere>) -> Packed {
    Packed {
        scene,
        spheres,
        lights: Vec::new(),
        nodes: Vec::new(),
        stack: 0,
        turns: 0,
        light_tree: Vec::new(),
        forms: Vec::new(),
    }
}

/// A scene of zeros.
#[allow(dead_code, reason = "some tests read something of a scene")]
pub fn nothing() -> Packed {
    bare(bytemuck::Zeroable::zeroed(), Vec::new())
}
