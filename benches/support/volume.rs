//! The uniform volume: spheres that do not overlap, with centres uniform in a cube, 5 % of
//! which they fill.

#![allow(dead_code, reason = "each user has some of it")]
#![allow(clippy::cast_precision_loss, reason = "counts are small")]

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::scene::{Albedo, Camera, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface};
use glam::{DVec3, IVec3};
use std::collections::HashMap;
use std::f64::consts::PI;

/// Share of the cube's volume that the spheres have together.
const FILLED: f64 = 0.05;

/// Radius of each of `count` spheres in the cube [-1, 1]³.
pub fn radius(count: usize) -> f64 {
    (FILLED * 8.0 / (count as f64 * 4.0 / 3.0 * PI)).cbrt()
}

/// Centres uniform in the cube [-1, 1]³, to 32 bits, without those whose sphere would overlap
/// an earlier one: what hardly shows of a sphere is out of the declared range.
pub fn centers(count: usize) -> Vec<DVec3> {
    let coordinate = |bits: u32| f64::from(bits) * (2.0 / f64::from(u32::MAX)) - 1.0;
    let center = |index| {
        let [x, y, z, _] = random_bits(SampleKey { pixel: 0, index }, 0, 5);
        DVec3::new(coordinate(x), coordinate(y), coordinate(z))
    };
    // Cells of two radii: what is nearer than that is in the next cell at most.
    let (least, mut cells) = (2.0 * radius(count), HashMap::<IVec3, Vec<DVec3>>::new());
    let around = || (0..27).map(|i| IVec3::new(i % 3, i / 3 % 3, i / 9) - 1);
    let stays = |center: &DVec3| {
        let cell = (center / least).floor().as_ivec3();
        let mut near = around().filter_map(|offset| cells.get(&(cell + offset))).flatten();
        let is_free = near.all(|other| other.distance(*center) > least);
        if is_free {
            cells.entry(cell).or_default().push(*center);
        }
        is_free
    };
    (0..).map(center).filter(stays).take(count).collect()
}

/// A direction uniform on the sphere, from numbers of their own.
pub fn direction(index: u64, block: u32) -> DVec3 {
    let [z, turn, ..] = random_bits(SampleKey { pixel: 1, index }, block, 5).map(unit_float);
    let (z, (y, x)) = (2.0 * z - 1.0, (2.0 * PI * turn).sin_cos());
    let sine = (1.0 - z * z).sqrt();
    DVec3::new(sine * x, sine * y, z)
}

/// `count` diffuse spheres, albedo ½, inside a sky of radiance 1, seen from outside the cube.
pub fn scene(count: usize, size: ImageSize) -> Scene {
    let grey = Surface::Diffuse(Albedo::new(DVec3::splat(0.5)).expect("an albedo"));
    let sky = Surface::Emitter(Radiance::new(DVec3::ONE).expect("a radiance"));
    let radius = radius(count);
    let mut spheres: Vec<Sphere> = centers(count)
        .into_iter()
        .map(|center| Sphere::new(center, radius, grey).expect("a sphere"))
        .collect();
    spheres.push(Sphere::new(DVec3::ZERO, 8.0, sky).expect("a sky"));
    let camera = Camera::new(DVec3::new(1.5, 1.2, 3.5), DVec3::ZERO, DVec3::Y, 40.0);
    Scene::new(camera.expect("a camera"), size, RenderSettings::default(), spheres)
}
