//! What rays look at on their way through a hierarchy, counted on the device: a kernel that
//! says so in place of radiance, so that the picture's mean counts it.

use candor::film::{Film, sums};
use candor::gpu::GpuTracer;
use candor::tracer::Tracer;

/// What replaces what in a kernel's text.
pub type Change = (&'static str, &'static str);

/// The radiance that stands for one thing counted, so that the bound on a sample holds.
const UNIT: f64 = 1.0 / (1 << 16) as f64;

/// Samples of each pixel that are counted.
const SPP: u64 = 4;

const COUNTING: [Change; 5] = [
    (
        "var<private> waiting: array<u32, STACK>;\n",
        "var<private> waiting: array<u32, STACK>;\nvar<private> seen: vec3<f32>;\n",
    ),
    (
        "fn nearest(ray: Ray, leaving: u32) -> Hit {\n",
        "fn nearest(ray: Ray, leaving: u32) -> Hit {\n    seen.x += 1.0;\n",
    ),
    ("    let node = nodes[place];\n", "    let node = nodes[place];\n    seen.y += 1.0;\n"),
    (
        "            best = nearest_of(way.item, best, ray, leaving);\n",
        "            best = nearest_of(way.item, best, ray, leaving);
            seen.z += f32(way.item & 15u);\n",
    ),
    (
        "    return Sample(path.radiance, path.finished);\n",
        "    return Sample(seen * 1.52587890625e-5, path.finished);\n",
    ),
];

/// The text with something else in these places.
///
/// # Panics
/// If the text does not say each of them exactly once.
pub fn changed(wgsl: &str, changes: &[Change]) -> String {
    changes.iter().fold(wgsl.to_owned(), |text, (from, to)| {
        assert_eq!(text.matches(from).count(), 1, "the kernel says once:\n{from}");
        text.replace(from, to)
    })
}

/// Means over samples.
#[derive(Debug, Clone, Copy)]
pub struct Counted {
    /// Rays of one path.
    pub segments: f64,
    /// Nodes of the hierarchy, with four boxes each, that one of its rays looks at.
    pub nodes: f64,
    /// Spheres under the hierarchy that one of them is tested with.
    pub spheres: f64,
}

/// Counts with what makes a tracer of a kernel's text, that of one with a hierarchy.
pub fn counted(wgsl: &str, tracer: impl FnOnce(&str) -> GpuTracer) -> Counted {
    let mut tracer = tracer(&changed(wgsl, &COUNTING));
    tracer.add_samples(0..SPP).expect("samples");
    assert_eq!(tracer.ledger().expect("a ledger").count, 0, "samples that count");
    let [segments, nodes, spheres] = means(&tracer.film().expect("a film"));
    Counted { segments, nodes: nodes / segments, spheres: spheres / segments }
}

/// The mean over the picture of each channel, in things counted.
fn means(film: &Film) -> [f64; 3] {
    let step = film.scale().step() / (UNIT * film.pixels().len() as f64 * SPP as f64);
    let total = |channel: usize| -> u128 { film.pixels().iter().map(|p| sums(p)[channel]).sum() };
    [0, 1, 2].map(|channel| total(channel) as f64 * step)
}
