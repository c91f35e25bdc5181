//! The cones in which lights are sampled, on the device: their height against `f64` from
//! touching lights to far specks, and the directions drawn in them.

#![expect(clippy::cast_possible_truncation, reason = "the device computes in f32")]

mod support {
    pub mod bare;
    #[allow(dead_code, reason = "other tests use the rest")]
    pub mod chi_square;
    pub mod gpu;
}

use candor::cpu::rng::{SampleKey, random_bits, unit_float};
use candor::cpu::sampling::{around, polar_hemisphere};
use candor::gpu::probe::{Probe, Row};
use glam::{DVec2, DVec3, Vec3};
use support::chi_square::{hemisphere_p_value, lobe_p_value, p_limit};

const U: f64 = 1.0 / (1 << 24) as f64;

/// WGSL's division is within 2.5 units in the last place, of 2U each.
const DIVISION: f64 = 5.0 * U;
/// Its root is one over an inverse root of 2 units.
const ROOT: f64 = 9.0 * U;

fn run(entry: &str, rows: &[Row], results: usize) -> Vec<[f32; 4]> {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &support::bare::nothing()).expect("the probe compiles");
    let rows = probe.run(entry, rows, results).expect("the device runs");
    rows.into_iter().map(|row| row.map(f32::from_bits)).collect()
}

/// A light as a point sees it.
#[derive(Debug, Clone, Copy)]
struct View {
    position: Vec3,
    /// Centre and radius, or gradient, curvature and offset.
    shape: Vec3,
    size: f32,
    offset: f32,
    anchored: bool,
}

/// What a cone must be, and how far off it may be.
#[derive(Debug, Clone, Copy)]
struct Truth {
    axis: DVec3,
    height: f64,
    /// Of the height, relative.
    bound: f64,
}

/// 1 - cosσ from sin² and cos²σ with their errors, relative and absolute: the root of cos²
/// hands its error on with 1/2cosσ, or as the root of the error where that is less, and
/// 1 + cosσ weighs it. A sum, a root and a division follow.
fn truth(axis: DVec3, sine2: f64, sine2_error: f64, cosine2: f64, cosine2_error: f64) -> Truth {
    let cosine = cosine2.max(0.0).sqrt();
    let off = (cosine2_error / (2.0 * cosine)).min(cosine2_error.sqrt()) + ROOT * cosine;
    let bound = sine2_error + off / (1.0 + cosine) + U + DIVISION;
    Truth { axis, height: sine2.min(1.0) / (1.0 + cosine), bound }
}

impl View {
    fn rows(&self) -> [Row; 3] {
        let row = |v: Vec3, w: f32| [v.x, v.y, v.z, w].map(f32::to_bits);
        let form = if self.anchored { 1.0 } else { 0.0 };
        let offset = row(Vec3::new(self.offset, 0.0, 0.0), 0.0);
        [row(self.position, form), row(self.shape, self.size), offset]
    }

    fn truth(&self) -> Truth {
        let (p, shape, size) =
            (self.position.as_dvec3(), self.shape.as_dvec3(), f64::from(self.size));
        if self.anchored {
            return Self::anchored(p, shape, size, f64::from(self.offset));
        }
        // The differences (1), their squares (3, halved by the root) and the root: d.
        let to_centre = shape - p;
        let d = to_centre.length();
        let of_d = U + 1.5 * U + ROOT;
        let ratio2 = (size / d).powi(2);
        // (d - r) takes d's error whole, and (d + r)/d² < 2/d; four more roundings.
        let cosine2 = (d - size) * (d + size) / (d * d);
        let of_cosine2 = 2.0 * of_d + cosine2 * (2.0 * of_d + 5.0 * U + DIVISION);
        let of_sine2 = 2.0 * (of_d + DIVISION) + U;
        truth(to_centre / d, ratio2, of_sine2, cosine2, of_cosine2)
    }

    /// From the function of the sphere as it was rounded: |g|² and 2F with the errors of
    /// each of their terms.
    fn anchored(p: DVec3, gradient: DVec3, curvature: f64, offset: f64) -> Truth {
        let g = gradient + curvature * p;
        let (g2, length) = (g.length_squared(), g.length());
        let of_g = 2.0 * U * (curvature * p.length()) + U * length;
        let of_g2 = 2.0 * of_g / length + 3.0 * U;
        let twice_f = (gradient + g).dot(p) + 2.0 * offset;
        let terms = (gradient.length() + length) * p.length();
        let of_twice_f = 5.0 * U * terms + of_g * p.length() + U * (2.0 * offset.abs());
        let cosine2 = curvature * twice_f / g2;
        let of_cosine2 = curvature * of_twice_f / g2 + cosine2.abs() * (of_g2 + U + DIVISION);
        truth(-g / length, 1.0 / g2, of_g2 + DIVISION, cosine2, of_cosine2)
    }
}

