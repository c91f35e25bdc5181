//! Whether two films show the same picture: z-tests over tiles and over the image for
//! films of independent samples, and the bias between films of the same samples.

use super::pixel::{effective_hits, estimate};
use crate::film::{Film, sums};
use statrs::function::erf::{erfc, erfc_inv};

/// Tiles have this many pixels on a side, fewer at the picture's edge.
const TILE: usize = 16;

/// A z-test needs this many effective hits on one side; the other then expects as many. With 1000 the mean of
/// Bernoulli hits has skewness 0.03, and the normal tail at five standard errors is
/// off by exp(0.03·5³/6), less than a factor of two.
const MIN_HITS: f64 = 1000.0;

/// Relative rounding error granted to a mean that has no variance: a handful of `f32`
/// roundings (2⁻²⁴ each) along two scatterings.
const ROUNDING: f64 = 1.0 / (1 << 20) as f64;

/// One deviation in standard errors and its two-sided p-value.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Deviation {
    /// Difference of the means over its standard error, from both variances.
    pub z: f64,
    /// Probability of a deviation as large where both show the same.
    pub p: f64,
}

/// Two films of independent samples side by side, by their luminance.
#[derive(Debug, Clone, PartialEq)]
pub struct Comparison {
    /// Tiles tested; dark ones are pooled until they have enough hits.
    pub tiles: usize,
    /// Deviation of the mean over the image.
    pub image: Deviation,
    /// Largest deviation of a tile.
    pub worst: Deviation,
    /// Mean of the tiles' z; its standard error is 1/√tiles.
    pub mean_z: f64,
    /// Root mean square of the tiles' z, 1 where the error bars are right.
    pub rms_z: f64,
    /// Whether the picture has enough hits for a test at all.
    pub conclusive: bool,
}

impl Comparison {
    /// Whether image or any tile disagrees at the family-wise level `alpha`
    /// (Bonferroni over all tests).
    #[must_use]
    pub fn disagrees(&self, alpha: f64) -> bool {
        #[expect(clippy::cast_precision_loss, reason = "a count of tiles")]
        let tests = self.tiles as f64 + 1.0;
        self.image.p.min(self.worst.p) < alpha / tests
    }
}

/// Sums over a group of pixels of one film.
#[derive(Debug, Clone, Copy, Default)]
struct Group {
    mean: f64,
    variance: f64,
    sum: f64,
    squares: f64,
}

impl Group {
    fn add(&mut self, other: &Self) {
        self.mean += other.mean;
        self.variance += other.variance;
        self.sum += other.sum;
        self.squares += other.squares;
    }

    fn hits(&self) -> f64 {
        effective_hits(self.sum, self.squares)
    }
}

/// Compares two films of the same picture with independent samples.
///
/// # Panics
/// If the films differ in size.
#[must_use]
pub fn compare(a: &Film, b: &Film) -> Comparison {
    assert_eq!(a.size(), b.size(), "films of one picture");
    let tiles: Vec<[Group; 2]> = std::iter::zip(tiles(a), tiles(b)).map(|(a, b)| [a, b]).collect();
    let mut image = [Group::default(); 2];
    let mut groups = Vec::new();
    let mut pool = [Group::default(); 2];
    for tile in &tiles {
        add(&mut image, tile);
        if enough(tile) {
            groups.push(*tile);
        } else {
            add(&mut pool, tile);
            if enough(&pool) {
                groups.push(std::mem::take(&mut pool));
            }
        }
    }
    match groups.last_mut() {
        Some(last) => add(last, &pool),
        None => groups.push(image),
    }
    let deviations: Vec<Deviation> = groups.iter().map(deviation).collect();
    #[expect(clippy::cast_precision_loss, reason = "a count of tiles")]
    let count = deviations.len() as f64;
    Comparison {
        tiles: groups.len(),
        image: deviation(&image),
        worst: *deviations
            .iter()
            .min_by(|a, b| b.z.abs().total_cmp(&a.z.abs()))
            .expect("at least one group"),
        mean_z: deviations.iter().map(|d| d.z).sum::<f64>() / count,
        rms_z: (deviations.iter().map(|d| d.z * d.z).sum::<f64>() / count).sqrt(),
        conclusive: enough(&image),
    }
}

fn add(to: &mut [Group; 2], other: &[Group; 2]) {
    for (to, other) in to.iter_mut().zip(other) {
        to.add(other);
    }
}

