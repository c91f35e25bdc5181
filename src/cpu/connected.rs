//! One path that samples a light where it scatters, as in `shaders/path_connected.wgsl`
//! with `strategy_explicit.wgsl` or `strategy_mis.wgsl`. A connection uses up one
//! scattering.

use super::light::{cone_of, light_distance};
use super::material::{evaluate_diffuse, evaluate_glossy};
use super::nearest::{nearest, occluded};
use super::pick::{chance_of, pick_light};
use super::rng::{SampleKey, random_bits, unit_float, unit_floats};
use super::sampling::{around, polar_cone};
use super::scene::PreparedScene;
use super::sphere::Ray;
use super::trace::{SurfacePoint, scatter, surface_point};
use crate::scene::{Estimator, Surface};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// How a path left its last vertex.
struct Departure {
    point: SurfacePoint,
    /// Density of the direction, per steradian.
    density: f64,
    /// Whether nothing but this direction could find the light that it hits.
    alone: bool,
}

/// Where and how a light is to be sampled.
struct Vertex {
    point: SurfacePoint,
    incoming: DVec3,
    sphere: usize,
    bounce: u32,
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

/// What one sampled light sends over a vertex, per unit of albedo.
fn connect(scene: &PreparedScene, key: SampleKey, vertex: &Vertex, u: DVec2) -> DVec3 {
    let (point, surface) = (&vertex.point, scene.spheres[vertex.sphere].surface);
    let pick = pick_light(scene, point, key, vertex.bounce);
    let light = &scene.spheres[pick.light];
    let cone = cone_of(light, point);
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
    if share == 0.0 || occluded(scene, &ray, vertex.sphere, pick.light, light_distance(light, &ray))
    {
        return DVec3::ZERO;
    }
    match light.surface {
        Surface::Emitter(radiance) => share * radiance.rgb(),
        _ => DVec3::ZERO,
    }
}

/// Follows the path that starts with `ray`.
pub(super) fn trace(scene: &PreparedScene, key: SampleKey, mut ray: Ray) -> DVec3 {
    let (mut radiance, mut throughput) = (DVec3::ZERO, DVec3::ONE);
    let mut leaving = None;
    let eye = SurfacePoint { position: ray.origin, normal: ray.direction };
    let mut departure = Departure { point: eye, density: 0.0, alone: true };
    for bounce in 0..=scene.bounces {
        let Some(hit) = nearest(scene, &ray, leaving) else { break };
        let sphere = &scene.spheres[hit.sphere];
        if let Surface::Emitter(emitted) = sphere.surface {
            radiance += throughput * share_of_hit(scene, hit.sphere, &departure) * emitted.rgb();
            break;
        }
        if bounce == scene.bounces {
            break;
        }
        let point = surface_point(&ray, hit, sphere);
        let bits = random_bits(key, bounce + 1, scene.seed);
        let (albedo, scattering) = scatter(
            scene.estimator,
            sphere.surface,
            point.normal,
            ray.direction,
            unit_floats(bits),
        );
        throughput *= albedo.rgb();
        let samples_light = samples_light_at(scene.estimator, sphere.surface);
        if samples_light {
            let u = DVec2::new(unit_float(bits[2]), unit_float(bits[3]));
            let vertex = Vertex { point, incoming: ray.direction, sphere: hit.sphere, bounce };
            radiance += throughput * connect(scene, key, &vertex, u);
        }
        if scattering.weight == 0.0 {
            break;
        }
        throughput *= scattering.weight;
        departure = Departure { point, density: scattering.density, alone: !samples_light };
        ray = Ray { origin: point.position, direction: scattering.direction };
        leaving = Some(hit.sphere);
    }
    radiance
}
