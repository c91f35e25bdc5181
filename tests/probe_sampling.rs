//! Directions and weights of scattering on the device: row by row against the twin's,
//! and in distribution.

#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "counts of samples below 2^24, and exponents that the kernel takes as f32"
)]

mod support {
    pub mod bare;
    #[allow(dead_code, reason = "the twin's test rejects its faults")]
    pub mod chi_square;
    #[allow(dead_code, reason = "of all formulas, those of the lobe")]
    pub mod closed_form;
    pub mod gpu;
    pub mod uniform_probe;
}

use bytemuck::Zeroable;
use candor::cpu::material::{scatter_diffuse, scatter_glossy};
use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sampling::{around, polar_hemisphere, polar_phong};
use candor::estimate::z_limit;
use candor::gpu::Gpu;
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, layout};
use glam::{DVec2, DVec3, Vec3};
use support::bare::bare;
use support::chi_square::{EXPONENTS, check_samplers};
use support::closed_form::{lobe_above_horizon, lobe_albedo};
use support::uniform_probe::uniform_probe;

const U: f64 = 1.0 / (1 << 24) as f64;

/// How far from unit length a direction may be.
const LENGTH: f64 = 1e-6;

/// Chance that a correct kernel fails a statistical test of this file.
const FAMILY: f64 = 1e-6;

/// One scattering; a negative exponent is a diffuse surface.
#[derive(Debug, Clone, Copy)]
struct Event {
    normal: Vec3,
    incoming: Vec3,
    exponent: f32,
    u: [f32; 2],
}

/// Exponents of the surfaces; a diffuse one stands first.
const SURFACES: [f32; 8] = [-1.0, 0.0, 1.0, 100.0, 1e4, 1e6, 1e7, 1e10];

fn surfaces() -> Packed {
    let surface = |exponent: f32| {
        let kind = if exponent < 0.0 { layout::KIND_DIFFUSE } else { layout::KIND_GLOSSY };
        layout::Sphere { kind, exponent: exponent.max(0.0), ..layout::Sphere::zeroed() }
    };
    bare(layout::Scene::zeroed(), SURFACES.map(surface).to_vec())
}

/// The packed sphere with this exponent.
fn surface_of(exponent: f32) -> u32 {
    let is_it = |other: &f32| other.to_bits() == exponent.to_bits();
    u32::try_from(SURFACES.iter().position(is_it).expect("one of them")).expect("a few")
}

struct Device {
    gpu: Gpu,
}

impl Device {
    fn open() -> Self {
        Self { gpu: support::gpu::open() }
    }

    fn run(&self, entry: &str, rows: &[Row], results: usize) -> Vec<[f32; 4]> {
        let probe = Probe::with_source(&self.gpu, &surfaces(), uniform_probe())
            .expect("the probe compiles");
        let rows = probe.run(entry, rows, results).expect("the device runs");
        rows.into_iter().map(|row| row.map(f32::from_bits)).collect()
    }

    /// Direction and weight of each event.
    fn scatter(&self, events: &[Event]) -> Vec<(DVec3, f64)> {
        let row = |v: Vec3, w: u32| [v.x.to_bits(), v.y.to_bits(), v.z.to_bits(), w];
        let rows = |e: &Event| {
            let point = Vec3::new(e.u[0], e.u[1], 0.0);
            [row(e.normal, 0), row(e.incoming, surface_of(e.exponent)), row(point, 0)]
        };
        let rows: Vec<Row> = events.iter().flat_map(rows).collect();
        let found = self.run("probe_scatter", &rows, events.len());
        found.into_iter().map(|[x, y, z, w]| (vector(x, y, z), f64::from(w))).collect()
    }

    /// Direction and versine of each point of the unit square.
    fn phong(&self, points: &[[f32; 2]], exponent: f32) -> Vec<(DVec3, f64)> {
        let rows: Vec<Row> =
            points.iter().map(|&[u, v]| [u, v, exponent, 0.0].map(f32::to_bits)).collect();
        let found = self.run("probe_phong", &rows, rows.len());
        found.into_iter().map(|[x, y, z, t]| (vector(x, y, z), f64::from(t))).collect()
    }
}

fn vector(x: f32, y: f32, z: f32) -> DVec3 {
    Vec3::new(x, y, z).as_dvec3()
}

fn random_point(index: u64, block: u32) -> [f32; 2] {
    let [x, y, ..] = random_bits(SampleKey { pixel: 2, index }, block, 0).map(unit_float);
    DVec2::new(x, y).as_vec2().to_array()
}

fn point(u: [f32; 2]) -> DVec2 {
    DVec2::new(f64::from(u[0]), f64::from(u[1]))
}

