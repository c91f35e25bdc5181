//! Scenes in which sampling a light is hard: every way to stand to one, and many of them.

#![allow(dead_code, reason = "each test uses some of them")]

use super::scenes::{diffuse, emitter, glossy, seen, size, sphere};
use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::scene::{Albedo, RenderSettings, Scene, Sphere, Surface, parse};
use glam::DVec3;

/// Two by two tiles.
pub const SIDE: u32 = 32;

fn picture(position: [f64; 3], target: [f64; 3], bounces: u32, spheres: Vec<Sphere>) -> Scene {
    seen(position, target, size(SIDE, SIDE), bounces, spheres)
}

fn colored(rgb: [f64; 3]) -> Surface {
    Surface::Diffuse(Albedo::new(rgb.into()).expect("an albedo"))
}

fn floor() -> Sphere {
    sphere([0.0, -1e4, 0.0], 1e4, colored([0.8, 0.6, 0.5]))
}

/// The classic scene with walls of another radius.
pub fn classic_of(wall: f64, bounces: u32) -> Scene {
    let text = include_str!("../../scenes/two-spheres.toml")
        .replace("100003.0", &format!("{:?}", wall + 3.0))
        .replace("100004.0", &format!("{:?}", wall + 4.0))
        .replace("100000.0", &format!("{wall:?}"));
    let settings = RenderSettings::default().with_bounces(bounces).expect("a few bounces");
    let scene = parse("classic", &text).expect("the classic scene");
    scene.with_size(size(SIDE, SIDE)).with_settings(settings)
}

/// Inside a hollow diffuse sphere with two lamps of different colours and a glossy ball.
pub fn hollow(bounces: u32) -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 5.0, diffuse(0.7)),
        sphere([0.0, 2.5, 0.0], 1.2, emitter([6.0, 5.0, 1.0])),
        sphere([2.5, -1.0, -2.0], 0.9, emitter([1.0, 2.0, 8.0])),
        sphere([-1.5, -1.0, -2.0], 1.2, glossy(0.9, 20.0)),
    ];
    picture([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], bounces, spheres)
}

/// In a light that holds everything: balls of both kinds and another light.
pub fn in_light() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 9.0, emitter([1.0, 2.0, 3.0])),
        sphere([-1.5, 0.0, 0.0], 1.4, diffuse(0.9)),
        sphere([1.5, 0.0, 0.0], 1.4, glossy(0.9, 10.0)),
        sphere([0.0, 3.0, 0.0], 1.0, emitter([9.0, 5.0, 2.0])),
        sphere([0.0, -101.4, 0.0], 100.0, colored([0.9, 0.5, 0.7])),
    ];
    picture([0.0, 1.0, 6.0], [0.0, 0.0, 0.0], 3, spheres)
}

/// Glossy surfaces alone, from a uniform lobe to a mirror.
pub fn gloss() -> Scene {
    let mut spheres = vec![
        sphere([0.0, 5.0, 0.0], 2.5, emitter([5.0, 4.0, 3.0])),
        sphere([0.0, -1e5 - 1.0, 0.0], 1e5, glossy(0.8, 2.0)),
    ];
    for (x, n) in [(-4.0, 0.0), (-2.0, 1.0), (0.0, 50.0), (2.0, 1e4), (4.0, 1e8)] {
        spheres.push(sphere([x, 0.0, 0.0], 1.0, glossy(0.95, n)));
    }
    picture([0.0, 2.0, 9.0], [0.0, 0.5, 0.0], 3, spheres)
}

/// Under a sky that is the outside of one huge light, so near that it fills half of every
/// view.
pub fn under_sun(radius: f64) -> Scene {
    let spheres = vec![
        floor(),
        sphere([0.0, radius + 6.0, 0.0], radius, emitter([1.0, 1.5, 2.0])),
        sphere([-1.2, 1.0, 0.0], 1.0, diffuse(0.9)),
        sphere([1.2, 1.0, 0.0], 1.0, glossy(0.9, 30.0)),
    ];
    picture([0.0, 2.0, 7.0], [0.0, 1.0, 0.0], 2, spheres)
}

