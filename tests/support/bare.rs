//! Packed scenes made by hand: what single functions of the kernel read, and nothing else.

#![allow(dead_code, reason = "each test uses some of it")]

use candor::kernel::{Packed, layout};

/// A header and these spheres.
pub fn bare(scene: layout::Scene, spheres: Vec<layout::Sphere>) -> Packed {
    Packed { scene, spheres, ..Packed::default() }
}

/// A scene of zeros.
pub fn nothing() -> Packed {
    Packed::default()
}