/// Random events on surfaces that face anywhere, seen from anywhere above, grazing too.
fn events(exponents: &[f32], count: u64) -> Vec<Event> {
    let event = |index| {
        let [u, v] = point(random_point(index, 0)).to_array();
        let up = around(DVec3::Z, polar_hemisphere(u), v);
        let normal = if index % 2 == 0 { up } else { -up };
        let [u, v] = point(random_point(index, 1)).to_array();
        Event {
            normal: normal.as_vec3(),
            incoming: -around(normal, polar_hemisphere(u), v).as_vec3(),
            exponent: exponents[index as usize % exponents.len()],
            u: random_point(index, 2),
        }
    };
    (0..count).map(event).collect()
}

fn mirror(e: &Event) -> DVec3 {
    let (normal, incoming) = (e.normal.as_dvec3(), e.incoming.as_dvec3());
    (incoming - 2.0 * incoming.dot(normal) * normal).normalize()
}

/// The twin's scattering and how far off the device may be: the bound of its direction.
///
/// Diffuse: the sine has 3 roundings and a root (9), the azimuth 4 and a product (1);
/// each frame vector 9 (a division, three products, a sum), and the combination 3, over
/// three axes: 17 + √3·(9 + 3) < 40. Glossy: the mirror direction has 10 and a
/// normalisation (16), which the frame hands on with a factor of 3 for each of two
/// vectors (d(nₓ²a) ≤ 3dn); the versine t 5 + 4 + 1 + 5 = 15 (a division by n + 1), its
/// root half of that and 11 more.
fn expected(e: &Event) -> (DVec3, f64, f64) {
    let (normal, u) = (e.normal.as_dvec3(), point(e.u));
    if e.exponent < 0.0 {
        let truth = scatter_diffuse(normal, u);
        return (truth.direction, truth.weight, 40.0 * U);
    }
    let exponent = f64::from(e.exponent);
    let truth = scatter_glossy(normal, e.incoming.as_dvec3(), exponent, u);
    let [sine, cosine] = polar_phong(u.x, exponent).to_array();
    let bound = U * (26.0 + 15.0 * (1.0 - cosine) + sine * (6.0 * 26.0 + 19.0 + 24.0) + 4.0);
    (truth.direction, truth.weight, bound)
}

#[test]
fn scattering_agrees_with_the_twin() {
    let device = Device::open();
    for exponents in [&[-1.0_f32][..], &[0.0, 1.0, 100.0], &[1e4, 1e6], &[1e7, 1e10]] {
        // Where a mirror direction lies in the plane at which the frame changes its
        // sign, rounding picks one of two frames; both are right.
        let mut events = events(exponents, 1 << 17);
        events.retain(|e| e.exponent < 0.0 || mirror(e).z.abs() > 64.0 * U);
        let (mut worst, mut weights, mut rejected) = (0.0_f64, 0.0_f64, 0);
        for (e, (direction, weight)) in events.iter().zip(device.scatter(&events)) {
            let (truth, true_weight, bound) = expected(e);
            // A diffuse weight is 2u, exact; a glossy one adds a dot product (3).
            let weight_bound = if e.exponent < 0.0 { 0.0 } else { bound + 3.0 * U };
            let (off, off_weight) = (direction.distance(truth), (weight - true_weight).abs());
            assert!(off <= bound, "{e:?}: {direction} instead of {truth}");
            assert!(off_weight <= weight_bound, "{e:?}: {weight} instead of {true_weight}");
            assert!((direction.length() - 1.0).abs() <= LENGTH, "{e:?}: {direction}");
            (worst, weights) = (worst.max(off / bound), weights.max(off_weight / U));
            // A quarter turn of the azimuth does not pass.
            let turned = Event { u: [e.u[0], (e.u[1] + 0.25).fract()], ..*e };
            rejected += usize::from(direction.distance(expected(&turned).0) > bound);
        }
        assert!(10 * rejected > 9 * events.len(), "{rejected} turned directions rejected");
        println!(
            "exponents {exponents:?}: direction {worst:.2} of its bound, weight off by {weights:.1}·2^-24"
        );
    }
}

/// 1 - cosα keeps its relative precision however narrow the lobe: a logarithm (4.5), a
/// sum and a division (6), and 1 - exp(-x), which hands an error of x on with a factor
/// of at most 1 and adds 4.
#[test]
fn lobes_keep_their_digits() {
    let device = Device::open();
    for exponent in [0.0_f32, 1.0, 100.0, 1e4, 1e6, 1e7, 1e10] {
        let points: Vec<[f32; 2]> = (0..1 << 16).map(|i| random_point(i, 3)).collect();
        let mut worst = 0.0_f64;
        for (&u, (_, t)) in points.iter().zip(device.phong(&points, exponent)) {
            let truth = -((-point(u).x).ln_1p() / (f64::from(exponent) + 1.0)).exp_m1();
            let off = if truth == 0.0 { t.abs() } else { (t / truth - 1.0).abs() };
            worst = worst.max(off / U);
        }
        println!("exponent {exponent:e}: 1 - cosα off by {worst:.1}·2^-24, relative");
        assert!(worst <= 14.5, "exponent {exponent:e}: {worst}");
    }
}

