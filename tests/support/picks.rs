//! What the device answers when it is asked to pick a light.

use super::gpu;
use candor::bound::sample_scale;
use candor::effects::{Effect, Effects};
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, pack};
use candor::scene::Scene;
use candor::viewpoint::Viewpoint;
use glam::Vec3;

/// The scene with the tree that the probe knows besides the scan, however few its lights are,
/// and without a hierarchy, which it does not know.
pub fn packed(scene: &Scene) -> Packed {
    let viewpoint = Viewpoint::of(scene);
    let effects = Effects::of(scene, &viewpoint).with(Effect::LightTree);
    pack(scene, &viewpoint, effects.without(Effect::Hierarchy), sample_scale(scene))
}

/// A point that asks for a light.
#[derive(Debug, Clone, Copy)]
pub struct Point {
    pub position: Vec3,
    pub normal: Vec3,
}

/// The chance asked for, the light picked and its chance, by a probe of this text.
pub fn ask(packed: &Packed, wgsl: &str, questions: &[(Point, u32)]) -> Vec<(f32, u32, f32)> {
    let gpu = gpu::open();
    let probe = Probe::with_source(&gpu, packed, wgsl.to_owned()).expect("the probe compiles");
    let row = |v: Vec3, w: u32| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), w];
    let rows: Vec<Row> = questions
        .iter()
        .flat_map(|(p, light)| [row(p.position, *light), row(p.normal, 0)])
        .collect();
    let found = probe.run("probe_pick", &rows, questions.len()).expect("the device runs");
    found
        .iter()
        .map(|&[c, light, own, _]| (f32::from_bits(c), light, f32::from_bits(own)))
        .collect()
}
