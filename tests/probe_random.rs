//! Random numbers on the device: the twin's bits, and unit floats that never reach 1.

mod support {
    pub mod bare;
    pub mod gpu;
}

use candor::cpu::rng::{pcg4d, unit_float};
use candor::gpu::probe::{Probe, Row};

/// The reference of Jarzynski & Olano once more, in 64-bit arithmetic modulo 2³².
fn pcg4d_in_u64(key: Row) -> Row {
    const WORD: u64 = 1 << 32;
    let mut v = key.map(|k| (u64::from(k) * 1_664_525 + 1_013_904_223) % WORD);
    for round in 0..2 {
        for (i, a, b) in [(0, 1, 3), (1, 2, 0), (2, 0, 1), (3, 1, 2)] {
            v[i] = (v[i] + v[a] * v[b] % WORD) % WORD;
        }
        if round == 0 {
            v = v.map(|x| x ^ (x / 65_536));
        }
    }
    v.map(|x| u32::try_from(x).expect("below 2^32"))
}

/// Computed with whole numbers of any size from the paper's listing.
const KNOWN: [(Row, Row); 4] = [
    ([0; 4], [0x0f02_f829, 0x2d56_8769, 0x32b0_c43b, 0xd325_48ea]),
    ([1, 2, 3, 4], [0x3622_cd16, 0xf114_71d8, 0xe110_9b3f, 0x02b9_4c2f]),
    ([u32::MAX; 4], [0x974e_d892, 0xc015_dc67, 0x9f95_5760, 0xa1bb_a208]),
    (
        [0x0003_ffff, 0xdead_beef, 0x0102_0304, 0x8000_0000],
        [0x8c90_666d, 0x33a6_ff55, 0x3189_5082, 0x1a8f_7359],
    ),
];

/// Every word among the values at which carries and shifts turn, then a million keys
/// that a generator of another kind draws.
fn keys() -> Vec<Row> {
    let edges = [0, 1, 0xffff, 0x1_0000, 0x7fff_ffff, 0x8000_0000, u32::MAX];
    let pick = |n: usize, place: u32| edges[n / 7_usize.pow(place) % 7];
    let mut keys: Vec<Row> =
        (0..7_usize.pow(4)).map(|n| std::array::from_fn(|i| pick(n, [0, 1, 2, 3][i]))).collect();
    let mut state = 0x9e37_79b9_7f4a_7c15_u64;
    let mut word = || {
        // Knuth's 64-bit linear congruence; its high half is what is good in it.
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        u32::try_from(state >> 32).expect("the high half")
    };
    keys.extend((0..1 << 20).map(|_| [word(), word(), word(), word()]));
    keys
}

#[test]
fn pcg4d_gives_the_same_bits_everywhere() {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &support::bare::nothing()).expect("the probe compiles");
    let known: Vec<Row> = KNOWN.iter().map(|row| row.0).collect();
    let answers: Vec<Row> = KNOWN.iter().map(|row| row.1).collect();
    assert_eq!(probe.run("probe_pcg4d", &known, known.len()).expect("it runs"), answers);
    let keys = keys();
    let device = probe.run("probe_pcg4d", &keys, keys.len()).expect("the device runs");
    for (key, bits) in keys.iter().zip(device) {
        assert_eq!(bits, pcg4d(*key), "key {key:x?}");
        assert_eq!(bits, pcg4d_in_u64(*key), "key {key:x?}");
    }
}

/// Patterns whose unit floats are told apart with difficulty: the ends, the halves, and
/// every run of 2^8 patterns that share one float at either end.
fn patterns() -> Vec<u32> {
    let mut patterns: Vec<u32> = (0..1024).chain(u32::MAX - 1023..=u32::MAX).collect();
    patterns.extend((0..32).flat_map(|bit| [1 << bit, (1_u32 << bit) - 1, !(1 << bit)]));
    patterns.extend((0..1 << 20).map(|n: u32| n.wrapping_mul(0x9e37_79b1)));
    patterns.resize(patterns.len().next_multiple_of(4), 0);
    patterns
}

/// Whether `u` is the top 24 bits of `bits` in units of 2^-24, and below 1.
fn is_unit_float(u: f32, bits: u32) -> bool {
    let steps = f64::from(u) * f64::from(1 << 24);
    u < 1.0 && (steps - f64::from(bits >> 8)).abs() == 0.0
}

#[test]
fn unit_floats_are_exact_and_never_one() {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &support::bare::nothing()).expect("the probe compiles");
    let patterns = patterns();
    let rows: &[Row] = bytemuck::cast_slice(&patterns);
    let device = probe.run("probe_unit_float", rows, rows.len()).expect("the device runs");
    for (&bits, &result) in patterns.iter().zip(device.as_flattened()) {
        let u = f32::from_bits(result);
        assert!(is_unit_float(u, bits), "{bits:#x} became {u}");
        assert_eq!(f64::from(u).to_bits(), unit_float(bits).to_bits(), "the twin at {bits:#x}");
    }
}

/// All 32 bits scaled at once round the largest up to 1.
#[test]
#[expect(clippy::cast_precision_loss, reason = "the fault that is shown")]
fn scaling_all_bits_is_rejected() {
    let scaled = |bits: u32| bits as f32 * 2.0_f32.powi(-32);
    assert!(!is_unit_float(scaled(u32::MAX), u32::MAX));
    assert!(!is_unit_float(scaled(u32::MAX - 127), u32::MAX - 127));
    assert!(patterns().iter().any(|&bits| scaled(bits) >= 1.0));
}