/// A lamp half sunk into the floor, and one that hangs a thousandth over it.
pub fn at_the_floor() -> Scene {
    let spheres = vec![
        floor(),
        sphere([-1.5, 0.0, 0.0], 1.0, emitter([4.0, 2.0, 1.0])),
        sphere([1.5, 0.801, 0.5], 0.8, emitter([1.0, 2.0, 4.0])),
        sphere([0.0, 0.6, -1.5], 0.6, diffuse(0.8)),
    ];
    picture([0.0, 3.0, 6.0], [0.0, 0.3, 0.0], 2, spheres)
}

/// Lamps that touch one another, and lamps that overlap.
pub fn joined_lights() -> Scene {
    let spheres = vec![
        floor(),
        sphere([-2.5, 2.0, 0.0], 0.7, emitter([8.0, 1.0, 1.0])),
        sphere([-1.1, 2.0, 0.0], 0.7, emitter([1.0, 8.0, 1.0])),
        sphere([1.5, 2.0, 0.0], 0.8, emitter([1.0, 1.0, 8.0])),
        sphere([2.2, 2.2, 0.3], 0.8, emitter([6.0, 5.0, 1.0])),
        sphere([0.0, 0.7, 1.0], 0.7, glossy(0.9, 40.0)),
    ];
    picture([0.0, 3.0, 7.0], [0.0, 1.0, 0.0], 2, spheres)
}

/// Forty lamps whose powers span six decades, and as many balls; the brightest is half sunk
/// into the floor and holds most of its ball.
pub fn forty_lights() -> Scene {
    let mut spheres = vec![floor()];
    for i in 0..40_u32 {
        let (column, row) = (f64::from(i % 8), f64::from(i / 8));
        let place = DVec3::new(1.2 * column - 4.2, 0.0, 1.2 * row - 3.0);
        // Powers out of order: 7 is prime to 40.
        let rank = i * 7 % 40;
        let power = 10_f64.powf(f64::from(rank) * 6.0 / 39.0 - 4.0);
        let height = if rank == 39 { 0.1 } else { 2.0 };
        let tint = DVec3::new(1.0, 0.5 + f64::from(i % 3) / 4.0, 1.5 - f64::from(i % 2));
        spheres.push(sphere(place + height * DVec3::Y, 0.45, emitter(power * tint)));
        let ball = if i % 3 == 0 { glossy(0.8, f64::from(i)) } else { diffuse(0.7) };
        spheres.push(sphere(place + 0.4 * DVec3::Y, 0.35, ball));
    }
    picture([0.0, 4.0, 9.0], [0.0, 0.5, 0.0], 2, spheres)
}

/// A lamp behind a ball that hides it from most of the floor, under a lid.
pub fn hidden_light() -> Scene {
    let spheres = vec![
        floor(),
        sphere([0.0, 3.2, -2.0], 1.0, emitter([9.0, 9.0, 9.0])),
        sphere([0.0, 1.1, -1.2], 1.1, diffuse(0.8)),
        sphere([0.0, 25.5, 0.0], 20.0, colored([0.9, 0.3, 0.3])),
        sphere([1.6, 1.9, -0.7], 0.8, glossy(0.9, 5.0)),
        sphere([-1.9, 1.9, -0.9], 1.0, diffuse(0.6)),
    ];
    picture([0.0, 2.0, 8.0], [0.0, 1.0, 0.0], 2, spheres)
}

/// Lamps in one place but for less than the device's coordinates tell: in a wall, and in one
/// another. The first in the file is the one in front. A third lamp stands alone.
pub fn coincident_lights() -> Scene {
    let (in_front, behind) = (0.6 + 1e-10, 0.6);
    let spheres = vec![
        floor(),
        sphere([-2.0, 2.0, 0.0], in_front, diffuse(0.5)),
        sphere([-2.0, 2.0, 0.0], behind, emitter([9.0, 9.0, 9.0])),
        sphere([0.0, 2.0, 0.0], in_front, emitter([1.0, 2.0, 3.0])),
        sphere([0.0, 2.0, 0.0], behind, emitter([9.0, 5.0, 1.0])),
        sphere([2.0, 2.0, 0.0], 0.6, emitter([2.0, 2.0, 2.0])),
        sphere([0.8, 0.6, 1.0], 0.6, glossy(0.9, 20.0)),
    ];
    picture([0.0, 3.0, 7.0], [0.0, 1.0, 0.0], 2, spheres)
}

