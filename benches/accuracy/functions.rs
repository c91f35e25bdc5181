//! The worst error of each elementary function over all inputs, on the device against `f64`,
//! and that of WGSL's own function on the same inputs.

use crate::options::open;
use crate::wgsl::MATH;
use candor::gpu::probe::{Probe, Row};
use candor::gpu::{Adapter, Gpu};
use candor::kernel::Packed;
use rayon::prelude::*;
use std::f64::consts::TAU;
use std::io::Write;
use std::ops::Range;

/// One rounding of an `f32`, relative; the unit of all errors here.
const U: f64 = 1.0 / (1 << 24) as f64;

/// Numbers of one dispatch: four to an invocation.
const CHUNK: u32 = 1 << 23;

/// A function of a word: of its bits as an `f32`, or of what is made of them.
pub struct Function {
    pub name: String,
    inputs: &'static str,
    words: Range<u32>,
    /// The kernel's way, an expression of `word`, of `u`, its multiple of 2⁻²⁴, or of `x`, the
    /// float of its bits; none where the kernel takes WGSL's.
    own: Option<String>,
    built_in: String,
    truth: Box<dyn Fn(u32) -> f64 + Sync>,
    /// What the tests hold the kernel's way to, or what WGSL promises of its own.
    bound: f64,
}

/// The largest errors, in units of `U`.
#[derive(Debug, Clone, Copy, Default)]
pub struct Worst {
    /// Relative to the value; infinite where a zero is not met.
    pub relative: f64,
    pub absolute: f64,
    /// The word at which the relative error is the largest.
    at: u32,
}

impl Worst {
    fn of(word: u32, found: f32, truth: f64) -> Self {
        let absolute = (f64::from(found) - truth).abs() / U;
        let relative = if absolute == 0.0 { 0.0 } else { absolute / truth.abs() };
        let nan = |x: f64| if x.is_nan() { f64::INFINITY } else { x };
        Self { relative: nan(relative), absolute: nan(absolute), at: word }
    }

    fn or(self, other: Self) -> Self {
        let (larger, smaller) =
            if self.relative >= other.relative { (self, other) } else { (other, self) };
        Self { absolute: larger.absolute.max(smaller.absolute), ..larger }
    }
}

/// A function with its errors.
pub struct Measured {
    pub function: Function,
    pub own: Option<Worst>,
    pub built_in: Worst,
}

impl Measured {
    /// Whether what the kernel uses is worse than it may be.
    pub fn exceeds(&self) -> bool {
        self.own.unwrap_or(self.built_in).relative > self.function.bound
    }
}

/// sin 2πu and cos 2πu with the quadrant taken off exactly.
fn sincos(u: f64) -> (f64, f64) {
    let nearest = (4.0 * u + 0.5).floor();
    let (sine, cosine) = ((4.0 * u - nearest) * TAU / 4.0).sin_cos();
    match nearest {
        1.0 => (cosine, -sine),
        2.0 => (-sine, -cosine),
        3.0 => (-cosine, sine),
        _ => (sine, cosine),
    }
}

fn float(word: u32) -> f64 {
    f32::from_bits(word).into()
}

fn unit(word: u32) -> f64 {
    f64::from(word) * U
}

const ALL_U: &str = "all 2^24 multiples of 2^-24 in [0, 1)";
const ALL_WORDS_OF_U: Range<u32> = 0..1 << 24;

fn of_unit(
    name: &str,
    own: &str,
    built_in: &str,
    bound: f64,
    truth: impl Fn(f64) -> f64 + Sync + 'static,
) -> Function {
    Function {
        name: name.to_owned(),
        inputs: ALL_U,
        words: ALL_WORDS_OF_U,
        own: Some(own.to_owned()),
        built_in: built_in.to_owned(),
        truth: Box::new(move |word| truth(unit(word))),
        bound,
    }
}

