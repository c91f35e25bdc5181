//! Single rays against single spheres, in both forms: the twin against construction,
//! the device against the twin, with bounds from a running error analysis.

#![expect(clippy::cast_possible_truncation, reason = "faults are computed in f32")]
#![expect(clippy::many_single_char_names, reason = "the names of the formulas")]

mod support {
    pub mod bare;
    pub mod gpu;
    pub mod hits;
}

use candor::cpu::sphere::{MISS, Ray, anchored, entry, exit, factored};
use candor::gpu::probe::{Probe, Row};
use glam::{DVec3, Vec3};
use support::hits::{Case, Plan, Side, U, plans, tangents};

/// One `f64` rounding, relative.
const U64: f64 = U * U * 32.0;

/// The twin finds the distance that a case was built with. What `f64` may be off is the
/// analysis of the row with its own unit, and eight roundings of what the row was built
/// from, seen under the ray's angle.
#[test]
fn the_twin_finds_what_was_built() {
    let plans = plans();
    for plan in plans.iter().filter(|plan| plan.side != Side::Chord) {
        let (place, size, offset) = plan.shape();
        let ray = Ray { origin: plan.origin(), direction: plan.direction };
        let q = if plan.anchored {
            anchored(&ray, place, offset, size)
        } else {
            factored(&ray, place, size)
        };
        let found = if plan.side == Side::Entry { entry(q) } else { exit(q, false) };
        let tolerance = plan.round().bounds(U64).distance + built_within(plan);
        let off = (found - plan.distance).abs();
        assert!(off <= tolerance, "{plan:?}: {found}, off by {off:e} of {tolerance:e}");
    }
}

fn built_within(plan: &Plan) -> f64 {
    let far = if plan.anchored { 0.0 } else { plan.radius };
    let cosine = plan.direction.dot(plan.normal).abs();
    8.0 * U64 * (plan.point.length() + plan.distance + far) / cosine
}

/// The chord ends on the sphere.
#[test]
fn the_twins_chords_end_on_the_sphere() {
    for plan in plans().iter().filter(|plan| plan.side == Side::Chord) {
        let (place, size, offset) = plan.shape();
        let ray = Ray { origin: plan.point, direction: plan.direction };
        let form = if plan.anchored {
            anchored(&ray, place, offset, size)
        } else {
            factored(&ray, place, size)
        };
        let t = exit(form, true);
        let centre = plan.point - plan.radius * plan.normal;
        let off = ((ray.origin + t * ray.direction).distance(centre) - plan.radius).abs();
        assert!(off <= 32.0 * U64 * (plan.radius + t + plan.point.length()), "{plan:?}: {off:e}");
    }
}

fn table() -> Vec<Case> {
    plans().iter().map(Plan::round).chain(tangents()).collect()
}

fn rows(case: &Case) -> [Row; 4] {
    let row = |v: Vec3, w: f32| [v.x, v.y, v.z, w].map(f32::to_bits);
    let side = match case.side {
        Side::Entry => 0.0,
        Side::Exit => 1.0,
        Side::Chord => 2.0,
    };
    [
        row(case.origin, f32::from(u8::from(case.anchored))),
        row(case.direction, side),
        row(case.position, case.size),
        row(Vec3::new(case.offset, 0.0, 0.0), 0.0),
    ]
}

/// Distance, b, c and discriminant of every case.
fn on_device(cases: &[Case]) -> Vec<[f32; 4]> {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &support::bare::nothing()).expect("the probe compiles");
    let rows: Vec<Row> = cases.iter().flat_map(rows).collect();
    let results = probe.run("probe_hit", &rows, cases.len()).expect("the device runs");
    results.into_iter().map(|row| row.map(f32::from_bits)).collect()
}

/// The worst of one radius in one form.
#[derive(Debug, Default)]
struct Worst {
    rows: u32,
    /// Error of the distance and of b, c and the discriminant, as shares of their bounds.
    distance: f64,
    quadratic: f64,
    /// Distance of the hit point from the surface, head-on to grazing.
    residual: f64,
}

#[test]
fn the_device_keeps_its_bounds() {
    let cases = table();
    let found = on_device(&cases);
    println!(
        "{:<10}{:>8}{:>6}{:>10}{:>12}{:>12}",
        "form", "radius", "rows", "distance", "quadratic", "off surface"
    );
    for group in cases.iter().zip(&found).collect::<Vec<_>>().chunk_by(|a, b| same_kind(a.0, b.0)) {
        let mut worst = Worst::default();
        for (case, found) in group {
            add(&mut worst, case, found);
        }
        let form = if group[0].0.anchored { "anchored" } else { "factored" };
        println!(
            "{form:<10}{:>8.0e}{:>6}{:>10.3}{:>12.3}{:>12.1e}",
            group[0].0.radius, worst.rows, worst.distance, worst.quadratic, worst.residual
        );
    }
    println!(
        "errors as shares of their bounds; hits off the surface in lengths, at most 30 from the focus"
    );
}

fn same_kind(a: &Case, b: &Case) -> bool {
    a.radius.to_bits() == b.radius.to_bits() && a.anchored == b.anchored
}

