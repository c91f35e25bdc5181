//! Nanoseconds of one call: elementary functions, and ways to a hit.

use crate::functions::{Measured, short};
use crate::options::open;
use crate::turns::{self, Measure, Middle, above};
use crate::wgsl::{Calls, MATH, SPHERE};
use candor::gpu::Adapter;

/// Times expressions of `u` in turns with one that only makes `u`, whose time is taken off.
fn time(adapter: &Adapter, rounds: u64, functions: &str, expressions: &[&str]) -> Vec<Vec<f64>> {
    let calls: Vec<Calls> = std::iter::once(&"u")
        .chain(expressions)
        .map(|expression| Calls::new(open(adapter), functions, expression))
        .collect();
    let mut rows: Vec<Measure> =
        calls.iter().map(|calls| Box::new(|_| calls.nanoseconds()) as Measure).collect();
    let mut times = turns::take(rounds, &mut rows);
    let loops = times.remove(0);
    for row in &mut times {
        row.iter_mut().zip(&loops).for_each(|(time, &made)| *time -= made);
    }
    times
}

/// An elementary function: its name, WGSL's way, the kernel's way, and where `functions`
/// found their errors.
const FUNCTIONS: [[&str; 4]; 5] = [
    [
        "sin and cos of 2πu",
        "sin(6.283185307179586 * u) + cos(6.283185307179586 * u)",
        "dot(sincos_2pi(u), vec2<f32>(1.0))",
        "sin 2πu",
    ],
    ["-log(1-u)", "-log(1.0 - u)", "minus_log_complement(u)", "-log(1-u), drawn"],
    ["1-exp(-x)", "1.0 - exp(-17.0 * u)", "one_minus_exp_minus(17.0 * u)", "1-exp(-x)"],
    ["exp(-x)", "exp(-80.0 * u)", "exp_minus(80.0 * u)", "exp(-x)"],
    [
        "1-cosα, n = 1e4",
        "1.0 - pow(1.0 - u, 1.0 / 10001.0)",
        "one_minus_exp_minus(minus_log_complement(u) / 10001.0)",
        "1-cosα, n = 1e4",
    ],
];

pub fn measure_functions(adapter: &Adapter, rounds: u64, errors: &[Measured]) {
    let expressions: Vec<&str> =
        FUNCTIONS.iter().flat_map(|[_, built_in, own, _]| [*built_in, *own]).collect();
    let times = time(adapter, rounds, MATH, &expressions);
    println!("Nanoseconds per call on the whole device, and the worst relative error in 2^-24");
    println!(
        "{:20} {:>21} {:>9} {:>21} {:>9} {:>24}",
        "", "built-in", "error", "kernel", "error", "the kernel's extra"
    );
    for ([name, .., key], times) in std::iter::zip(FUNCTIONS, times.chunks(2)) {
        let found = errors.iter().find(|m| m.function.name == key).expect("it was measured");
        let own = found.own.expect("the kernel has its own");
        let extra = turns::extra(&times[1], &times[0]);
        println!(
            "{name:20} {:>21} {:>9} {:>21} {:>9} {extra:>24} {}",
            Middle::of(&times[0]),
            short(found.built_in.relative),
            Middle::of(&times[1]),
            short(own.relative),
            extra.verdict()
        );
    }
    println!();
}

/// A ray from above onto a ball of radius 3; every number depends on `u`, so that nothing is
/// computed once for all calls.
const RAYS: &str = "
fn ray_of(u: f32) -> Ray {
    return Ray(vec3<f32>(u, 4.0 + u, 0.5 - u), vec3<f32>(0.1 * u, -0.99, 0.14 - 0.1 * u));
}

fn by_textbook(u: f32) -> f32 {
    let ray = ray_of(u);
    let f = ray.origin - vec3<f32>(0.1 * u, -3.0, u);
    let b = dot(f, ray.direction);
    let discriminant = b * b - (dot(f, f) - (9.0 + u));
    let t = max(-b - sqrt(max(discriminant, 0.0)), 0.0);
    return select(MISS, t, b < 0.0 && discriminant >= 0.0);
}

fn by_factored(u: f32) -> f32 {
    return entry(factored(ray_of(u), vec3<f32>(0.1 * u, -3.0, u), 3.0 + u));
}

fn by_anchored(u: f32) -> f32 {
    return entry(anchored(ray_of(u), vec3<f32>(0.1 * u, 1.0, -0.3 * u), 0.1 * u, 0.33 - 0.1 * u));
}
";

pub fn measure_forms(adapter: &Adapter, rounds: u64) {
    let forms = ["textbook", "factored", "anchored"];
    let calls = forms.map(|form| format!("by_{form}(u)"));
    let functions = format!("{SPHERE}{RAYS}");
    let times = time(adapter, rounds, &functions, &calls.each_ref().map(String::as_str));
    println!("Nanoseconds per ray and sphere on the whole device, above the textbook's");
    for (form, row) in std::iter::zip(forms, &times) {
        let verdict = above(row, &times[0]);
        println!("{form:20} {:>21}{verdict}", Middle::of(row));
    }
    println!();
}
