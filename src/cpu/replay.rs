//! Traces one sample again and records what its path does, as `shaders/replay.wgsl` does.

use super::connected::{LightVertex, connection};
use super::nearest::nearest;
use super::rng::SampleKey;
use super::scene::PreparedScene;
use super::trace::{Path, connects, surface_point};
use super::{blind, connected};
use crate::trail::{Ending, Segment, Trail, Vertex};
use glam::DVec3;

/// The path of one sample.
#[must_use]
pub fn replay(scene: &PreparedScene, key: SampleKey) -> Trail {
    let advance = if connects(scene) { connected::advance } else { blind::advance };
    let mut path = Path::start(scene, key);
    let mut segments = Vec::new();
    let mut bounce = 0;
    loop {
        let mut segment = ahead(scene, key, &path, bounce);
        let goes_on = advance(&mut path, scene, key, bounce);
        segment.weight = path.throughput;
        segment.radiance = path.radiance;
        segments.push(segment);
        if !goes_on {
            let ending = ending(scene, segment.vertex, bounce);
            return Trail::ended(segments, ending, path.radiance.as_vec3().to_array());
        }
        bounce += 1;
    }
}

/// What a path is about to meet and to sample; what that brings is still open.
fn ahead(scene: &PreparedScene, key: SampleKey, path: &Path, bounce: u32) -> Segment {
    let hit = nearest(scene, &path.ray, path.leaving);
    let met = hit.map(|hit| (hit, surface_point(&path.ray, hit, &scene.spheres[hit.sphere])));
    let connection = met.filter(|_| connects(scene)).and_then(|(hit, point)| {
        let incoming = path.ray.direction;
        connection(scene, key, &LightVertex { point, incoming, sphere: hit.sphere, bounce })
    });
    Segment {
        origin: path.ray.origin,
        direction: path.ray.direction,
        vertex: met.map(|(hit, point)| Vertex {
            sphere: hit.sphere,
            distance: hit.distance,
            position: point.position,
            normal: point.normal,
        }),
        connection,
        weight: DVec3::ONE,
        radiance: DVec3::ZERO,
    }
}

fn ending(scene: &PreparedScene, last: Option<Vertex>, bounce: u32) -> Ending {
    let surface = last.map(|vertex| scene.spheres[vertex.sphere].surface);
    Ending::at(surface, bounce, scene.bounces, scene.estimator)
}
