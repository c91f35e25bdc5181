//! Kernels with one thing wrong: each must be rejected by the judge that is named, and
//! the right kernel must pass the same judge.

#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    #[allow(dead_code, reason = "of all judges, the exact one")]
    pub mod judge;
    pub mod kernel_judge;
    pub mod light_scenes;
    pub mod scenes;
    pub mod tracers;
    pub mod tree_mutants;
}

use candor::scene::Estimator::{self, Cosine, Explicit, Implicit, Mis};
use support::kernel_judge::Judge;
use support::tree_mutants::{Mutant, TREE_MUTANTS};

/// Of `implicit`: what is wrong, what stands in the kernel, and what takes its place.
const MUTANTS: &[(&str, &str, &str, Judge)] = &[
    ("no cosine", "2.0 * polar.y", "2.0", Judge::Classic),
    (
        "1 % of albedo",
        "scattering.weight * color",
        "scattering.weight * color * 1.01",
        Judge::Classic,
    ),
    (
        "a light returns 1",
        "(*path).radiance = (*path).throughput * color;",
        "(*path).radiance = (*path).throughput;",
        Judge::Classic,
    ),
    ("a bounce too few", "if bounce == BOUNCES {", "if bounce + 1u >= BOUNCES {", Judge::Classic),
    ("normal of the wrong side", "    return outward;", "    return -outward;", Judge::Classic),
    (
        "normal of the wrong side, inside",
        "select(outward, -outward,",
        "select(-outward, outward,",
        Judge::Hollow,
    ),
    ("way out", "(root - q.b) / q.leading", "(root + q.b) / q.leading", Judge::Hollow),
    ("far wall forgotten", "2.0 * abs(q.b) / q.leading", "abs(q.b) / q.leading", Judge::Hollow),
    ("the last of equal distances", "t < best.distance", "t <= best.distance", Judge::Coincident),
    ("n for n + 1", "/ (exponent + 1.0)", "/ exponent", Judge::Gloss),
    (
        "lobe under the horizon counted",
        "max(dot(normal, direction), 0.0)",
        "abs(dot(normal, direction))",
        Judge::Furnace,
    ),
    ("mirror direction", "incoming - 2.0 * dot", "incoming - 1.9 * dot", Judge::Gloss),
    (
        "sine of the lobe",
        "1.0));\n    return vec2<f32>(sqrt(t * (2.0 - t))",
        "1.0));\n    return vec2<f32>(sqrt(t * (1.0 - t))",
        Judge::Gloss,
    ),
    (
        "sine of the hemisphere",
        "sqrt((1.0 - u) * (1.0 + u))",
        "sqrt((1.0 - u) * (1.0 - u))",
        Judge::Classic,
    ),
    ("quadrant of the cosine", "((q + 1u) & 2u)", "(q & 2u)", Judge::Classic),
    ("quadrant of the sine", "-sine, (q & 2u)", "-sine, (q & 1u)", Judge::Classic),
    ("frame at the south", "axis.z >= 0.0", "axis.z >= -2.0", Judge::Classic),
    (
        "one block for all bounces",
        "random_bits(key, bounce + 1u)",
        "random_bits(key, 1u)",
        Judge::Classic,
    ),
    (
        "camera's block again",
        "random_bits(key, bounce + 1u)",
        "random_bits(key, bounce)",
        Judge::Classic,
    ),
    ("23 of 24 bits", "bits >> 8u", "bits >> 9u", Judge::Classic),
    (
        "picture upside down",
        "1.0 - 2.0 * (f32(pixel.y) + u.y)",
        "2.0 * (f32(pixel.y) + u.y) - 1.0",
        Judge::Classic,
    ),
    ("sign of the offset", "+ 2.0 * offset", "- 2.0 * offset", Judge::Classic),
    ("discriminant", "b * b - curvature * c", "b * b + curvature * c", Judge::Gloss),
    (
        "near side",
        "sqrt(max(q.discriminant, 0.0)) - q.b)",
        "sqrt(max(q.discriminant, 0.0)) + abs(q.c))",
        Judge::Classic,
    ),
    (
        "carry dropped",
        "return u32(before + addend < before) | (carry & u32(addend == 0u));",
        "return 0u;",
        Judge::Shell,
    ),
    (
        "carry of the value alone",
        "let addend = value + carry;",
        "let addend = value | carry;",
        Judge::Shell,
    ),
    ("film shift off by one", "190 - exponent - shift", "191 - exponent - shift", Judge::Shell),
    ("luminance weights exchanged", "13933u, 46871u", "46871u, 13933u", Judge::Shell),
    ("a carry in the luminance", "u32(low < base)", "0u", Judge::Shell),
    ("a bit of the square", "| (cross.x >> 31u)", "| (cross.x >> 30u)", Judge::Shell),
    ("green and blue exchanged", "add_pair(word + 3u, g)", "add_pair(word + 3u, b)", Judge::Shell),
    ("index without carry", "u32(low < id.z)", "0u", Judge::Divisions),
    ("seed ignored", "| block, scene.seed)", "| block, 0u)", Judge::Seeds),
];

