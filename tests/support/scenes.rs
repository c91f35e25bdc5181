//! Scenes that several tests trace.

#![allow(dead_code, reason = "each test uses some of them")]

use candor::kernel::{Packed, pack};
use candor::scene::{
    Albedo, Camera, Exponent, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface, load,
};
use candor::viewpoint::Viewpoint;
use glam::DVec3;
use std::path::Path;

pub fn size(width: u32, height: u32) -> ImageSize {
    ImageSize::new(width, height).expect("a size")
}

pub fn diffuse(rho: f64) -> Surface {
    Surface::Diffuse(Albedo::new(DVec3::splat(rho)).expect("an albedo"))
}

pub fn glossy(rho: f64, exponent: f64) -> Surface {
    let exponent = Exponent::new(exponent).expect("an exponent");
    Surface::Glossy(Albedo::new(DVec3::splat(rho)).expect("an albedo"), exponent)
}

pub fn emitter(rgb: impl Into<DVec3>) -> Surface {
    Surface::Emitter(Radiance::new(rgb.into()).expect("a radiance"))
}

pub fn sphere(center: impl Into<DVec3>, radius: f64, surface: Surface) -> Sphere {
    Sphere::new(center.into(), radius, surface).expect("a sphere")
}

/// Looks from `position` to `target` with a field of view of 50 degrees.
pub fn seen(
    position: impl Into<DVec3>,
    target: impl Into<DVec3>,
    size: ImageSize,
    bounces: u32,
    spheres: Vec<Sphere>,
) -> Scene {
    let camera = Camera::new(position.into(), target.into(), DVec3::Y, 50.0).expect("a camera");
    let settings = RenderSettings::default().with_bounces(bounces).expect("a few bounces");
    Scene::new(camera, size, settings, spheres)
}

/// The classic scene.
pub fn classic(size: ImageSize) -> Scene {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml");
    load(&path).expect("a valid scene").with_size(size)
}

pub fn with_seed(scene: &Scene, seed: u32) -> Scene {
    scene.clone().with_settings(scene.settings().with_seed(seed))
}

/// Six walls of radius `radius`, three away from the origin, with a lamp in the middle
/// or without anything.
pub fn room(radius: f64, lamp: bool) -> Scene {
    let axes = DVec3::AXES.into_iter().flat_map(|axis| [axis, -axis]);
    let mut spheres: Vec<Sphere> =
        axes.map(|axis| sphere((radius + 3.0) * axis, radius, diffuse(0.5))).collect();
    if lamp {
        spheres.push(sphere(DVec3::ZERO, 0.25, emitter([10.0; 3])));
    }
    seen([1.0, 0.5, 0.25], [2.0, 1.0, 0.0], size(8, 8), 2, spheres)
}

/// A lamp, a row of small spheres of all kinds and a floor: more of them than get
/// straight-line code.
pub fn many(size: ImageSize) -> Scene {
    let mut spheres = vec![
        sphere([0.0, 6.0, 0.0], 1.5, emitter([9.0, 8.0, 7.0])),
        sphere([0.0, -1e4, 0.0], 1e4, diffuse(0.6)),
    ];
    for i in 0..36_u32 {
        let (column, row) = (f64::from(i % 6), f64::from(i / 6));
        let center = [1.3 * column - 3.25, 0.5, 1.3 * row - 3.25];
        let surface = if i % 3 == 0 { glossy(0.8, f64::from(i * i)) } else { diffuse(0.7) };
        spheres.push(sphere(center, 0.5, surface));
    }
    seen([0.0, 4.0, 11.0], [0.0, 0.5, 0.0], size, 2, spheres)
}

pub fn packed(scene: &Scene) -> Packed {
    let scale = candor::bound::sample_scale(scene);
    let viewpoint = Viewpoint::of(scene);
    pack(scene, &viewpoint, candor::effects::Effects::of(scene, &viewpoint), scale)
}
