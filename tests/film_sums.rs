//! The exact film's arithmetic: the device's integers against the host's, carries, and
//! what ends up in the estimates.

#![expect(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    reason = "samples are made in f32, from small numbers or with what 24 bits hold"
)]

mod support {
    pub mod bare;
    pub mod gpu;
}

use bytemuck::Zeroable;
use candor::cpu::rng::{SampleKey, random_bits};
use candor::estimate::estimate;
use candor::film::{
    Film, PixelSums, PixelWords, SampleRanges, SampleScale, WORDS, luminance, square, sums,
    to_fixed,
};
use candor::gpu::probe::{Probe, Row};
use candor::kernel::{Packed, layout};
use candor::scene::ImageSize;
use support::bare::bare;

/// A film of one pixel.
fn one_pixel(scale: SampleScale, samples: u64, words: PixelWords) -> Film {
    let mut ranges = SampleRanges::default();
    ranges.insert(0..samples).expect("a few samples");
    let mut film = Film::awaiting(ImageSize::new(1, 1).expect("a size"), scale, ranges);
    film.pixels_mut()[0] = words;
    film
}

fn random(index: u64) -> [u32; 4] {
    random_bits(SampleKey { pixel: 5, index }, 0, 0)
}

/// Three channels and a shift: for every shift that a bound can lead to, the largest
/// value that fits, and others down to the last bit, subnormals and zero.
fn fixed_point_rows() -> Vec<Row> {
    let mut rows = Vec::new();
    for shift in -64..=189_i32 {
        let top = (127 + 63 - shift).clamp(0, 254).cast_unsigned();
        let value =
            |down: u32, mantissa: u32| top.saturating_sub(down) << 23 | (mantissa & 0x7f_ffff);
        for down in 0..70 {
            let [a, b, c, d] = random(rows.len() as u64);
            let shift = shift.cast_unsigned();
            rows.push([value(down, u32::MAX), value(down, 0), value(down, a), shift]);
            rows.push([value(d % 70, b), value(down, c), value(d % 7, a), shift]);
            rows.push([value(down, 1), a & 0x7f_ffff, 0, shift]);
        }
    }
    rows
}

/// What `probe_fixed` writes, from the host's integers.
fn fixed_point(row: &Row) -> [Row; 3] {
    let [r, g, b, shift] = *row;
    let channels = [r, g, b].map(|x| to_fixed(f32::from_bits(x), shift.cast_signed()));
    let y = luminance(channels);
    let words =
        |x: u128| [0, 32, 64].map(|at| u32::try_from(x >> at & 0xffff_ffff).expect("a word"));
    let [r, g, b] = channels.map(|x| words(x.into()));
    let (y, squared) = (words(y.into()), words(square(y)));
    [[r[0], r[1], g[0], g[1]], [b[0], b[1], y[0], y[1]], [squared[0], squared[1], squared[2], 0]]
}

#[test]
fn the_device_and_the_host_make_the_same_integers() {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &support::bare::nothing()).expect("the probe compiles");
    let rows = fixed_point_rows();
    let device = probe.run("probe_fixed", &rows, 3 * rows.len()).expect("the device runs");
    for (row, found) in rows.iter().zip(device.as_chunks::<3>().0) {
        assert_eq!(*found, fixed_point(row), "{row:x?}");
    }
    // A shift that is off by one does not pass.
    let off = |row: &Row| fixed_point(&[row[0], row[1], row[2], row[3].wrapping_sub(1)]);
    let wrong =
        rows.iter().zip(device.as_chunks::<3>().0).filter(|(row, found)| **found != off(row));
    assert!(wrong.count() > rows.len() / 2);
}

/// A third way to the host's integers: an `f64` holds x·2^shift exactly.
#[test]
#[expect(clippy::cast_sign_loss, reason = "not negative")]
fn fixed_point_truncates() {
    for row in fixed_point_rows() {
        let (x, shift) = (f32::from_bits(row[2]), row[3].cast_signed());
        let exact = if x.is_normal() { f64::from(x) * f64::from(shift).exp2() } else { 0.0 };
        assert_eq!(to_fixed(x, shift), exact.trunc() as u64, "{x:e}·2^{shift}");
    }
}