/// Of the estimators beside `implicit`.
const OTHER_MUTANTS: &[Mutant] = &[
    (
        "sine of the cosine-weighted",
        Cosine,
        "vec2<f32>(sqrt(u), sqrt(1.0 - u))",
        "vec2<f32>(u, sqrt(1.0 - u * u))",
        Judge::Classic,
    ),
    (
        "cosine counted twice",
        Cosine,
        "f32 {\n    return 1.0;",
        "f32 {\n    return polar.y;",
        Judge::Classic,
    ),
    ("flat cone", Explicit, "/ (1.0 + sqrt(max(cosine2, 0.0)))", "/ 2.0", Judge::Classic),
    (
        "cosine of the half angle",
        Explicit,
        "(d - radius) * (d + radius)",
        "(d - radius) * (d - radius)",
        Judge::Classic,
    ),
    (
        "cone denser in the middle",
        Explicit,
        "let t = u * height;",
        "let t = u * u * height;",
        Judge::Classic,
    ),
    (
        "light under the horizon",
        Explicit,
        "2.0 * max(dot(normal, direction), 0.0)",
        "2.0 * abs(dot(normal, direction))",
        Judge::Classic,
    ),
    (
        "light's numbers used twice",
        Explicit,
        "unit_float(bits.z), unit_float(bits.w)",
        "unit_float(bits.x), unit_float(bits.y)",
        Judge::Classic,
    ),
    (
        "nothing hides",
        Explicit,
        "return first < distance || earlier <= distance;",
        "return false;",
        Judge::Classic,
    ),
    ("everything hides", Explicit, "root + abs(q.b)", "root + q.b", Judge::Classic),
    (
        "half a chance for one lamp",
        Explicit,
        "return Pick(LIGHT, 1.0);",
        "return Pick(LIGHT, 0.5);",
        Judge::Classic,
    ),
    ("lamp in view dark", Explicit, "select(0.0, 1.0, departure.alone)", "0.0", Judge::Classic),
    ("light counted twice", Explicit, "select(0.0, 1.0, departure.alone)", "1.0", Judge::Classic),
    (
        "a connection too few",
        Explicit,
        "if bounce == BOUNCES {",
        "if bounce + 1u >= BOUNCES {",
        Judge::Classic,
    ),
    (
        "last gloss forgotten",
        Explicit,
        "bounce == BOUNCES && !departure.alone",
        "bounce == BOUNCES",
        Judge::Classic,
    ),
    ("nothing after gloss", Explicit, "!samples_light_at(hit.sphere))", "false)", Judge::Hollow),
    (
        "lights sampled at gloss too",
        Explicit,
        "return spheres[sphere].kind == KIND_DIFFUSE;",
        "return true;",
        Judge::Hollow,
    ),
    ("sides of the sun", Explicit, "g * -inverseSqrt(g2)", "g * inverseSqrt(g2)", Judge::Sun),
    ("offset of the sun", Explicit, "position) + 2.0 * offset;", "position) + offset;", Judge::Sun),
    ("the sun's curvature", Explicit, "curvature * twice_f / g2", "twice_f / g2", Judge::Sun),
    ("a light from inside", Explicit, "return Cone(normal, 1.0);", "return outer;", Judge::Inside),
    ("far side of a light", Explicit, "exit(q, false)", "exit(q, true)", Judge::Inside),
    ("chance forgotten", Explicit, " / pick.chance", "", Judge::Lamps),
    (
        "brightness alone",
        Explicit,
        "return cone.height * largest_cosine(cone, point.normal) * max(",
        "return max(",
        Judge::Lamps,
    ),
    (
        "never evenly",
        Explicit,
        "0.5 * (potential / total + even)",
        "potential / total",
        Judge::Lamps,
    ),
    (
        "side of the cone",
        Explicit,
        "cos_theta * cos_sigma + sines",
        "cos_theta * cos_sigma - sines",
        Judge::Lamps,
    ),
    (
        "pick with the camera's numbers",
        Explicit,
        "PICK_BLOCKS: u32 = 128u",
        "PICK_BLOCKS: u32 = 0u",
        Judge::Lamps,
    ),
    (
        "first light always",
        Explicit,
        "unit_float(random_bits(key, PICK_BLOCKS + bounce).x)",
        "0.0 * unit_float(random_bits(key, PICK_BLOCKS + bounce).x)",
        Judge::Crowd,
    ),
    (
        "walls hide as balls",
        Explicit,
        "let q = anchored(ray, s.position, s.offset, s.size);",
        "let q = factored(ray, s.position, s.size);",
        Judge::Crowd,
    ),
    (
        "some are not asked",
        Explicit,
        "s.size), i, leaving), MISS, i == light)",
        "s.size), i, leaving), MISS, i >= light)",
        Judge::Crowd,
    ),
    (
        "no heuristic for lights",
        Mis,
        "fn share_of_sampled(x: f32) -> f32 {\n    return x / (1.0 + x * x);",
        "fn share_of_sampled(x: f32) -> f32 {\n    return x;",
        Judge::Classic,
    ),
    (
        "balance for lights, power for hits",
        Mis,
        "fn share_of_sampled(x: f32) -> f32 {\n    return x / (1.0 + x * x);",
        "fn share_of_sampled(x: f32) -> f32 {\n    return x / (1.0 + x);",
        Judge::Classic,
    ),
    (
        "no heuristic for hits",
        Mis,
        "select(x * share_of_sampled(x), 1.0, departure.alone)",
        "1.0",
        Judge::Classic,
    ),
    (
        "light in view weighed",
        Mis,
        "select(x * share_of_sampled(x), 1.0, departure.alone)",
        "x * share_of_sampled(x)",
        Judge::Classic,
    ),
    (
        "density of the uniform",
        Mis,
        "f32 {\n    return 2.0 * polar.y;",
        "f32 {\n    return 1.0;",
        Judge::Classic,
    ),
    ("hits forget the chance", Mis, " / chance_of(light, point)", "", Judge::Lamps),
    (
        "lobe drawn without its cosine",
        Mis,
        "min((1.0 - u) / max(polar.y, 1.0 - u), 1.0)",
        "(1.0 - u)",
        Judge::Lobes,
    ),
    ("n for n + 1", Mis, "(exponent + 1.0) * lobe", "exponent * lobe", Judge::Lobes),
    ("versine twice", Mis, "0.5 * dot(off, off)", "dot(off, off)", Judge::Lobes),
    ("lobe behind the mirror", Mis, "select(density, 0.0, t >= 1.0)", "density", Judge::Lobes),
    (
        "gloss as chalk",
        Mis,
        "select(diffuse.density, glossy.density, is_glossy)",
        "diffuse.density",
        Judge::Hollow,
    ),
    (
        "weight of gloss",
        Mis,
        "select(diffuse.weight, glossy.weight, is_glossy)",
        "diffuse.weight",
        Judge::Hollow,
    ),
];

