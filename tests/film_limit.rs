//! The film at its stated limit of 2³² samples: the largest samples, added on the device
//! up to the last one, and what the tracers refuse beyond.

mod support {
    pub mod bare;
    pub mod gpu;
    pub mod scenes;
    pub mod tracers;
}

use bytemuck::Zeroable;
use candor::film::{Film, FilmError, PixelSums, PixelWords, RangeError, SampleScale, WORDS};
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{layout, probe_source};
use candor::scene::MAX_SPP;
use candor::tracer::{TraceError, Tracer};
use support::{bare, gpu, scenes, tracers};

/// Samples that the device adds in one go.
const LAST: u64 = 1 << 16;

/// The bound whose samples fill the film most: all bits of a float's mantissa are ones.
fn fullest() -> SampleScale {
    let scale = SampleScale::from_bound(f64::from(8_f32.next_down()));
    assert_eq!(scale.bound().to_bits() & 0x007f_ffff, 0x007f_ffff);
    scale
}

/// The words of `samples` times the same sample, without a wrap anywhere.
fn repeated(rgb: [f32; 3], samples: u64, scale: SampleScale) -> PixelWords {
    let mut once = PixelSums::of(&[0; WORDS]);
    once.add(rgb, scale);
    let sums = candor::film::sums(&once.words()).map(|sum| sum * u128::from(samples));
    assert!(sums[..3].iter().all(|&sum| sum < 1 << 96), "a channel has 96 bits");
    let mut words = [0; WORDS];
    for (sum, place) in std::iter::zip(sums, [0..3, 3..6, 6..9, 9..13]) {
        for (k, word) in words[place].iter_mut().enumerate() {
            *word = u32::try_from(sum >> (32 * k) & 0xffff_ffff).expect("a word");
        }
    }
    words
}

/// Samples near the bound and near the film's step, one pixel each.
fn samples(scale: SampleScale) -> Vec<[f32; 3]> {
    let (most, half) = (scale.bound(), scale.bound() / 2.0);
    #[expect(clippy::cast_possible_truncation, reason = "a power of two")]
    let step = scale.step() as f32;
    vec![
        [most; 3],
        [most, half, 0.0],
        [half.next_up(), most, most.next_down()],
        [step; 3],
        [most, step, half.next_down()],
    ]
}

/// The film of one pixel per sample after the last of `total` samples, of which the device
/// adds [`LAST`] with this text of the kernel; and what it must be.
fn at(total: u64, wgsl: String) -> (Vec<PixelWords>, Vec<PixelWords>) {
    let scale = fullest();
    let samples = samples(scale);
    let words = |count| samples.iter().map(move |&rgb| repeated(rgb, count, scale));
    let header = layout::Scene { film_shift: scale.shift(), ..layout::Scene::zeroed() };
    let scene = bare::bare(header, Vec::new());
    let gpu = gpu::open();
    let probe = Probe::with_source(&gpu, &scene, wgsl).expect("the probe compiles");
    let rows: Vec<Row> = (0..LAST)
        .flat_map(|_| std::iter::zip(&samples, 0..))
        .map(|([r, g, b], pixel)| [r.to_bits(), g.to_bits(), b.to_bits(), pixel])
        .collect();
    let before: Vec<PixelWords> = words(total - LAST).collect();
    let found = probe.add_to_film(&before, &rows).expect("the device runs");
    (found, words(total).collect())
}

/// Across powers of two, and to the last sample of all.
#[test]
fn sums_are_exact_up_to_the_last_sample() {
    for exponent in [16, 20, 24, 28, 31, 32] {
        // Across the power of two, but for the limit, which ends it.
        let total = (1_u64 << exponent) + if exponent < 32 { LAST / 2 } else { 0 };
        let (found, expected) = at(total.min(MAX_SPP), probe_source());
        assert_eq!(found, expected, "{total} samples");
    }
    // At the limit the largest samples leave no room for as many again.
    let (found, _) = at(MAX_SPP, probe_source());
    assert!(found[0][2] > u32::MAX / 2 && found[0][12] > u32::MAX / 2, "{:x?}", found[0]);
}

/// Each carry into a top word, and the one through a word of ones, is needed: a kernel that
/// drops it is told at the limit.
#[test]
fn a_dropped_carry_is_told() {
    let text = probe_source();
    let faults = [
        ("into the red sum's top", "add_pair(word, r) << 2u", "(add_pair(word, r) & 0u) << 2u"),
        ("into the green sum's top", "add_pair(word + 3u, g) << 5u", "0u * add_pair(word + 3u, g)"),
        ("into the blue sum's top", "add_pair(word + 6u, b) << 8u", "0u * add_pair(word + 6u, b)"),
        (
            "out of the lowest word",
            "add_word(word, value.x, 0u)",
            "0u * add_word(word, value.x, 0u)",
        ),
    ];
    for (name, from, to) in faults {
        check_dropped(&text, name, from, to);
    }
    for word in [2, 5, 8, 12] {
        let from = format!("add_carry(word + {word}u, carries >> {word}u);");
        check_dropped(&text, &format!("into word {word}"), &from, "");
    }
}

fn check_dropped(text: &str, name: &str, from: &str, to: &str) {
    assert_eq!(text.matches(from).count(), 1, "occurrences of {from:?}");
    let (found, expected) = at(MAX_SPP, text.replace(from, to));
    assert_ne!(found, expected, "a carry {name} is dropped and nobody sees it");
}

/// Both tracers refuse a sample beyond the limit before they trace one, and the film stays
/// as it was.
#[test]
fn tracers_refuse_one_sample_more() {
    let scene = scenes::classic(scenes::size(4, 2));
    let tracers: [Box<dyn Tracer>; 2] =
        [Box::new(tracers::on_device(&scene)), Box::new(tracers::twin(&scene))];
    for mut tracer in tracers {
        tracer.add_samples(0..16).expect("a few samples");
        let before: Film = tracer.film().expect("a film");
        let error = tracer.add_samples(16..MAX_SPP + 1).expect_err("one sample too many");
        let TraceError::Film(FilmError::Range(RangeError::TooMany(count))) = error else {
            panic!("{error}");
        };
        assert_eq!(count, MAX_SPP + 1);
        assert!(tracer.film().expect("a film") == before, "changed by a refusal");
    }
}
