//! The chances with which lights are picked, on the device: against `f64`, against the
//! promise that none is below half of an even one, and in distribution.

#![expect(clippy::cast_precision_loss, reason = "counts of lights and picks")]

mod support {
    pub mod gpu;
    pub mod light_scenes;
    pub mod picks;
    pub mod scenes;
}

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sampling::{around, polar_hemisphere};
use candor::kernel::{Packed, layout, probe_source};
use glam::{DVec3, Vec3};
use statrs::distribution::{ChiSquared, ContinuousCDF};
use support::light_scenes::{forty_lights, in_light, joined_lights};
use support::picks::{Point, ask, packed};

const U: f64 = 1.0 / (1 << 24) as f64;

/// Chance that a correct kernel fails the test in distribution.
const FAMILY: f64 = 1e-6;

fn draw(index: u64, block: u32) -> [f64; 4] {
    random_bits(SampleKey { pixel: 6, index }, block, 0).map(unit_float)
}

fn anywhere(index: u64, block: u32) -> DVec3 {
    let [u, v, side, _] = draw(index, block);
    let up = around(DVec3::Z, polar_hemisphere(u), v);
    if side < 0.5 { up } else { -up }
}

/// Points within the scene and outside the lights that are seen from outside.
fn points(packed: &Packed, count: usize) -> Vec<Point> {
    let spheres = lights(packed);
    let is_free = |p: &Point| {
        spheres.iter().all(|light| {
            let distance = p.position.distance(Vec3::from_array(light.position));
            light.inside == 1 || distance > 1.001 * light.size
        })
    };
    let point = |index| Point {
        position: (draw(index, 0)[3] * anywhere(index, 1)).as_vec3(),
        normal: anywhere(index, 2).as_vec3(),
    };
    (0..).map(point).filter(is_free).take(count).collect()
}

fn lights(packed: &Packed) -> Vec<layout::Sphere> {
    packed.lights.iter().map(|&place| packed.spheres[place as usize]).collect()
}

/// height · brightest channel · largest cosine in the cone, by angles and in `f64`; and how
/// far off it may be: 32 roundings of the height, its root included, and 16 of a cosine made
/// of products of sines and cosines, each of at most 1.
fn potential(light: &layout::Sphere, point: &Point) -> (f64, f64) {
    let brightest = f64::from(light.color.into_iter().fold(0.0, f32::max));
    if light.inside == 1 {
        return (brightest, 0.0);
    }
    let to_centre = Vec3::from_array(light.position).as_dvec3() - point.position.as_dvec3();
    let sigma = (f64::from(light.size) / to_centre.length()).asin();
    let theta = to_centre.angle_between(point.normal.as_dvec3());
    let cosine = (theta - sigma).max(0.0).cos().max(0.0);
    let whole = 2.0 * (sigma / 2.0).sin().powi(2) * brightest;
    (whole * cosine, U * whole * (32.0 * cosine + 16.0))
}

/// Half of the time in proportion, half of the time evenly; and how far off each may be,
/// from its own potential's error and from the total's.
fn chances(lights: &[layout::Sphere], point: &Point) -> Vec<(f64, f64)> {
    let potentials: Vec<(f64, f64)> = lights.iter().map(|light| potential(light, point)).collect();
    let count = lights.len() as f64;
    let total: f64 = potentials.iter().map(|p| p.0).sum();
    let of_total: f64 = potentials.iter().map(|p| p.1).sum::<f64>() + count * U * total;
    let chance = |(p, error): (f64, f64)| {
        let share = if total > 0.0 { p / total } else { 1.0 / count };
        let off = if total > 0.0 { (error + share * of_total) / total } else { 0.0 };
        (f64::midpoint(share, 1.0 / count), off / 2.0 + 4.0 * U)
    };
    potentials.into_iter().map(chance).collect()
}

#[test]
fn chances_are_those_of_the_bound_and_none_is_small() {
    for scene in [forty_lights(), joined_lights(), in_light()] {
        let packed = packed(&scene);
        let lights = lights(&packed);
        let (points, count) = (points(&packed, 2000), lights.len());
        let questions: Vec<(Point, u32)> = points
            .iter()
            .flat_map(|&p| packed.lights.iter().map(move |&light| (p, light)))
            .collect();
        let found = ask(&packed, &probe_source(), &questions);
        let (mut worst, mut least, mut differ) = (0.0_f64, 1.0_f64, 0);
        for (point, found) in points.iter().zip(found.chunks(count)) {
            let sum: f64 = found.iter().map(|f| f64::from(f.0)).sum();
            assert!((sum - 1.0).abs() <= 4.0 * count as f64 * U, "{point:?}: they sum to {sum}");
            for (&(chance, picked, own), (truth, bound)) in
                found.iter().zip(chances(&lights, point))
            {
                let (chance, even) = (f64::from(chance), 1.0 / count as f64);
                let off = (chance - truth).abs();
                assert!(off <= bound, "{point:?}: {chance} for {truth} within {bound:e}");
                (worst, least) = (worst.max(off / bound), least.min(chance));
                // Neither even nor proportional chances would pass.
                let proportional = 2.0 * truth - even;
                differ += usize::from(
                    (truth - even).abs() > bound && (truth - proportional).abs() > bound,
                );
                // The light that is picked has the chance that it is asked for.
                let at = packed.lights.iter().position(|&p| p == picked);
                let of_it = found[at.expect("a light is picked")].0;
                assert_eq!(of_it.to_bits(), own.to_bits(), "{point:?}: {picked}");
            }
        }
        println!("{count} lights: chances at {worst:.2} of their bound, the least is {least:.5}");
        assert!(least >= 0.5 / count as f64 * (1.0 - 4.0 * U), "a chance of {least}");
        assert!(2 * differ > questions.len(), "other chances would pass");
    }
}

/// Picks follow the chances: χ² over the lights at a few points.
#[test]
fn picks_follow_their_chances() {
    const PICKS: usize = 1 << 16;
    let packed = packed(&forty_lights());
    let lights = lights(&packed);
    let (points, mut rejected) = (points(&packed, 4), 0);
    for &point in &points {
        let found = ask(&packed, &probe_source(), &vec![(point, packed.lights[0]); PICKS]);
        let p_value = |expected: Vec<f64>| {
            let cell = |(&place, chance): (&u32, f64)| {
                let observed = found.iter().filter(|f| f.1 == place).count() as f64;
                let expected = PICKS as f64 * chance;
                (observed - expected).powi(2) / expected
            };
            let sum: f64 = packed.lights.iter().zip(expected).map(cell).sum();
            ChiSquared::new(lights.len() as f64 - 1.0).expect("several lights").sf(sum)
        };
        let p = p_value(chances(&lights, &point).into_iter().map(|chance| chance.0).collect());
        println!("{:?}: p = {p:.4}", point.position);
        assert!(p > FAMILY / 4.0, "{point:?}: p = {p:e}");
        let even = vec![1.0 / lights.len() as f64; lights.len()];
        rejected += usize::from(p_value(even) < FAMILY / 4.0);
    }
    // Where no light is above the horizon, even is right.
    assert!(2 * rejected >= points.len(), "even picks pass");
}