/// The same among more spheres than get straight-line code.
pub fn coincident_crowd() -> Scene {
    let scene = coincident_lights();
    let balls = (0..12_u32).map(|i| {
        let place = [0.9 * f64::from(i % 6) - 2.2, 0.3, 2.0 + 0.9 * f64::from(i / 6)];
        sphere(place, 0.3, diffuse(0.6))
    });
    let spheres = scene.spheres().iter().cloned().chain(balls).collect();
    picture([0.0, 3.0, 7.0], [0.0, 1.0, 0.0], 2, spheres)
}

/// Under a layer of lamps that fill half of it; their powers span some decades.
pub fn lamp_layer(count: u32, decades: f64) -> Scene {
    let lamp = |index| {
        let key = SampleKey { pixel: 4, index: u64::from(index) };
        let [x, y, z, power] = random_bits(key, 0, 0).map(unit_float);
        let place = DVec3::new(6.0 * x - 3.0, 1.6 + 0.3 * y, 6.0 * z - 3.0);
        let power = 10_f64.powf(decades * power);
        let tint = DVec3::new(1.0, 0.5 + f64::from(index % 3) / 4.0, 1.5 - f64::from(index % 2));
        sphere(place, 2.5 / f64::from(count).sqrt().max(6.0), emitter(power * tint))
    };
    let mut spheres = vec![
        floor(),
        sphere([0.6, 0.7, 0.0], 0.7, glossy(0.9, 10.0)),
        sphere([-1.0, 0.6, 0.5], 0.6, diffuse(0.8)),
    ];
    spheres.extend((0..count).map(lamp));
    picture([0.0, 1.4, 3.6], [0.0, 0.0, 1.2], 2, spheres)
}

/// Hundreds of balls of all kinds and sizes, some inside one another, two lamps among them, and
/// some in one place but for less than the device's coordinates tell: balls in each other, and
/// a lamp with a ball before it and one behind it in the file.
pub fn swarm() -> Scene {
    let ball = |index: u32| {
        let key = SampleKey { pixel: 6, index: u64::from(index) };
        let [x, y, z, size] = random_bits(key, 0, 0).map(unit_float);
        let place = DVec3::new(6.0 * x - 3.0, 3.0 * y, 6.0 * z - 4.0);
        let tint = [0.9, 0.3 + 0.3 * f64::from(index % 3), 0.8];
        let surface = if index.is_multiple_of(4) { glossy(0.8, 5.0) } else { colored(tint) };
        sphere(place, 0.03 * 12_f64.powf(size * size), surface)
    };
    let shell = |i: u32, surface| sphere([0.5, 1.5, 1.5], 0.6 - 1e-10 * f64::from(i), surface);
    let mut spheres = vec![floor(), sphere([0.0, 6.0, 0.0], 1.0, emitter([9.0, 8.0, 7.0]))];
    spheres.extend((0..200).map(ball));
    spheres.extend((0..9).map(|i| shell(i, colored([0.9, 0.1 * f64::from(i), 0.5]))));
    let hidden = |i: u32, surface| sphere([-1.5, 3.5, 1.0], 0.5 - 1e-10 * f64::from(i), surface);
    spheres.push(hidden(0, diffuse(0.5)));
    spheres.push(hidden(1, emitter([5.0, 9.0, 5.0])));
    let seen = |i: u32, surface| sphere([1.5, 3.5, 1.0], 0.5 - 1e-10 * f64::from(i), surface);
    spheres.push(seen(0, emitter([5.0, 5.0, 9.0])));
    spheres.push(seen(1, diffuse(0.5)));
    spheres.extend((200..400).map(ball));
    picture([0.0, 3.0, 8.0], [0.0, 1.2, 0.0], 2, spheres)
}