fn draw(index: u64, block: u32) -> [f64; 4] {
    random_bits(SampleKey { pixel: 4, index }, block, 0).map(unit_float)
}

fn anywhere(index: u64, block: u32) -> DVec3 {
    let [u, v, side, _] = draw(index, block);
    let up = around(DVec3::Z, polar_hemisphere(u), v);
    if side < 0.5 { up } else { -up }
}

/// Lights of every size from `nearest` to `farthest` of their radii less one away.
fn views(anchored: bool, farthest: f64, count: u64) -> Vec<View> {
    let view = |index| {
        let [a, b, c, _] = draw(index, 0);
        // The distance from the surface over the radius, from 1e-6 on.
        let away = 1e-6 * (farthest / 1e-6).powf(a);
        let toward = anywhere(index, 1);
        let position = 2.0 * b * anywhere(index, 2);
        if anchored {
            let radius = 10_f64.powf(7.0 * c);
            let centre = position + radius * (1.0 + away) * toward;
            let value = (centre.length() - radius) * (centre.length() + radius) / (2.0 * radius);
            View {
                position: position.as_vec3(),
                shape: (-centre / radius).as_vec3(),
                size: (1.0 / radius) as f32,
                offset: value as f32,
                anchored,
            }
        } else {
            let radius = 10_f64.powf(6.0 * c - 5.0);
            let centre = position + radius * (1.0 + away) * toward;
            View {
                position: position.as_vec3(),
                shape: centre.as_vec3(),
                size: radius as f32,
                offset: 0.0,
                anchored,
            }
        }
    };
    (0..count).map(view).collect()
}

fn heights(views: &[View]) -> Vec<[f32; 4]> {
    let rows: Vec<Row> = views.iter().flat_map(View::rows).collect();
    run("probe_cone", &rows, views.len())
}

/// The axis has the errors of its differences, a length or an inverse root, and a quotient.
const AXIS: f64 = 16.0 * U;

#[test]
fn cones_keep_their_digits() {
    for (anchored, farthest) in [(false, 1e15), (true, 8.0)] {
        let views = views(anchored, farthest, 1 << 18);
        let (mut worst, mut largest, mut rejected) = (0.0_f64, 0.0_f64, 0_u32);
        for (view, [x, y, z, height]) in views.iter().zip(heights(&views)) {
            let truth = view.truth();
            let off = (f64::from(height) / truth.height - 1.0).abs();
            assert!(off <= truth.bound, "{view:?}: height {height} instead of {truth:?}");
            let axis = Vec3::new(x, y, z).as_dvec3();
            assert!(axis.distance(truth.axis) <= AXIS, "{view:?}: axis {axis} for {truth:?}");
            assert!((0.0..=1.0).contains(&height), "{view:?}: height {height}");
            (worst, largest) = (worst.max(off / truth.bound), largest.max(truth.bound));
            // 1 - √(1 - sin²) in f32, which cancels, does not pass.
            let sine2 = (truth.height * (2.0 - truth.height)) as f32;
            let textbook = f64::from(1.0 - (1.0 - sine2).sqrt());
            rejected += u32::from((textbook / truth.height - 1.0).abs() > truth.bound);
        }
        println!(
            "anchored {anchored}: {worst:.2} of a bound of at most {largest:.1e}, textbook form off {rejected} times"
        );
        assert!(anchored || 2 * rejected > 1 << 18, "the textbook form passes");
    }
}

/// A point that rounding put into the light is on it and sees a half-space.
#[test]
fn points_in_a_light_see_half_of_everything() {
    let view = |z| View {
        position: Vec3::new(0.0, 0.0, z),
        shape: Vec3::ZERO,
        size: 1.0,
        offset: 0.0,
        anchored: false,
    };
    let found = heights(&[view(1.0 - 1e-6), view(1.0), view(0.5)]);
    assert!(found.iter().all(|cone| cone[3].to_bits() == 1.0_f32.to_bits()), "{found:?}");
}

