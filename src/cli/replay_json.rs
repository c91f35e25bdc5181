//! Two paths as one JSON object.

use super::replay::Replayed;
use super::replay_table::{before, kind};
use crate::replay::{Cause, Parting};
use crate::scene::Scene;
use crate::tracer::InvalidReason;
use crate::trail::{Connection, Ending, Segment, Trail, Vertex};
use glam::DVec3;
use serde::Serialize;

/// The `--json` object. Numbers that JSON cannot write are null.
#[derive(Serialize)]
struct Json<'a> {
    scene: &'a str,
    pixel: [u32; 2],
    sample: u64,
    estimator: &'a str,
    bounces: u32,
    seed: u32,
    width: u32,
    height: u32,
    bound: f32,
    device: Option<&'a str>,
    driver: Option<&'a str>,
    device_path: Option<JsonPath<'a>>,
    twin_path: JsonPath<'a>,
    parting: Option<JsonParting>,
}

#[derive(Serialize)]
struct JsonPath<'a> {
    segments: Vec<JsonSegment<'a>>,
    ending: &'static str,
    radiance: [f32; 3],
    /// Why the sample is invalid.
    invalid: Option<&'static str>,
}

#[derive(Serialize)]
struct JsonSegment<'a> {
    origin: [f64; 3],
    direction: [f64; 3],
    vertex: Option<JsonVertex<'a>>,
    light: Option<JsonLight<'a>>,
    weight: [f64; 3],
    radiance: [f64; 3],
}

#[derive(Serialize)]
struct JsonVertex<'a> {
    /// Counted from 1, as in the table.
    sphere: usize,
    name: Option<&'a str>,
    kind: &'static str,
    distance: f64,
    position: [f64; 3],
    normal: [f64; 3],
}

#[derive(Serialize)]
struct JsonLight<'a> {
    sphere: usize,
    name: Option<&'a str>,
    visible: bool,
    brings: [f64; 3],
}

#[derive(Serialize)]
struct JsonParting {
    vertex: usize,
    cause: &'static str,
}

pub(super) fn json(replayed: &Replayed) -> String {
    let (scene, settings) = (&replayed.scene, replayed.scene.settings());
    let device = replayed.device.as_ref();
    let path = |trail| path(scene, trail, replayed.bound);
    let json = Json {
        scene: &replayed.file,
        pixel: replayed.pixel.into(),
        sample: replayed.sample,
        estimator: settings.estimator().name(),
        bounces: settings.bounces(),
        seed: settings.seed(),
        width: scene.size().width(),
        height: scene.size().height(),
        bound: replayed.bound,
        device: device.map(|(found, _)| found.device.as_str()),
        driver: device.map(|(found, _)| found.driver.as_str()),
        device_path: device.map(|(_, trail)| path(trail)),
        twin_path: path(&replayed.twin),
        parting: replayed
            .parting
            .map(|Parting { vertex, cause }| JsonParting { vertex, cause: cause_name(cause) }),
    };
    serde_json::to_string(&json).expect("plain values serialize")
}

fn path<'a>(scene: &'a Scene, trail: &Trail, bound: f32) -> JsonPath<'a> {
    let segments = trail.segments.iter().enumerate();
    JsonPath {
        segments: segments.map(|(i, s)| segment(scene, s, before(trail, i))).collect(),
        ending: ending_name(trail.ending),
        radiance: trail.radiance,
        invalid: trail.invalid(bound).map(InvalidReason::name),
    }
}

fn segment<'a>(scene: &'a Scene, segment: &Segment, before: DVec3) -> JsonSegment<'a> {
    let brings = (segment.radiance - before).to_array();
    JsonSegment {
        origin: segment.origin.to_array(),
        direction: segment.direction.to_array(),
        vertex: segment.vertex.map(|found| vertex(scene, &found)),
        light: segment.connection.map(|found| light(scene, found, brings)),
        weight: segment.weight.to_array(),
        radiance: segment.radiance.to_array(),
    }
}

fn vertex<'a>(scene: &'a Scene, vertex: &Vertex) -> JsonVertex<'a> {
    let sphere = &scene.spheres()[vertex.sphere];
    JsonVertex {
        sphere: sphere.ordinal(),
        name: sphere.name(),
        kind: kind(sphere.surface()),
        distance: vertex.distance,
        position: vertex.position.to_array(),
        normal: vertex.normal.to_array(),
    }
}

fn light(scene: &Scene, found: Connection, brings: [f64; 3]) -> JsonLight<'_> {
    JsonLight {
        sphere: scene.spheres()[found.light].ordinal(),
        name: scene.spheres()[found.light].name(),
        visible: found.visible,
        brings,
    }
}

fn ending_name(ending: Ending) -> &'static str {
    match ending {
        Ending::Light => "light",
        Ending::Escaped => "escaped",
        Ending::Limit => "limit",
        Ending::Absorbed => "absorbed",
        Ending::Unfinished => "unfinished",
    }
}

fn cause_name(cause: Cause) -> &'static str {
    match cause {
        Cause::Sphere => "sphere",
        Cause::Position => "position",
        Cause::Normal => "normal",
        Cause::Light => "light",
        Cause::Visibility => "visibility",
        Cause::Radiance => "radiance",
        Cause::Weight => "weight",
        Cause::Ending => "ending",
        Cause::Direction => "direction",
    }
}
