//! Searches on the device by loops over all spheres, beside those of the kernel.

use super::rays::{MISS, Ray};
use candor::gpu::Gpu;
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, layout};
use glam::Vec3;

/// Entry points that go through the spheres at places a..b one by one, whatever holds them: the
/// first row is (a, b, -, -), the others are as for those of the probe. And the probe's search
/// without what comes after it.
pub const LOOPS: &str = "
fn plain_distance(ray: Ray, i: u32, leaving: u32) -> f32 {
    let s = spheres[i];
    if i < scene.factored_count {
        return distance_to(factored(ray, s.position, s.size), i, leaving);
    }
    return distance_to(anchored(ray, s.position, s.offset, s.size), i, leaving);
}

fn ray_of(at: u32) -> Ray {
    return Ray(input_floats(at).xyz, input_floats(at + 1u).xyz);
}

@compute @workgroup_size(64)
fn search(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let hit = nearest(ray_of(2u * id.x + 1u), inputs[2u * id.x + 2u].w);
    outputs[id.x] = vec4<u32>(bitcast<u32>(hit.distance), hit.sphere, 0u, 0u);
}

@compute @workgroup_size(64)
fn loop_nearest(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let ray = ray_of(2u * id.x + 1u);
    let leaving = inputs[2u * id.x + 2u].w;
    var best = Hit(MISS, NO_SPHERE);
    var i = inputs[0].x;
    for (; i < inputs[0].y; i++) {
        let t = plain_distance(ray, i, leaving);
        if t < best.distance || (t == best.distance && t < MISS
            && spheres[i].index < spheres[best.sphere].index) {
            best = Hit(t, i);
        }
    }
    outputs[id.x] = vec4<u32>(bitcast<u32>(best.distance), best.sphere, i, 0u);
}

@compute @workgroup_size(64)
fn loop_occluded(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&outputs) { return; }
    let at = 3u * id.x + 1u;
    let ray = ray_of(at);
    let leaving = inputs[at + 1u].w;
    let light = inputs[at + 2u].x;
    let distance = input_floats(at).w;
    var hidden = false;
    var i = inputs[0].x;
    for (; i < inputs[0].y; i++) {
        let t = plain_distance(ray, i, leaving);
        let earlier = spheres[i].index < spheres[light].index;
        hidden = hidden || (i != light && (t < distance || (t == distance && earlier)));
    }
    outputs[id.x] = vec4<u32>(u32(hidden), i, 0u, 0u);
}
";

/// Spheres that one run goes through: lavapipe leaves loops after 65,535 iterations.
const PIECE: usize = 60_000;

/// A distance's bits and the place of the sphere there.
pub type Hit = (u32, u32);

/// A probe with those entry points.
pub struct Device<'a> {
    probe: Probe<'a>,
    packed: &'a Packed,
}

impl<'a> Device<'a> {
    pub fn new(gpu: &'a Gpu, packed: &'a Packed, text: String) -> Self {
        let probe = Probe::with_source(gpu, packed, text).expect("the probe compiles");
        Self { probe, packed }
    }

    fn run(&self, entry: &str, first: Row, rows: &[Row], results: usize) -> Vec<Row> {
        let rows = [&[first], rows].concat();
        self.probe.run(entry, &rows, results).expect("the device runs")
    }

    /// By the kernel's search.
    pub fn nearest(&self, rays: &[Ray]) -> Vec<Hit> {
        let found = self.run("search", [0; 4], &rows_of(rays), rays.len());
        found.into_iter().map(|row| (row[0], row[1])).collect()
    }

    /// All places, piece by piece.
    fn pieces(&self) -> impl Iterator<Item = [u32; 2]> {
        let count = self.packed.spheres.len();
        (0..count).step_by(PIECE).map(move |from| [from, (from + PIECE).min(count)].map(word))
    }

    /// By a loop.
    pub fn loop_nearest(&self, rays: &[Ray]) -> Vec<Hit> {
        let mut best = vec![(MISS.to_bits(), layout::NO_SPHERE); rays.len()];
        let index = |place: u32| self.packed.spheres.get(place as usize).map(|s| s.index);
        for [from, to] in self.pieces() {
            let found = self.run("loop_nearest", [from, to, 0, 0], &rows_of(rays), rays.len());
            for (best, row) in best.iter_mut().zip(found) {
                assert_eq!(row[2], to, "a loop was cut short");
                let ties = row[0] == best.0 && index(row[1]) < index(best.1);
                // Bits of distances, none of which is negative, are in their order.
                if row[0] < best.0 || (ties && row[1] != layout::NO_SPHERE) {
                    *best = (row[0], row[1]);
                }
            }
        }
        best
    }

    /// By the kernel's search: whether something hides the light, of each (ray, light, distance).
    pub fn occluded(&self, shadows: &[Shadow]) -> Vec<bool> {
        let found = self.probe.run("probe_occluded", &shadow_rows(shadows), shadows.len());
        let found = found.expect("the device runs");
        assert!(found.iter().all(|row| row[1] == 0), "a search was cut short");
        found.into_iter().map(|row| row[0] == 1).collect()
    }

    /// The same by a loop.
    pub fn loop_occluded(&self, shadows: &[Shadow]) -> Vec<bool> {
        let mut hidden = vec![false; shadows.len()];
        for [from, to] in self.pieces() {
            let rows = shadow_rows(shadows);
            let found = self.run("loop_occluded", [from, to, 0, 0], &rows, shadows.len());
            for (hidden, row) in hidden.iter_mut().zip(found) {
                assert_eq!(row[1], to, "a loop was cut short");
                *hidden |= row[0] == 1;
            }
        }
        hidden
    }
}

/// A ray to a light, and how far that is.
pub type Shadow = (Ray, u32, f32);

pub fn word(count: usize) -> u32 {
    u32::try_from(count).expect("few")
}

fn row(v: Vec3, w: u32) -> Row {
    [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), w]
}

fn rows_of(rays: &[Ray]) -> Vec<Row> {
    rays.iter().flat_map(|ray| [row(ray.origin, 0), row(ray.direction, ray.leaving)]).collect()
}

fn shadow_rows(shadows: &[Shadow]) -> Vec<Row> {
    let rows = |&(ray, light, distance): &Shadow| {
        [row(ray.origin, distance.to_bits()), row(ray.direction, ray.leaving), [light, 0, 0, 0]]
    };
    shadows.iter().flat_map(rows).collect()
}
