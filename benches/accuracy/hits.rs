//! How far a hit lies from the sphere that was meant, by form and radius.

use crate::options::open;
use crate::rays::{Case, Plan, Side, plans};
use crate::wgsl::with_body;
use candor::cpu::sphere::{MISS, Ray, entry, factored};
use candor::gpu::Adapter;
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, probe_source};
use glam::{DVec3, Vec3};

pub const RADII: [f64; 4] = [1.0, 1e3, 1e5, 1e7];

/// Rays that graze less than this are judged: where they graze more, missing is no error.
pub const LEAST_COSINE: f64 = 0.1;

/// A way to a hit.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Form {
    Textbook,
    Factored,
    Anchored,
    /// The twin.
    Double,
}

/// Worst distances from the surface: a row for each form, a column for each radius.
pub type Table = [[f64; RADII.len()]; 4];

/// The text whose factored form is the textbook's, b² - c, and its root, -b - √.
pub fn textbook(wgsl: &str) -> String {
    let discriminant = "let b = dot(ray.origin - centre, ray.direction);
    let f = ray.origin - centre;
    let c = dot(f, f) - radius * radius;
    return Quadratic(b, c, b * b - c, 1.0);";
    let root = "let t = max(-q.b - sqrt(max(q.discriminant, 0.0)), 0.0);
    return select(MISS, t, q.b < 0.0 && q.discriminant >= 0.0);";
    with_body(&with_body(wgsl, "factored", discriminant), "entry", root)
}

pub fn measure(adapter: &Adapter) -> Table {
    let gpu = open(adapter);
    let probe = |wgsl: String| {
        Probe::with_source(&gpu, &Packed::default(), wgsl).expect("the device takes it")
    };
    let (kernel, textbook) = (probe(probe_source()), probe(textbook(&probe_source())));
    let of = |form: Form, radius: f64| {
        let plans: Vec<Plan> = plans()
            .into_iter()
            .filter(|plan| plan.side == Side::Entry && plan.radius.to_bits() == radius.to_bits())
            .filter(|plan| plan.direction.dot(plan.normal).abs() >= LEAST_COSINE)
            .map(|plan| Plan { anchored: form == Form::Anchored, ..plan })
            .collect();
        let found = match form {
            Form::Textbook => on_device(&textbook, &plans),
            Form::Factored | Form::Anchored => on_device(&kernel, &plans),
            Form::Double => plans.iter().map(doubled).collect(),
        };
        worst(&plans, &found)
    };
    [Form::Textbook, Form::Factored, Form::Anchored, Form::Double]
        .map(|form| RADII.map(|radius| of(form, radius)))
}

/// A hit that is missed is infinitely far off.
fn worst(plans: &[Plan], found: &[f64]) -> f64 {
    let off = |(plan, &t)| if t < MISS { off_surface(plan, t) } else { f64::INFINITY };
    std::iter::zip(plans, found).map(off).fold(0.0, f64::max)
}

fn on_device(probe: &Probe, plans: &[Plan]) -> Vec<f64> {
    let row = |v: Vec3, w: f32| [v.x, v.y, v.z, w].map(f32::to_bits);
    let rows = |case: Case| {
        [
            row(case.origin, f32::from(u8::from(case.anchored))),
            row(case.direction, 0.0),
            row(case.position, case.size),
            row(Vec3::new(case.offset, 0.0, 0.0), 0.0),
        ]
    };
    let rows: Vec<Row> = plans.iter().map(Plan::round).flat_map(rows).collect();
    let results = probe.run("probe_hit", &rows, plans.len()).expect("the device runs");
    let distance = |row: Row| f64::from(f32::from_bits(row[0]));
    results.into_iter().map(distance).map(|t| if t < 3.0e38 { t } else { MISS }).collect()
}

/// The ray that the kernel gets, in `f64`.
fn ray(plan: &Plan) -> Ray {
    plan.round().ray()
}

fn doubled(plan: &Plan) -> f64 {
    let centre = plan.point - plan.radius * plan.normal;
    entry(factored(&ray(plan), centre, plan.radius))
}

/// Distance from the sphere before anything of it was rounded, of the point at `t` of the ray
/// that the kernel gets: with p from the planned point, height h, F = n·p + |p|²/2R = h + h²/2R.
fn off_surface(plan: &Plan, t: f64) -> f64 {
    let Ray { origin, direction } = ray(plan);
    let p: DVec3 = origin + t * direction - plan.point;
    let value = plan.normal.dot(p) + p.length_squared() / (2.0 * plan.radius);
    (2.0 * value / (1.0 + (1.0 + 2.0 * value / plan.radius).max(0.0).sqrt())).abs()
}