/// Whether the judge accepts the kernel with `to` in place of `from`; says so.
fn survives(name: &str, estimator: Estimator, from: &str, to: &str, judge: Judge) -> bool {
    let change = |kernel: &str| {
        assert_eq!(kernel.matches(from).count(), 1, "{name}: {from:?} in the kernel");
        kernel.replace(from, to)
    };
    let survives = judge.accepts(estimator, &change);
    let (judge, verdict) = (format!("{judge:?}"), if survives { "SURVIVES" } else { "rejected" });
    println!("{name:<36}{:<10}{judge:<12}{verdict}", estimator.name());
    survives
}

fn all() -> impl Iterator<Item = Mutant> {
    let ours = MUTANTS.iter().map(|&(name, from, to, judge)| (name, Implicit, from, to, judge));
    ours.chain([OTHER_MUTANTS, TREE_MUTANTS].concat())
}

#[test]
fn every_mutant_is_rejected() {
    let survivors: Vec<&str> = all()
        .filter(|&(name, estimator, from, to, judge)| survives(name, estimator, from, to, judge))
        .map(|mutant| mutant.0)
        .collect();
    assert!(survivors.is_empty(), "accepted: {survivors:?}");
}

#[test]
fn the_right_kernel_is_accepted() {
    let mut accepted = Vec::new();
    for (_, estimator, _, _, judge) in all() {
        if !accepted.contains(&(estimator, judge)) {
            assert!(judge.accepts(estimator, &str::to_owned), "{estimator:?} {judge:?}");
            accepted.push((estimator, judge));
        }
    }
}
