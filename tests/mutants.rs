//! Kernels with one thing wrong: each must be rejected by the judge that is named, and
//! the right kernel must pass the same judge.

#![expect(clippy::single_range_in_vec_init, reason = "one way of dividing the samples")]

mod support {
    pub mod gpu;
    #[allow(dead_code, reason = "of all judges, the exact one")]
    pub mod judge;
    pub mod scenes;
    pub mod tracers;
}

use candor::estimate::pair;
use candor::film::Film;
use candor::scene::Scene;
use candor::verify::{ALPHA, MAX_BIAS};
use std::sync::OnceLock;
use support::judge::is_exactly;
use support::scenes::{classic, diffuse, emitter, glossy, seen, size, sphere, with_seed};
use support::tracers::{film, kernel, trace, twin, with_kernel};

/// What tells a wrong kernel from the right one.
#[derive(Debug, Clone, Copy)]
enum Judge {
    /// The twin's picture of the same samples: the classic scene.
    Classic,
    /// The same inside a hollow sphere.
    Hollow,
    /// The same under glossy spheres and on a glossy floor.
    Gloss,
    /// The same with a glossy ball in a shell of light.
    Furnace,
    /// Every sample is one radiance: a shell of dim light, in a scene with a lamp so
    /// bright that the film's words carry.
    Shell,
    /// Every sample is one radiance: a lamp and a wall in the same place.
    Coincident,
    /// One range of samples in one call and in parts, across index 2^32.
    Divisions,
    /// Pictures of two seeds.
    Seeds,
}

const SHELL: [f32; 3] = [0.3, 0.7, 0.011];

fn shell() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 2.0, emitter(SHELL.map(f64::from))),
        sphere([0.0, 9.0, 0.0], 1.0, emitter([1e8; 3])),
    ];
    seen([0.5, 0.0, 0.0], [0.0, 1.0, 0.0], size(5, 3), 2, spheres)
}

fn coincident() -> Scene {
    // The lamp is in front by less than the device's coordinates tell.
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 1.0 + 1e-12, emitter([3.0; 3])),
        sphere([0.0, 0.0, 0.0], 1.0, diffuse(0.5)),
    ];
    seen([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], size(5, 3), 2, spheres)
}

fn hollow() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 5.0, diffuse(0.7)),
        sphere([0.0, 2.5, 0.0], 1.5, emitter([6.0, 5.0, 4.0])),
        sphere([-1.5, -1.0, -2.0], 1.2, glossy(0.9, 20.0)),
    ];
    seen([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], size(32, 32), 3, spheres)
}

fn furnace() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 1.0, glossy(0.9, 2.0)),
        sphere([0.0, 0.0, 0.0], 9.0, emitter([2.0, 1.0, 0.5])),
    ];
    seen([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], size(32, 32), 1, spheres)
}

fn gloss() -> Scene {
    let mut spheres = vec![
        sphere([0.0, 5.0, 0.0], 2.5, emitter([5.0, 5.0, 5.0])),
        sphere([0.0, -101.0, 0.0], 100.0, glossy(0.8, 2.0)),
    ];
    for (x, n) in [(-3.0, 1.0), (-1.0, 5.0), (1.0, 20.0), (3.0, 1e4)] {
        spheres.push(sphere([x, 0.0, 0.0], 1.0, glossy(0.95, n)));
    }
    seen([0.0, 2.0, 9.0], [0.0, 0.5, 0.0], size(32, 32), 3, spheres)
}

impl Judge {
    fn scene(self) -> Scene {
        match self {
            Self::Classic | Self::Seeds => classic(size(32, 32)),
            Self::Hollow => hollow(),
            Self::Gloss => gloss(),
            Self::Furnace => furnace(),
            Self::Shell => shell(),
            Self::Coincident => coincident(),
            Self::Divisions => classic(size(3, 2)),
        }
    }

    /// Whether the kernel passes.
    fn accepts(self, change: &dyn Fn(&str) -> String) -> bool {
        let scene = self.scene();
        let mut tracer = with_kernel(&scene, &change(&kernel(&scene)));
        match self {
            Self::Classic | Self::Hollow | Self::Gloss | Self::Furnace => {
                let (found, ledger) = trace(&mut tracer, &[0..256]);
                let paired = pair(&found, self.twin());
                ledger.count == 0 && paired.is_within(MAX_BIAS, ALPHA)
            }
            Self::Shell => is_exactly(&film(&mut tracer, &[0..300]), SHELL, 300),
            Self::Coincident => {
                let centre = film(&mut tracer, &[0..64]);
                is_exactly(&only(&centre, 7), [3.0; 3], 64)
            }
            Self::Divisions => {
                let edge = 1_u64 << 32;
                let whole = film(&mut tracer, &[edge - 9..edge + 32]);
                let mut again = with_kernel(&scene, &change(&kernel(&scene)));
                whole == film(&mut again, &[edge..edge + 32, edge - 9..edge])
            }
            Self::Seeds => {
                let other = with_seed(&scene, 1);
                let mut other = with_kernel(&other, &change(&kernel(&other)));
                film(&mut tracer, &[0..16]).pixels() != film(&mut other, &[0..16]).pixels()
            }
        }
    }

    /// The twin's film of this scene, traced once.
    fn twin(self) -> &'static Film {
        static FILMS: [OnceLock<Film>; 4] = [const { OnceLock::new() }; 4];
        FILMS[self as usize].get_or_init(|| film(&mut twin(&self.scene()), &[0..256]))
    }
}

/// One pixel of a film as a film.
fn only(film: &Film, pixel: usize) -> Film {
    let mut one = Film::awaiting(size(1, 1), film.scale(), film.samples().clone());
    one.pixels_mut()[0] = film.pixels()[pixel];
    one
}

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
        "Sample(throughput * color, true)",
        "Sample(throughput, true)",
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
    ("n for n + 1", "(exponent + 1.0)", "(exponent)", Judge::Gloss),
    (
        "lobe under the horizon counted",
        "max(dot(normal, direction), 0.0)",
        "abs(dot(normal, direction))",
        Judge::Furnace,
    ),
    ("mirror direction", "incoming - 2.0 * dot", "incoming - 1.9 * dot", Judge::Gloss),
    ("sine of the lobe", "sqrt(t * (2.0 - t))", "sqrt(t * (1.0 - t))", Judge::Gloss),
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

#[test]
fn every_mutant_is_rejected() {
    let mut survivors = Vec::new();
    for &(name, from, to, judge) in MUTANTS {
        let change = |kernel: &str| {
            assert_eq!(kernel.matches(from).count(), 1, "{name}: {from:?} in the kernel");
            kernel.replace(from, to)
        };
        let survives = judge.accepts(&change);
        println!(
            "{name:<36}{:<12}{}",
            format!("{judge:?}"),
            if survives { "SURVIVES" } else { "rejected" }
        );
        if survives {
            survivors.push(name);
        }
    }
    assert!(survivors.is_empty(), "accepted: {survivors:?}");
}

#[test]
fn the_right_kernel_is_accepted() {
    for judge in [
        Judge::Classic,
        Judge::Hollow,
        Judge::Gloss,
        Judge::Furnace,
        Judge::Shell,
        Judge::Coincident,
        Judge::Divisions,
        Judge::Seeds,
    ] {
        assert!(judge.accepts(&str::to_owned), "{judge:?}");
    }
}