fn of_float(
    name: &str,
    (inputs, words): (&'static str, Range<u32>),
    (own, built_in): (Option<&str>, &str),
    bound: f64,
    truth: impl Fn(f64) -> f64 + Sync + 'static,
) -> Function {
    Function {
        name: name.to_owned(),
        inputs,
        words,
        own: own.map(str::to_owned),
        built_in: built_in.to_owned(),
        truth: Box::new(move |word| truth(float(word))),
        bound,
    }
}

/// Everything that the kernel takes from its elementary functions, and the roots and quotients
/// that it takes from WGSL. Arguments and bounds are derived in DESIGN.md, "Elementary
/// functions".
fn functions() -> Vec<Function> {
    let to = |end: f32| end.to_bits() + 1;
    let below_one = ("all normal f32 in (0, 1)", 0x0080_0000..1_f32.to_bits());
    let depths = ("all f32 in [2^-58, 17]", 2_f32.powi(-58).to_bits()..to(17.0));
    let powers = ("all normal f32 in (0, 80]", 0x0080_0000..to(80.0));
    let mantissas = ("all f32 in [1, 4)", 1_f32.to_bits()..4_f32.to_bits());
    let mut all = vec![
        of_unit("sin 2πu", "sincos_2pi(u).x", "sin(6.283185307179586 * u)", 4.0, |u| sincos(u).0),
        of_unit("cos 2πu", "sincos_2pi(u).y", "cos(6.283185307179586 * u)", 4.0, |u| sincos(u).1),
        of_unit("-log(1-u), drawn", "minus_log_complement(u)", "-log(1.0 - u)", 4.5, |u| {
            -(-u).ln_1p()
        }),
        of_float(
            "-log(1-u), any",
            below_one,
            (Some("minus_log_complement(x)"), "-log(1.0 - x)"),
            6.6,
            |u| -(-u).ln_1p(),
        ),
        of_float(
            "1-exp(-x)",
            depths,
            (Some("one_minus_exp_minus(x)"), "1.0 - exp(-x)"),
            4.0,
            |x| -(-x).exp_m1(),
        ),
        of_float("exp(-x)", powers, (Some("exp_minus(x)"), "exp(-x)"), 3.0, |x| (-x).exp()),
    ];
    all.extend([0.0, 1.0, 100.0, 1e4, 1e6, 1e8, 1e10].map(versine));
    // WGSL's promise: sqrt is 1/inverseSqrt, so 2 units in the last place and 2.5.
    all.push(of_float("√x", mantissas.clone(), (None, "sqrt(x)"), 9.0, f64::sqrt));
    all.push(of_float("1/√x", mantissas, (None, "inverseSqrt(x)"), 4.0, |x| 1.0 / x.sqrt()));
    all.push(Function {
        name: "x/y".to_owned(),
        inputs: "2^26 pairs in [1, 2)",
        words: 0..1 << 26,
        own: None,
        built_in: "mantissa(word, 2654435761u) / mantissa(word, 2246822519u)".to_owned(),
        truth: Box::new(|word| mantissa(word, 2_654_435_761) / mantissa(word, 2_246_822_519)),
        bound: 5.0,
    });
    all
}

/// 1 - cosα of the Phong lobe with exponent `n`: cosα = (1 - u)^(1/(n+1)).
fn versine(n: f32) -> Function {
    let own = format!("one_minus_exp_minus(minus_log_complement(u) / ({n:?} + 1.0))");
    let power = format!("1.0 - pow(1.0 - u, 1.0 / ({n:?} + 1.0))");
    let name = format!("1-cosα, n = {n:e}");
    of_unit(&name, &own, &power, 14.5, move |u| -((-u).ln_1p() / (f64::from(n) + 1.0)).exp_m1())
}

fn mantissa(word: u32, factor: u32) -> f64 {
    float(0x3f80_0000 | word.wrapping_mul(factor) >> 9)
}

/// The text of an entry point that applies an expression to four words an invocation.
fn text(expression: &str) -> String {
    format!(
        "{MATH}
@group(0) @binding(4) var<storage, read> inputs: array<vec4<u32>>;
@group(0) @binding(5) var<storage, read_write> outputs: array<vec4<u32>>;

fn mantissa(word: u32, factor: u32) -> f32 {{
    return bitcast<f32>(0x3f800000u | (word * factor) >> 9u);
}}

fn value(word: u32) -> f32 {{
    let u = f32(word) * 5.9604644775390625e-8;
    let x = bitcast<f32>(word);
    return {expression};
}}

@compute @workgroup_size(64)
fn apply(@builtin(global_invocation_id) id: vec3<u32>) {{
    if id.x >= arrayLength(&outputs) {{ return; }}
    let word = inputs[0].x + 4u * id.x;
    outputs[id.x] = bitcast<vec4<u32>>(
        vec4<f32>(value(word), value(word + 1u), value(word + 2u), value(word + 3u)));
}}
"
    )
}

/// Goes through all functions; each is named on stderr, as all of them take minutes.
pub fn measure(adapter: &Adapter) -> Vec<Measured> {
    let gpu = open(adapter);
    let measured = |function: Function| {
        eprint!("\r{:40}", function.name);
        std::io::stderr().flush().expect("stderr");
        let (own, built_in) = worst(&gpu, &function);
        Measured { own: function.own.is_some().then_some(own), built_in, function }
    };
    let all = functions().into_iter().map(measured).collect();
    eprint!("\r{:40}\r", "");
    all
}

/// The worst errors of the kernel's way and of WGSL's.
fn worst(gpu: &Gpu, function: &Function) -> (Worst, Worst) {
    let ways = [function.own.as_ref().unwrap_or(&function.built_in), &function.built_in];
    let probes = ways.map(|way| {
        Probe::with_source(gpu, &Packed::default(), text(way)).expect("the device takes it")
    });
    let larger = |a: (Worst, Worst), b: (Worst, Worst)| (a.0.or(b.0), a.1.or(b.1));
    function.words.clone().step_by(CHUNK as usize).fold(Default::default(), |worst, first| {
        let count = CHUNK.min(function.words.end - first);
        let rows = count.div_ceil(4) as usize;
        let found = probes
            .each_ref()
            .map(|probe| probe.run("apply", &[[first, 0, 0, 0]], rows).expect("the device runs"));
        let errors = (0..count).into_par_iter().map(|i| {
            let truth = (function.truth)(first + i);
            let of = |rows: &Vec<Row>| {
                let bits = rows.as_flattened()[i as usize];
                Worst::of(first + i, f32::from_bits(bits), truth)
            };
            (of(&found[0]), of(&found[1]))
        });
        larger(worst, errors.reduce(Default::default, larger))
    })
}

pub fn print(all: &[Measured]) {
    println!("Worst errors in units of 2^-24, measured over all inputs; relative, and absolute");
    println!(
        "{:20} {:>11} {:>6} {:>9} {:>11} {:>9}  inputs",
        "", "kernel", "bound", "absolute", "built-in", "absolute"
    );
    for Measured { function, own, built_in } in all {
        let own = own.unwrap_or(*built_in);
        println!(
            "{:20} {:>11} {:>6.1} {:>9} {:>11} {:>9}  {}",
            function.name,
            short(own.relative),
            function.bound,
            short(own.absolute),
            short(built_in.relative),
            short(built_in.absolute),
            function.inputs
        );
    }
    for measured in all.iter().filter(|measured| measured.exceeds()) {
        println!(
            "{} exceeds its bound at the word {}",
            measured.function.name,
            measured.own.unwrap_or(measured.built_in).at
        );
    }
    println!();
}

/// An error in a few characters.
pub fn short(error: f64) -> String {
    if error < 1e4 { format!("{error:.2}") } else { format!("{error:.1e}") }
}