/// A scene for `add_sample`: it reads the shift alone.
fn scene_with(scale: SampleScale) -> Packed {
    let header = layout::Scene { film_shift: scale.shift(), ..layout::Scene::zeroed() };
    bare(header, Vec::new())
}

/// The words after every row (r, g, b, pixel) was added on the host, in 128-bit sums.
fn added(film: &[PixelWords], rows: &[Row], scale: SampleScale) -> Vec<PixelWords> {
    let mut sums: Vec<PixelSums> = film.iter().map(PixelSums::of).collect();
    for &[r, g, b, pixel] in rows {
        sums[pixel as usize].add([r, g, b].map(f32::from_bits), scale);
    }
    sums.into_iter().map(PixelSums::words).collect()
}

fn check_adding(film: &[PixelWords], rows: &[Row], scale: SampleScale) {
    let gpu = support::gpu::open();
    let probe = Probe::new(&gpu, &scene_with(scale)).expect("the probe compiles");
    let found = probe.add_to_film(film, rows).expect("the device runs");
    let expected = added(film, rows, scale);
    assert_eq!(found, expected);
    // The judge sees a single carry that is lost.
    let mut lost = found;
    lost[0][2] = lost[0][2].wrapping_sub(1);
    assert_ne!(lost, expected);
}

/// All low words one step from a carry, the top words free: every carry ripples on.
fn brimming() -> PixelWords {
    const M: u32 = u32::MAX;
    [M, M, 0, M, M, 7, M, M, 0x7fff_fffe, M, M, M, 1]
}

#[test]
fn carries_ripple_through_words_of_ones() {
    let scale = SampleScale::from_bound(1e8);
    // From the smallest sample that leaves a bit to the bound, one pixel each.
    let values: Vec<f32> = (-36..27).map(|e| f32::exp2(0.3 + 0.99 * e as f32)).collect();
    let film = vec![brimming(); values.len()];
    let rows: Vec<Row> = values
        .iter()
        .zip(0..)
        .map(|(x, pixel)| [x.to_bits(), x.to_bits(), 0x3f80_0000, pixel])
        .collect();
    check_adding(&film, &rows, scale);
}

#[test]
fn carries_survive_contention() {
    let scale = SampleScale::from_bound(1e8);
    // 2^16 samples in three pixels, one of them under most of the load.
    let row = |i: u32| {
        let [a, b, c, d] = random(u64::from(i));
        // Any exponent from the film's step to the bound.
        let float = |bits: u32| (90 + bits % 63) << 23 | (bits >> 9);
        [float(a), float(b), float(c), if d % 8 == 0 { 1 + d / 8 % 2 } else { 0 }]
    };
    let rows: Vec<Row> = (0..1 << 16).map(row).collect();
    check_adding(&[brimming(); 3], &rows, scale);
    // One and the same sample, so that all carries come at once.
    let rows = vec![[0x4000_0001, 0x4000_0001, 0x3200_0001, 0]; 1 << 16];
    check_adding(&[brimming()], &rows, scale);
}

/// Channels whose integer luminance is near `y`, made of what 24 bits can hold.
fn channels_of(y: u128, shift: i32) -> [f32; 3] {
    let mut rest = y << 16;
    let mut channel = |weight: u128| {
        let share = rest / weight;
        let drop = (128 - share.leading_zeros()).saturating_sub(24);
        let kept = share >> drop << drop;
        rest -= kept * weight;
        (kept as f64 * f64::from(-shift).exp2()) as f32
    };
    let g = channel(46_871);
    let r = channel(13_933);
    [r, g, channel(4_732)]
}

