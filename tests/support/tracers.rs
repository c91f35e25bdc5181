//! Tracers of a scene: on the device, on the device with a kernel that is wrong on
//! purpose, and the twin.

#![allow(dead_code, reason = "each test uses some of them")]

use super::{gpu, scenes::packed};
use candor::cpu::CpuTracer;
use candor::effects::Effects;
use candor::film::Film;
use candor::gpu::GpuTracer;
use candor::kernel::Kernel;
use candor::scene::Scene;
use candor::tracer::{Ledger, Tracer};
use candor::viewpoint::Viewpoint;
use std::ops::Range;

pub fn on_device(scene: &Scene) -> GpuTracer {
    GpuTracer::new(scene, gpu::open()).expect("the device takes the scene")
}

pub fn twin(scene: &Scene) -> CpuTracer {
    CpuTracer::new(scene, None).expect("threads")
}

/// The text of the kernel that the scene calls for.
pub fn kernel(scene: &Scene) -> String {
    let effects = Effects::of(scene, &Viewpoint::of(scene));
    Kernel::of(scene, effects, &packed(scene)).wgsl()
}

/// A tracer whose kernel simulates these effects, with the spheres where it looks for them.
pub fn with_effects(scene: &Scene, effects: Effects) -> GpuTracer {
    GpuTracer::with_effects(scene, gpu::open(), effects).expect("the device takes the scene")
}

/// A tracer with another kernel.
pub fn with_kernel(scene: &Scene, wgsl: &str) -> GpuTracer {
    GpuTracer::with_kernel(scene, gpu::open(), &packed(scene), wgsl)
        .expect("the device takes the kernel")
}

/// A tracer whose kernel has `to` in place of `from`, which must be there once.
///
/// # Panics
/// If it is not.
pub fn mutant(scene: &Scene, from: &str, to: &str) -> GpuTracer {
    let kernel = kernel(scene);
    assert_eq!(kernel.matches(from).count(), 1, "occurrences of {from:?} in the kernel");
    with_kernel(scene, &kernel.replace(from, to))
}

/// What a tracer makes of the samples.
pub fn trace(tracer: &mut dyn Tracer, ranges: &[Range<u64>]) -> (Film, Ledger) {
    for range in ranges {
        tracer.add_samples(range.clone()).expect("the tracer traces");
    }
    (tracer.film().expect("a film"), tracer.ledger().expect("a ledger"))
}

/// The film of the samples, none of which may be invalid.
pub fn film(tracer: &mut dyn Tracer, ranges: &[Range<u64>]) -> Film {
    let (film, ledger) = trace(tracer, ranges);
    assert_eq!(ledger.count, 0, "{ledger:?}");
    film
}
