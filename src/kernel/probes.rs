//! The text of the probe, which runs single functions of the kernel for the tests.

use super::compose::Kernel;
use super::text::fragment;
use crate::effects::{Effect, Effects};
use crate::scene::{Estimator, ImageSize};

/// The WGSL of the probe: entry points that run single functions of the kernel over a
/// table of inputs, for the tests.
#[must_use]
pub fn probe_source() -> String {
    probe(false, 0)
}

/// The same with a hierarchy in which up to `stack` items wait; spheres and lights are then in
/// storage buffers.
#[must_use]
pub fn hierarchy_probe_source(stack: u32) -> String {
    probe(true, stack)
}

fn probe(hierarchy: bool, stack: u32) -> String {
    let effects = if hierarchy { Effects::ALL } else { Effects::ALL.without(Effect::Hierarchy) };
    let mut text = Kernel {
        size: ImageSize::new(512, 512).expect("a picture"),
        bounces: 2,
        estimator: Estimator::Mis,
        effects,
        written: None,
        stored: hierarchy,
        light: 0,
        stack,
    }
    .path();
    text.add(fragment!("multiply")).add(fragment!("film")).add(fragment!("probe"));
    if hierarchy {
        text.add(fragment!("probe_hierarchy"));
    }
    text.into_wgsl()
}