fn enough(sides: &[Group; 2]) -> bool {
    sides.iter().any(|side| side.hits() >= MIN_HITS)
}

fn deviation([a, b]: &[Group; 2]) -> Deviation {
    let difference = a.mean - b.mean;
    let rounding = ROUNDING * f64::max(a.mean, b.mean);
    let error = (a.variance + b.variance + rounding * rounding).sqrt();
    let z = if difference == 0.0 { 0.0 } else { difference / error };
    Deviation { z, p: p_value(z) }
}

/// Two-sided p-value of a standard normal deviate.
#[must_use]
pub fn p_value(z: f64) -> f64 {
    erfc(z.abs() / std::f64::consts::SQRT_2)
}

/// The deviate that a standard normal exceeds, on either side, with probability `p`.
#[must_use]
pub fn z_limit(p: f64) -> f64 {
    std::f64::consts::SQRT_2 * erfc_inv(p)
}

/// The tiles of a film, in the order of their first pixels.
#[expect(clippy::cast_precision_loss, reason = "a count of samples")]
fn tiles(film: &Film) -> Vec<Group> {
    let width = film.size().width() as usize;
    let samples = film.samples().count();
    let n = samples as f64;
    let columns = width.div_ceil(TILE);
    let rows = (film.size().height() as usize).div_ceil(TILE);
    let mut tiles = vec![Group::default(); columns * rows];
    for (i, words) in film.pixels().iter().enumerate() {
        let pixel = estimate(film, words);
        let sum = pixel.luminance * n;
        let squares = pixel.mean_square * n;
        let group = Group { mean: pixel.luminance, variance: pixel.variance / n, sum, squares };
        tiles[i / width / TILE * columns + i % width / TILE].add(&group);
    }
    tiles
}

/// The bias of one film against another of the same samples, per channel.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Paired {
    /// Difference of the image means, (a - b)/b, per channel.
    pub bias: [f64; 3],
    /// Its standard error, from the spread of the differences over pixels.
    pub error: [f64; 3],
}

impl Paired {
    /// Whether a channel's bias is certainly larger than `limit`, at the two-sided
    /// level `alpha` for each channel.
    #[must_use]
    pub fn exceeds(&self, limit: f64, alpha: f64) -> bool {
        let z = z_limit(alpha);
        std::iter::zip(self.bias, self.error).any(|(bias, error)| bias.abs() - z * error > limit)
    }

    /// Whether every channel's bias is certainly within `limit`. Paths that differ on the
    /// two sides widen the error, so that this fails where [`Self::exceeds`] cannot tell.
    #[must_use]
    pub fn is_within(&self, limit: f64, alpha: f64) -> bool {
        let z = z_limit(alpha);
        std::iter::zip(self.bias, self.error).all(|(bias, error)| bias.abs() + z * error <= limit)
    }
}

/// Pairs two films of the same samples, `b` being the reference. A channel that is 0
/// everywhere in both has no bias; where only the reference is 0, it is infinite.
///
/// # Panics
/// If the films differ in size or samples.
#[must_use]
#[expect(clippy::cast_precision_loss, reason = "from exact sums to the nearest f64")]
pub fn pair(a: &Film, b: &Film) -> Paired {
    assert_eq!((a.size(), a.samples()), (b.size(), b.samples()), "films of the same samples");
    let pixels = a.pixels().len() as f64;
    let (mut reference, mut difference, mut squares) = ([0.0; 3], [0.0; 3], [0.0; 3]);
    for (ours, theirs) in std::iter::zip(a.pixels(), b.pixels()) {
        let (ours, theirs) = (sums(ours), sums(theirs));
        for c in 0..3 {
            let d = if ours[c] >= theirs[c] {
                (ours[c] - theirs[c]) as f64
            } else {
                -((theirs[c] - ours[c]) as f64)
            };
            reference[c] += theirs[c] as f64;
            difference[c] += d;
            squares[c] += d * d;
        }
    }
    let relative = |x: f64, c: usize| if x == 0.0 { 0.0 } else { x / reference[c] };
    Paired {
        bias: std::array::from_fn(|c| relative(difference[c], c)),
        error: std::array::from_fn(|c| {
            let mean = difference[c] / pixels;
            let spread = (squares[c] / pixels - mean * mean).max(0.0);
            relative((spread * pixels).sqrt(), c)
        }),
    }
}
