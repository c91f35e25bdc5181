//! Rays through the device's search for the nearest sphere.

#![allow(dead_code, reason = "each test uses a part")]

use super::gpu;
use super::hits::{Case, Side};
use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, layout};
use glam::{DVec3, Vec3};

/// The distance of what is not hit.
pub const MISS: f32 = 3.0e38;

#[derive(Debug, Clone, Copy)]
pub struct Ray {
    pub origin: Vec3,
    pub direction: Vec3,
    pub leaving: u32,
}

#[derive(Debug, Clone, Copy)]
pub struct Found {
    pub distance: f32,
    /// Packed.
    pub sphere: u32,
    pub position: Vec3,
    pub normal: Vec3,
}

pub fn trace(scene: &Packed, rays: &[Ray]) -> Vec<Found> {
    let gpu = gpu::open();
    let probe = Probe::new(&gpu, scene).expect("the probe compiles");
    let bits = |v: Vec3| v.to_array().map(f32::to_bits);
    let row = |[x, y, z]: [u32; 3], w| [x, y, z, w];
    let rows: Vec<Row> = rays
        .iter()
        .flat_map(|ray| [row(bits(ray.origin), 0), row(bits(ray.direction), ray.leaving)])
        .collect();
    let vector = |row: Row| Vec3::from_array(std::array::from_fn(|i| f32::from_bits(row[i])));
    let results = probe.run("probe_nearest", &rows, 3 * rays.len()).expect("the device runs");
    let found = |&[hit, position, normal]: &[Row; 3]| Found {
        distance: f32::from_bits(hit[0]),
        sphere: hit[1],
        position: vector(position),
        normal: vector(normal),
    };
    results.as_chunks().0.iter().map(found).collect()
}

/// Numbers and directions of one ray.
pub fn draw(index: usize, block: u32) -> [f64; 4] {
    random_bits(SampleKey { pixel: 1, index: index as u64 }, block, 3).map(unit_float)
}

pub fn on_sphere([z, turn, ..]: [f64; 4]) -> DVec3 {
    let (z, (y, x)) = (2.0 * z - 1.0, (std::f64::consts::TAU * turn).sin_cos());
    let sine = (1.0 - z * z).sqrt();
    DVec3::new(sine * x, sine * y, z)
}

/// The ray against one packed sphere.
pub fn case(scene: &Packed, place: usize, ray: &Ray) -> Case {
    let sphere = &scene.spheres[place];
    Case {
        radius: f64::NAN,
        anchored: place >= scene.scene.factored_count as usize,
        side: Side::Entry,
        origin: ray.origin,
        direction: ray.direction,
        position: Vec3::from_array(sphere.position),
        size: sphere.size,
        offset: sphere.offset,
    }
}

/// Rays from random points around the focus that lie in no sphere.
pub fn rays(scene: &Packed, count: usize) -> Vec<Ray> {
    let ray = |index| {
        let [x, y, z, _] = draw(index, 1);
        let origin = 2.0 * DVec3::new(x, y, z) - 1.0;
        let direction = on_sphere(draw(index, 2));
        Ray { origin: origin.as_vec3(), direction: direction.as_vec3(), leaving: layout::NO_SPHERE }
    };
    let spheres = 0..scene.spheres.len();
    let is_free =
        |ray: &Ray| spheres.clone().all(|place| case(scene, place, ray).exact().0.c > 0.0);
    (0..).map(ray).filter(is_free).take(count).collect()
}

/// Rays that go on where these ended, in directions of `aim` if they lie above the
/// surface, and mirrored by it if not.
pub fn next_rays(found: &[Found], aim: &dyn Fn(Vec3, usize) -> DVec3) -> Vec<Ray> {
    let hits = found.iter().filter(|f| f.sphere != layout::NO_SPHERE).enumerate();
    let ray = |(index, hit): (usize, &Found)| {
        let (normal, aimed) = (hit.normal.as_dvec3(), aim(hit.position, index));
        let up = aimed - 2.0 * aimed.dot(normal).min(0.0) * normal;
        Ray { origin: hit.position, direction: up.as_vec3(), leaving: hit.sphere }
    };
    // Along the surface rounding decides, and nowhere leads no direction.
    let leaves = |ray: &Ray, hit: &Found| ray.direction.as_dvec3().dot(hit.normal.as_dvec3()) > 0.0;
    hits.map(|hit| (ray(hit), hit.1))
        .filter(|(ray, hit)| leaves(ray, hit))
        .map(|pair| pair.0)
        .collect()
}

pub fn anywhere(_: Vec3, index: usize) -> DVec3 {
    on_sphere(draw(index, 3))
}