fn directions(points: &[[f32; 2]], height: f32) -> Vec<[f32; 4]> {
    let rows: Vec<Row> =
        points.iter().map(|&[u, v]| [u, v, height, 0.0].map(f32::to_bits)).collect();
    run("probe_polar", &rows, rows.len())
}

fn vector([x, y, z, _]: [f32; 4]) -> DVec3 {
    Vec3::new(x, y, z).as_dvec3()
}

/// Sine and cosine row by row. Cosine-weighted: √u and √(1 - u), whose arguments are exact.
/// In a cone: t = uH (1) and 2 - t (1, and t's own, as t <= 1) and their product (1), half
/// of which the root passes on; the cosine is 1 - t.
#[test]
fn polar_angles_agree_with_f64() {
    let mut points: Vec<[f32; 2]> = (0..1 << 16)
        .map(|i| {
            let [u, v, ..] = draw(i, 3);
            DVec2::new(u, v).as_vec2().to_array()
        })
        .collect();
    points.extend([[0.0, 0.0], [1.0 - f32::EPSILON / 2.0, 0.5], [f32::EPSILON / 2.0, 0.25]]);
    let mut worst = 0.0_f64;
    for height in [0.0_f32, 1e-30, 1e-10, 1e-4, 0.3, 1.0] {
        for (&[u, v], found) in points.iter().zip(directions(&points, height)) {
            let (u, h) = (f64::from(u), f64::from(height));
            let (sine, cosine) = if height == 0.0 {
                (u.sqrt(), (1.0 - u).sqrt())
            } else {
                ((u * h * (2.0 - u * h)).sqrt(), 1.0 - u * h)
            };
            let off = (f64::from(found[3]) - sine).abs();
            assert!(off <= (2.0 * U + ROOT) * sine, "{u} in {h}: sine {} for {sine}", found[3]);
            let off_cosine = (f64::from(found[2]) - cosine).abs();
            assert!(off_cosine <= 2.0 * U + ROOT, "{u} in {h}: cosine {} for {cosine}", found[2]);
            // The azimuth has 4 and two products; the sine is as good as it was.
            let turn = std::f64::consts::TAU * f64::from(v);
            let across = sine * DVec2::new(turn.cos(), turn.sin());
            let found = DVec2::new(f64::from(found[0]), f64::from(found[1]));
            assert!(found.distance(across) <= 24.0 * U * sine, "{u}, {v}: {found} for {across}");
            worst = worst.max(if sine == 0.0 { 0.0 } else { off / sine / U });
        }
    }
    println!("sines off by at most {worst:.2}·2^-24");
}

/// In distribution: the cosine-weighted hemisphere is the lobe of exponent 1, and a cone
/// blown up to a hemisphere by the ratio of versines is uniform.
#[test]
fn directions_follow_their_densities() {
    let cones = [1e-20_f32, 1e-7, 1e-3, 0.5, 1.0];
    let limit = p_limit(1 + cones.len());
    let cosine =
        |points: &[[f32; 2]], _: f64| directions(points, 0.0).into_iter().map(vector).collect();
    let p = lobe_p_value(&cosine, 1.0);
    println!("cosine-weighted: p = {p:.4}");
    assert!(p > limit, "cosine-weighted directions: p = {p:e}");
    assert!(lobe_p_value(&cosine, 1.05) < limit, "a lobe of exponent 1.05 is accepted");
    let blown_up = |points: &[[f32; 2]], height: f32, by: f64| {
        let blow = |found| {
            let d = vector(found);
            let across = DVec2::new(d.x, d.y);
            let versine = (across.length_squared() / (1.0 + d.z) / by).min(1.0);
            let sine = (versine * (2.0 - versine)).sqrt();
            (sine * across.normalize_or_zero()).extend(1.0 - versine)
        };
        directions(points, height).into_iter().map(blow).collect::<Vec<DVec3>>()
    };
    for height in cones {
        let h = f64::from(height);
        let p = hemisphere_p_value(&|points| blown_up(points, height, h));
        println!("cone of height {height:e}: p = {p:.4}");
        assert!(p > limit, "directions in a cone of height {height:e}: p = {p:e}");
        // A cone that is 2 % too narrow.
        let wrong = hemisphere_p_value(&|points| blown_up(points, height, 1.02 * h));
        assert!(wrong < limit, "a narrower cone is accepted: p = {wrong:e}");
    }
}