fn add(worst: &mut Worst, case: &Case, found: &[f32; 4]) {
    let (q, t) = case.exact();
    let bounds = case.bounds(U);
    let share = case.judge(found[0]);
    let share = share.unwrap_or_else(|| panic!("{case:?}: {found:?}, not {t} within {bounds:?}"));
    let parts = [
        (found[1], q.b, bounds.b),
        (found[2], q.c, bounds.c),
        (found[3], q.discriminant, bounds.discriminant),
    ];
    let shares = parts.map(|(found, truth, bound)| (f64::from(found) - truth).abs() / bound);
    let quadratic = shares.into_iter().fold(0.0, f64::max);
    assert!(quadratic <= 1.0, "{case:?}: {found:?}, not {q:?} within {bounds:?}");
    worst.rows += 1;
    worst.distance = worst.distance.max(share);
    worst.quadratic = worst.quadratic.max(quadratic);
    // A ray that starts under the surface is at distance 0 by decree.
    let starts_outside = case.side == Side::Entry && q.c > 0.0;
    if starts_outside && t < MISS && found[0] < 3.0e38 {
        worst.residual = worst.residual.max(case.residual(f64::from(found[0])));
    }
}

/// The bounds mean something: beyond the band of tangency every row has one, and what
/// they allow off the surface is a few roundings of the lengths involved.
#[test]
fn bounds_are_tight_where_rays_are_not_grazing() {
    for case in plans().iter().filter(|p| p.direction.dot(p.normal).abs() >= 0.1).map(Plan::round) {
        let (_, t) = case.exact();
        let size = if case.anchored { 0.0 } else { f64::from(case.size) };
        let lengths = case.origin.as_dvec3().length()
            + t
            + size
            + case.position.as_dvec3().length() * size.min(1.0);
        let bound = case.bounds(U).distance;
        assert!(bound <= 1000.0 * U * lengths.max(1.0), "{case:?}: {bound:e}");
    }
}

/// Another way to a distance, in `f32`.
type Form = fn(&Case) -> f32;

/// Centre and radius whatever the size; b² - c unfactored.
fn textbook(case: &Case) -> f32 {
    let (centre, radius) = if case.anchored {
        let k = f64::from(case.size);
        // The row's own sphere: |p + m/κ|² = |m|²/κ² - 2e/κ.
        let m: DVec3 = case.position.as_dvec3();
        let squared = m.length_squared() / (k * k) - 2.0 * f64::from(case.offset) / k;
        ((-m / k).as_vec3(), squared.sqrt() as f32)
    } else {
        (case.position, case.size)
    };
    let f = case.origin - centre;
    let b = f.dot(case.direction);
    let discriminant = b * b - (f.dot(f) - radius * radius);
    if b < 0.0 && discriminant >= 0.0 { (-b - discriminant.sqrt()).max(0.0) } else { 3.0e38 }
}

/// The kernel's form with one thing changed.
fn changed(case: &Case, offset: f32, cancelling: bool) -> f32 {
    let (m, o, k) = (case.position, case.origin, case.size);
    let g = m + k * o;
    let (b, c) = (g.dot(case.direction), (m + g).dot(o) + 2.0 * offset);
    let discriminant = b * b - k * c;
    if b >= 0.0 || discriminant < 0.0 {
        return 3.0e38;
    }
    let root = discriminant.sqrt();
    if cancelling { ((-b - root) / k).max(0.0) } else { (c / (root - b)).max(0.0) }
}

fn rejected(form: Form, rows: impl Fn(&Case) -> bool) -> (usize, usize) {
    let cases: Vec<Case> =
        table().into_iter().filter(|c| c.side == Side::Entry && rows(c)).collect();
    (cases.iter().filter(|case| case.judge(form(case)).is_none()).count(), cases.len())
}

#[test]
fn other_forms_are_rejected() {
    let large =
        |radius: f64| move |case: &Case| case.anchored && (radius..f64::MAX).contains(&case.radius);
    let small = |case: &Case| !case.anchored && case.radius <= 1e-2;
    let wrong_sign: Form = |case| changed(case, -case.offset, false);
    let cancelling: Form = |case| changed(case, case.offset, true);
    let faults: [(&str, (usize, usize)); 5] = [
        ("centre and radius, R ≥ 1e4", rejected(textbook, large(1e4))),
        ("centre and radius, R ≥ 1e5", rejected(textbook, large(1e5))),
        ("b² - c for small far spheres", rejected(textbook, small)),
        ("anchored, sign of the offset", rejected(wrong_sign, large(10.0))),
        ("anchored, cancelling root, R ≥ 1e4", rejected(cancelling, large(1e4))),
    ];
    for (name, (rejected, rows)) in faults {
        println!("{name}: {rejected} of {rows} rows rejected");
        assert!(4 * rejected > rows, "{name}: {rejected} of {rows} rows rejected");
    }
    // The kernel's form, computed in the same way, passes every row.
    let kernels: Form = |case| changed(case, case.offset, false);
    assert_eq!(rejected(kernels, |case| case.anchored).0, 0);
}