#[test]
fn directions_follow_their_densities() {
    let device = Device::open();
    let upright =
        |&u: &[f32; 2]| Event { normal: Vec3::Z, incoming: Vec3::NEG_Z, exponent: -1.0, u };
    let hemisphere = |points: &[[f32; 2]]| {
        let events: Vec<Event> = points.iter().map(upright).collect();
        device.scatter(&events).into_iter().map(|found| found.0).collect()
    };
    let lobe = |points: &[[f32; 2]], exponent: f64| {
        let found = device.phong(points, exponent as f32);
        found.into_iter().map(|found| found.0).collect()
    };
    check_samplers(&hemisphere, &lobe);
}

/// Deviation of a mean from its truth, in standard errors.
fn deviation(values: &[f64], truth: f64) -> f64 {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let variance = values.iter().map(|v| (v - mean).powi(2)).sum::<f64>() / (n - 1.0);
    // Room for f32: the weight's own rounding where nothing varies.
    let error = (variance / n + (64.0 * U * truth.max(U)).powi(2)).sqrt();
    (mean - truth) / error
}

/// The share of the lobe above the surface and the mean weight, also at grazing angles.
#[test]
fn lobes_end_at_the_horizon() {
    let device = Device::open();
    let angles = [0.0, 60.0, 85.0, 89.0];
    let limit = z_limit(FAMILY / (2 * angles.len() * EXPONENTS.len()) as f64);
    println!("{:>9}{:>6}{:>10}{:>8}{:>10}{:>8}", "exponent", "angle", "above", "z", "albedo", "z");
    for (row, (n, degrees)) in
        EXPONENTS.into_iter().flat_map(|n| angles.map(|a: f64| (n, a))).enumerate()
    {
        let theta = degrees.to_radians();
        let exponent = n as f32;
        let incoming = DVec3::new(theta.sin(), -theta.cos(), 0.0).as_vec3();
        let event =
            |i| Event { normal: Vec3::Y, incoming, exponent, u: random_point(i, 16 + row as u32) };
        let events: Vec<Event> = (0..1 << 16).map(event).collect();
        let found = device.scatter(&events);
        for (direction, weight) in &found {
            assert_eq!(*weight == 0.0, direction.y <= 0.0, "{direction} has weight {weight}");
        }
        let weights: Vec<f64> = found.iter().map(|f| f.1).collect();
        let above: Vec<f64> = weights.iter().map(|&w| f64::from(u8::from(w > 0.0))).collect();
        let truths = [lobe_above_horizon(theta, n), lobe_albedo(theta, n)];
        let z = [deviation(&above, truths[0]), deviation(&weights, truths[1])];
        println!(
            "{n:>9.0e}{degrees:>6}{:>10.5}{:>8.2}{:>10.5}{:>8.2}",
            truths[0], z[0], truths[1], z[1]
        );
        assert!(z.iter().all(|z| z.abs() <= limit), "exponent {n:e} at {degrees}°: z = {z:?}");
        // The cosine forgotten, or the part under the surface drawn again.
        if truths[1] < 0.9 * truths[0] {
            assert!(deviation(&above, truths[1]).abs() > limit, "no cosine, {n:e} at {degrees}°");
        }
        if truths[0] < 0.9 {
            let again: Vec<f64> = weights.iter().copied().filter(|&w| w > 0.0).collect();
            assert!(deviation(&again, truths[1]).abs() > limit, "drawn again, {n:e} at {degrees}°");
        }
    }
}

/// The ends of the unit square on normals along the axes and their neighbours.
#[test]
fn corners_give_unit_directions() {
    let device = Device::open();
    let ends = [0.0, f32::EPSILON / 2.0, 0.25, 0.5, 0.75, 1.0 - f32::EPSILON / 2.0];
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|a| [a, -a, Vec3::new(-0.0, -0.0, -0.0) + a]);
    let near =
        [Vec3::new(1e-9, 0.0, -1.0), Vec3::new(0.0, -1e-9, 1.0), Vec3::new(1.0, 0.0, -1e-30)];
    let mut events = Vec::new();
    for &normal in axes.as_flattened().iter().chain(&near) {
        for exponent in [-1.0, 0.0, 1.0, 1e10] {
            for u in ends.iter().flat_map(|&a| ends.map(|b| [a, b])) {
                // Straight down, and along the surface.
                for incoming in [-normal, normal.any_orthonormal_vector()] {
                    events.push(Event { normal, incoming, exponent, u });
                }
            }
        }
    }
    for (e, (direction, weight)) in events.iter().zip(device.scatter(&events)) {
        let most = if e.exponent < 0.0 { 2.0 } else { 1.0 + LENGTH };
        assert!((direction.length() - 1.0).abs() <= LENGTH, "{e:?}: {direction}");
        assert!((0.0..=most).contains(&weight), "{e:?}: weight {weight}");
    }
}
