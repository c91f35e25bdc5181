//! Whether error bars mean what they say: over 200 seeds, 95 % intervals of pixels, tiles and
//! the image cover the truth 95 % of the time.

#![expect(clippy::cast_precision_loss, reason = "counts of intervals and samples")]

mod support {
    #[allow(dead_code, reason = "of all formulas, the integrating sphere")]
    pub mod closed_form;
    pub mod known;
    pub mod scenes;
}

use candor::estimate::{PixelEstimate, estimate, z_limit};
use candor::film::Film;
use candor::scene::ImageSize;
use std::num::NonZeroUsize;
use std::ops::Range;
use support::known::{Known, hollow, mean, per_seed, still_life, trace};

const SEEDS: u32 = 200;
const LEVEL: f64 = 0.95;

/// Samples of one picture, in so many parts that are pictures of their own: an image has one
/// interval where its pixels have many, and the parts make up for it.
const SAMPLES: u64 = 4000;
const PARTS: u64 = 10;

/// Expected hits from which on an interval is judged.
const MIN_HITS: f64 = 1000.0;

/// Tiles of a picture, across and down.
const TILES: (u32, u32) = (4, 3);

/// Two-sided probability at which a count of intervals is taken for wrong.
const ALPHA: f64 = 1e-3;

/// What intervals over the mean of some pixels came to.
#[derive(Debug, Clone, Copy, Default)]
struct Tally {
    intervals: f64,
    covering: f64,
}

impl Tally {
    fn add(&mut self, other: Self) {
        self.intervals += other.intervals;
        self.covering += other.covering;
    }

    /// Whether as many cover the truth as should, within the binomial error and what 1000
    /// hits still lack of a normal distribution.
    fn is_right(self) -> bool {
        let off = (self.covering / self.intervals - LEVEL).abs();
        let error = (LEVEL * (1.0 - LEVEL) / self.intervals).sqrt();
        off <= z_limit(ALPHA) * error + edgeworth()
    }
}

/// How far the coverage of a Studentized mean is off, from the Edgeworth expansion (Hall, The
/// Bootstrap and Edgeworth Expansion, 1992, eq. 2.31), 2φ(z)·z·(κ(z²−3)/12 − γ²(z⁴+2z²−3)/18 −
/// (z²+3)/4)/N. For hits of one brightness, rare or not, γ²/N and κ/N are at most 1/hits, and
/// 1/N is at most that.
fn edgeworth() -> f64 {
    let z = z_limit(1.0 - LEVEL);
    let density = (-z * z / 2.0).exp() / f64::sqrt(2.0 * std::f64::consts::PI);
    let skewness = (z.powi(4) + 2.0 * z * z - 3.0) / 18.0;
    let student = (z * z + 3.0) / 4.0;
    2.0 * density * z * (skewness + student) / MIN_HITS
}

/// The pixels of each tile.
fn tiles(size: ImageSize) -> Vec<Vec<usize>> {
    let (columns, rows) = (size.width() / TILES.0, size.height() / TILES.1);
    let span = |i: u32, side: u32| -> Range<u32> { i * side..(i + 1) * side };
    let tile = |x: u32, y: u32| {
        let rows = span(y, rows);
        let pixels = rows.flat_map(|row| span(x, columns).map(move |c| row * size.width() + c));
        pixels.map(|pixel| pixel as usize).collect()
    };
    (0..TILES.1).flat_map(|y| (0..TILES.0).map(move |x| (x, y))).map(|(x, y)| tile(x, y)).collect()
}

/// Whether the interval of the mean over some pixels covers the truth, with its half width
/// scaled by `width`; no interval where nothing is random.
fn covers(known: &Known, film: &[PixelEstimate], n: f64, pixels: &[usize], width: f64) -> Tally {
    let over = |of: &dyn Fn(usize) -> f64| pixels.iter().map(|&pixel| of(pixel)).sum::<f64>();
    let own = over(&|pixel| film[pixel].variance / n);
    if own == 0.0 {
        return Tally::default();
    }
    let off = over(&|pixel| film[pixel].luminance - known.truth[pixel]);
    let error = (own + over(&|pixel| known.variance[pixel])).sqrt();
    let covering = off.abs() <= width * z_limit(1.0 - LEVEL) * error;
    Tally { intervals: 1.0, covering: f64::from(u8::from(covering)) }
}