/// Squares whose middle word is all ones: with a carry from below, its sum is zero and
/// the carry goes through.
#[test]
fn a_word_of_ones_that_takes_a_carry_passes_it_on() {
    let scale = SampleScale::from_bound(1e8);
    let mut rows = Vec::new();
    for k in 1..4096_u128 {
        let y = ((k << 96) - 1).isqrt();
        let rgb = channels_of(y, scale.shift());
        let y = luminance(rgb.map(|x| to_fixed(x, scale.shift())));
        if square(y) >> 32 & 0xffff_ffff == 0xffff_ffff && scale.admits(rgb) {
            let [r, g, b] = rgb.map(f32::to_bits);
            rows.push([r, g, b, u32::try_from(rows.len()).expect("a few")]);
        }
    }
    println!("{} samples whose square has a middle word of ones", rows.len());
    assert!(rows.len() > 100);
    check_adding(&vec![brimming(); rows.len()], &rows, scale);
}

#[test]
fn constant_samples_have_no_variance() {
    for index in 0..2000 {
        let [a, b, c, d] = random(index);
        let scale = SampleScale::from_bound(f64::from(1 + d % 1000));
        let rgb = [a, b, c].map(|x| f32::from_bits(0x3780_0000 + x % 0x0800_0000));
        let mut sums = PixelSums::of(&[0; WORDS]);
        let samples = 2 + u64::from(d % 97);
        for _ in 0..samples {
            sums.add(rgb, scale);
        }
        let variance = |words| estimate(&one_pixel(scale, samples, words), &words).variance;
        assert_eq!(variance(sums.words()).to_bits(), 0, "{rgb:?}");
        // One sample that differs by 2^-9 is seen.
        sums.add(rgb.map(|x| x * (1.0 + 1.0 / 512.0)), scale);
        let words = sums.words();
        assert!(estimate(&one_pixel(scale, samples + 1, words), &words).variance > 0.0, "{rgb:?}");
    }
}

/// A lamp of radiance 1e8 in view and a wall of radiance 1e-3 beside it, 2^32 samples:
/// the wall's mean to 1e-6 and its variance to 1e-3.
#[test]
fn a_dim_wall_beside_a_bright_lamp_keeps_its_digits() {
    // Two bounces off a white wall: 4 times the lamp.
    let scale = SampleScale::from_bound(4e8);
    let values: Vec<f32> =
        (0..256).map(|i| if i % 4 == 0 { 4e-3 * (1.0 + i as f32 / 1e3) } else { 0.0 }).collect();
    let mut sums = PixelSums::of(&[0; WORDS]);
    for &x in &values {
        sums.add([x; 3], scale);
    }
    let mut film = one_pixel(scale, 256, sums.words());
    // Doubled until 2^32 samples: the same 256 again and again.
    while film.samples().count() < 1 << 32 {
        let samples = film.samples().count();
        let mut next = SampleRanges::default();
        next.insert(samples..2 * samples).expect("new samples");
        let mut other = Film::awaiting(film.size(), scale, next);
        other.pixels_mut()[0] = film.pixels()[0];
        film.merge(&other).expect("disjoint samples");
    }
    let found = estimate(&film, &film.pixels()[0]);
    let mean = values.iter().map(|&x| f64::from(x)).sum::<f64>() / 256.0;
    let variance = values.iter().map(|&x| (f64::from(x) - mean).powi(2)).sum::<f64>() / 256.0;
    let (off, off_variance) = (found.luminance / mean - 1.0, found.variance / variance - 1.0);
    println!("mean off by {off:.1e}, variance by {off_variance:.1e}");
    assert!(off.abs() <= 1e-6 && off_variance.abs() <= 1e-3);
}

/// The words hold 2^32 of the largest samples: 64 bits and 96 for the square, 32 more.
#[test]
fn the_words_hold_a_full_film() {
    let (largest, most) = (u64::MAX, u128::from(candor::scene::MAX_SPP));
    let word = u128::from(u32::MAX);
    assert!(u128::from(largest) * most <= word << 64 | word << 32 | word);
    assert!(square(luminance([largest; 3])).checked_mul(most).is_some());
    assert_eq!(luminance([largest; 3]), largest);
    assert_eq!(sums(&[u32::MAX; WORDS])[0], word << 64 | word << 32 | word);
}
