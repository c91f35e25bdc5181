//! Arrangements of spheres that a hierarchy could get wrong.

use super::scenes::{diffuse, emitter, seen, size, sphere};
use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::scene::{Scene, Sphere};
use glam::DVec3;

fn draw(index: u32, block: u32) -> DVec3 {
    let key = SampleKey { pixel: 12, index: u64::from(index) };
    let [x, y, z, _] = random_bits(key, block, 1).map(unit_float);
    DVec3::new(x, y, z)
}

/// In [-1, 1]³.
fn anywhere(index: u32, block: u32) -> DVec3 {
    2.0 * draw(index, block) - DVec3::ONE
}

fn grey(center: DVec3, radius: f64) -> Sphere {
    sphere(center, radius, diffuse(0.5))
}

fn balls(count: u32, ball: impl Fn(u32) -> (DVec3, f64)) -> Vec<Sphere> {
    (0..count).map(ball).map(|(center, radius)| grey(center, radius)).collect()
}

/// Ten a side, each touching six others, with coordinates that `f32` holds.
fn lattice() -> Vec<Sphere> {
    let at = |i: u32| f64::from(i) / 8.0;
    balls(1000, |i| (DVec3::new(at(i % 10), at(i / 10 % 10), at(i / 100)), 1.0 / 16.0))
}

/// Small ones, each in shells of growing radii that also hold their neighbours.
fn shells() -> Vec<Sphere> {
    balls(400, |i| {
        (0.6 * anywhere(i / 8, 1), 0.01 * 1.7_f64.powi(i32::try_from(i % 8).unwrap_or(0)))
    })
}

/// All of them touch in one point, from both sides, which rays along an axis meet at one
/// distance.
fn touching_in_one_point() -> Vec<Sphere> {
    balls(200, |i| {
        let radius = 0.25 + f64::from(i / 2) / 128.0;
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        (DVec3::new(0.0, 0.0, side * radius), radius)
    })
}

/// Groups in one place but for less than `f32` tells.
fn coincident() -> Vec<Sphere> {
    balls(400, |i| (0.8 * anywhere(i % 20, 2) + 1e-11 * anywhere(i, 3), 0.1 - 1e-12 * f64::from(i)))
}

/// Radii over twelve decades.
fn decades() -> Vec<Sphere> {
    balls(600, |i| (anywhere(i, 4), 0.5 * 10_f64.powf(-12.0 * draw(i, 5).x)))
}

/// Two crowds of specks at the ends of the scene.
fn clusters() -> Vec<Sphere> {
    balls(500, |i| {
        let side = if i % 2 == 0 { 1.0 } else { -1.0 };
        (DVec3::new(side, 0.5 * side, 0.0) + 1e-3 * anywhere(i, 6), 2e-5)
    })
}

/// Dust on a huge floor and on a ball.
fn dust() -> Vec<Sphere> {
    let mut spheres =
        vec![grey(DVec3::new(0.0, -1e4, 0.0), 1e4), grey(DVec3::new(0.0, 0.5, 0.0), 0.5)];
    spheres.extend(balls(400, |i| {
        let place = anywhere(i, 7);
        let on_ball = DVec3::new(0.0, 0.5, 0.0) + 0.501 * place.normalize();
        (if i % 2 == 0 { on_ball } else { DVec3::new(place.x, 1e-3, place.z) }, 1e-3)
    }));
    spheres
}

fn in_one_plane() -> Vec<Sphere> {
    balls(400, |i| {
        (DVec3::new(f64::from(i % 20) / 8.0 - 1.0, 0.0, f64::from(i / 20) / 8.0 - 1.0), 0.05)
    })
}

fn on_one_line() -> Vec<Sphere> {
    balls(400, |i| (DVec3::new(f64::from(i) / 128.0 - 1.5, 0.25, -0.125), 1.0 / 256.0))
}

/// One in the other, with one centre.
fn onion() -> Vec<Sphere> {
    balls(300, |i| (DVec3::new(0.1, 0.2, -0.3), 0.01 + f64::from(i) / 256.0))
}

/// Each larger and farther than the one before, which makes a hierarchy as deep as it gets.
fn chain() -> Vec<Sphere> {
    balls(100, |i| {
        let far = 1.35_f64.powi(i32::try_from(i).unwrap_or(0) - 99);
        (DVec3::new(3.0 * far - 1.0, 0.0, 0.0), 0.4 * far)
    })
}

/// In two of them is the camera, and a lamp is among them.
fn around_the_camera() -> Vec<Sphere> {
    let mut spheres = balls(200, |i| (anywhere(i, 8), 0.05));
    spheres.push(grey(DVec3::new(0.0, 0.0, 1.0), 5.5));
    spheres.push(sphere([0.0, 0.0, 0.0], 9.0, emitter([1.0; 3])));
    spheres.extend(balls(200, |i| (3.0 * anywhere(i, 9), 0.1)));
    spheres.push(sphere([0.0, 2.5, 0.0], 0.5, emitter([1.0; 3])));
    spheres
}

/// All of them, with their names.
pub fn all() -> Vec<(&'static str, Scene)> {
    let scene = |spheres| seen([0.3, 0.4, 6.0], DVec3::ZERO, size(8, 8), 2, spheres);
    let arrangements = [
        ("lattice", lattice()),
        ("shells", shells()),
        ("touching in one point", touching_in_one_point()),
        ("coincident", coincident()),
        ("decades", decades()),
        ("clusters", clusters()),
        ("dust", dust()),
        ("in one plane", in_one_plane()),
        ("on one line", on_one_line()),
        ("onion", onion()),
        ("chain", chain()),
        ("around the camera", around_the_camera()),
    ];
    arrangements.map(|(name, spheres)| (name, scene(spheres))).into()
}