fn pixels(film: &Film) -> Vec<PixelEstimate> {
    film.pixels().iter().map(|words| estimate(film, words)).collect()
}

/// One seed's picture: its parts, and the whole.
struct Rendered {
    parts: Vec<Vec<PixelEstimate>>,
    whole: Vec<PixelEstimate>,
}

/// Whether a group of pixels has the hits that a normal distribution needs, on average over
/// the seeds. Where nearly every sample hits, it is the misses that are rare (a pixel of the
/// lamp with a sliver of sky); so the variance must be as well known as 1000 rare hits make
/// it, to 1/√1000. That bounds the skewness of the mean, as the square of a third cumulant is at
/// most the second times (the fourth + twice the second's square): Pearson's inequality.
fn has_hits(renders: &[Rendered], group: &[usize]) -> bool {
    let over = |of: &dyn Fn(&PixelEstimate) -> f64| -> Vec<f64> {
        renders.iter().map(|r| group.iter().map(|&pixel| of(&r.whole[pixel])).sum()).collect()
    };
    let hits = mean(&over(&|pixel| pixel.hits(SAMPLES)));
    let variances = over(&|pixel| pixel.variance);
    let middle = mean(&variances);
    let spread = mean(&variances.iter().map(|v| (v - middle).powi(2)).collect::<Vec<_>>());
    hits >= MIN_HITS && spread <= middle * middle / MIN_HITS
}

/// Coverage by pixels, tiles and the image.
fn coverage(known: &Known, renders: &[Rendered], width: f64) -> [Tally; 3] {
    let count = known.truth.len();
    let mut single: Vec<Vec<usize>> = (0..count).map(|pixel| vec![pixel]).collect();
    let mut tiles = tiles(known.scene.size());
    for groups in [&mut single, &mut tiles] {
        groups.retain(|group| has_hits(renders, group));
    }
    let image: Vec<usize> = (0..count).collect();
    let mut tallies = [Tally::default(); 3];
    for render in renders {
        let n = SAMPLES as f64;
        for (tally, groups) in tallies.iter_mut().zip([&single, &tiles]) {
            for group in groups {
                tally.add(covers(known, &render.whole, n, group, width));
            }
        }
        for part in &render.parts {
            tallies[2].add(covers(known, part, n / PARTS as f64, &image, width));
        }
    }
    tallies
}

fn render(known: &Known) -> Vec<Rendered> {
    per_seed(&known.scene, SEEDS, |scene| {
        let count = SAMPLES / PARTS;
        let part = |i| trace(scene, i * count, count, NonZeroUsize::new(1));
        let films: Vec<Film> = (0..PARTS).map(part).collect();
        let mut whole = films[0].clone();
        for film in &films[1..] {
            whole.merge(film).expect("parts of one picture");
        }
        Rendered { parts: films.iter().map(pixels).collect(), whole: pixels(&whole) }
    })
}

#[test]
fn intervals_cover_the_truth_as_often_as_they_say() {
    let mut all = [Tally::default(); 3];
    for known in [hollow(), still_life()] {
        let renders = render(&known);
        let right = coverage(&known, &renders, 1.0);
        // The injected fault: intervals that are a tenth too short.
        let short = coverage(&known, &renders, 0.9);
        for (i, what) in ["pixels", "tiles", "image"].iter().enumerate() {
            let (right, short) = (right[i], short[i]);
            println!(
                "{}, {what}: {:.2} % of {} intervals cover, of shorter ones {:.2} %",
                known.name,
                100.0 * right.covering / right.intervals,
                right.intervals,
                100.0 * short.covering / short.intervals
            );
            assert!(right.is_right(), "{}, {what}: {right:?}", known.name);
            all[i].add(short);
        }
    }
    // Of both pictures together there are enough intervals to tell for certain: the fault is
    // over seven standard errors.
    assert!(all.iter().all(|tally| !tally.is_right()), "{all:?}");
}
