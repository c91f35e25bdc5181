//! One path that samples a light where it scatters, as in `shaders/path_connected.wgsl`
//! with `strategy_explicit.wgsl` or `strategy_mis.wgsl`. A connection uses up one
//! scattering.

use super::light::{Cone, cone_of, light_distance};
use super::material::{evaluate_diffuse, evaluate_glossy};
use super::nearest::{nearest, occluded};
use super::pick::{Pick, chance_of, pick_light};
use super::rng::{SampleKey, random_bits, unit_float, unit_floats};
use super::sampling::{around, polar_cone};
use super::scene::PreparedScene;
use super::sphere::Ray;
use super::trace::{Departure, Path, SurfacePoint, scatter, surface_point};
use crate::scene::{Estimator, Surface};
use crate::trail::Connection;
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Where and how a light is to be sampled.
pub(super) struct LightVertex {
    pub(super) point: SurfacePoint,
    pub(super) incoming: DVec3,
    pub(super) sphere: usize,
    pub(super) bounce: u32,
}

fn samples_light_at(estimator: Estimator, surface: Surface) -> bool {
    estimator == Estimator::Mis || matches!(surface, Surface::Diffuse(_))
}

/// Share of a sampled light, from the ratio p/q of the densities of its direction, the
/// BRDF's over the light's: all of it, or the power heuristic's.
fn share_of_sampled(estimator: Estimator, x: f64) -> f64 {
    if estimator == Estimator::Mis { x / (1.0 + x * x) } else { x }
}

/// Share of a light that a path hit by itself.
fn share_of_hit(scene: &PreparedScene, light: usize, departure: &Departure) -> f64 {
    if departure.alone {
        return 1.0;
    }
    if scene.estimator == Estimator::Explicit {
        return 0.0;
    }
    let point = &departure.point;
    let solid_angle = TAU * cone_of(&scene.spheres[light], point).height;
    let x = departure.density * solid_angle / chance_of(scene, light, point);
    x * x / (1.0 + x * x)
}

/// The light that is picked for a vertex, and its cone.
fn aim(scene: &PreparedScene, key: SampleKey, vertex: &LightVertex) -> (Pick, Cone) {
    let pick = pick_light(scene, &vertex.point, key, vertex.bounce);
    let cone = cone_of(&scene.spheres[pick.light], &vertex.point);
    (pick, cone)
}

/// Whether something stands before the light along a ray from a vertex.
fn hidden(scene: &PreparedScene, ray: &Ray, vertex: &LightVertex, light: usize) -> bool {
    let distance = light_distance(&scene.spheres[light], ray);
    occluded(scene, ray, vertex.sphere, light, distance)
}

/// What one sampled light sends over a vertex, per unit of albedo.
fn connect(scene: &PreparedScene, key: SampleKey, vertex: &LightVertex, u: DVec2) -> DVec3 {
    let (point, surface) = (&vertex.point, scene.spheres[vertex.sphere].surface);
    let (pick, cone) = aim(scene, key, vertex);
    let direction = around(cone.axis, polar_cone(u.x, cone.height), u.y);
    let worth = match surface {
        Surface::Glossy(_, exponent) => {
            evaluate_glossy(point.normal, vertex.incoming, direction, exponent.get())
        }
        _ => evaluate_diffuse(point.normal, direction),
    };
    let x = worth.density * TAU * cone.height / pick.chance;
    let share = worth.weight * share_of_sampled(scene.estimator, x);
    let ray = Ray { origin: point.position, direction };
    if share == 0.0 || hidden(scene, &ray, vertex, pick.light) {
        return DVec3::ZERO;
    }
    match scene.spheres[pick.light].surface {
        Surface::Emitter(radiance) => share * radiance.rgb(),
        _ => DVec3::ZERO,
    }
}

/// The last segment of a path can only hit a light, which does not count from here.
fn is_done(scene: &PreparedScene, departure: &Departure, bounce: u32) -> bool {
    scene.estimator == Estimator::Explicit && bounce == scene.bounces && !departure.alone
}

/// Follows one segment, connects and scatters at its end; whether the path goes on.
pub(super) fn advance(path: &mut Path, scene: &PreparedScene, key: SampleKey, bounce: u32) -> bool {
    let Some(hit) = nearest(scene, &path.ray, path.leaving) else { return false };
    let sphere = &scene.spheres[hit.sphere];
    if let Surface::Emitter(emitted) = sphere.surface {
        let share = share_of_hit(scene, hit.sphere, &path.departure);
        path.radiance += path.throughput * share * emitted.rgb();
        return false;
    }
    if bounce == scene.bounces {
        return false;
    }
    let point = surface_point(&path.ray, hit, sphere);
    let incoming = path.ray.direction;
    let bits = random_bits(key, bounce + 1, scene.seed);
    let u = unit_floats(bits);
    let (albedo, scattering) = scatter(scene.estimator, sphere.surface, point.normal, incoming, u);
    let throughput = path.throughput * albedo.rgb();
    let samples_light = samples_light_at(scene.estimator, sphere.surface);
    if samples_light {
        let vertex = LightVertex { point, incoming, sphere: hit.sphere, bounce };
        path.radiance += throughput * connect(scene, key, &vertex, light_numbers(bits));
    }
    let departure = Departure { point, density: scattering.density, alone: !samples_light };
    if scattering.weight == 0.0 || is_done(scene, &departure, bounce + 1) {
        return false;
    }
    path.throughput = throughput * scattering.weight;
    path.departure = departure;
    path.ray = Ray { origin: point.position, direction: scattering.direction };
    path.leaving = Some(hit.sphere);
    true
}

/// The numbers that draw a direction towards a light.
fn light_numbers(bits: [u32; 4]) -> DVec2 {
    DVec2::new(unit_float(bits[2]), unit_float(bits[3]))
}

/// The light that `advance` samples from a vertex, and whether it is seen.
pub(super) fn connection(
    scene: &PreparedScene,
    key: SampleKey,
    vertex: &LightVertex,
) -> Option<Connection> {
    let surface = scene.spheres[vertex.sphere].surface;
    let emits = matches!(surface, Surface::Emitter(_));
    if emits || vertex.bounce == scene.bounces || !samples_light_at(scene.estimator, surface) {
        return None;
    }
    let u = light_numbers(random_bits(key, vertex.bounce + 1, scene.seed));
    let (pick, cone) = aim(scene, key, vertex);
    let direction = around(cone.axis, polar_cone(u.x, cone.height), u.y);
    let ray = Ray { origin: vertex.point.position, direction };
    Some(Connection { light: pick.light, visible: !hidden(scene, &ray, vertex, pick.light) })
}
