//! Whether two pictures of independent samples are the same: z-tests over tiles and over
//! the image. One test serves films, which hold all sums, and stored pictures.

use super::group::{Group, Sides, add, blocks, z};
use super::measured::Measured;
use super::normal::{p_of_squares, p_value};
use super::pixel::estimate;
use crate::film::Film;
use crate::scene::ImageSize;

/// Tiles have this many pixels on a side, fewer at the picture's edge.
const TILE: usize = 16;

/// A z-test needs this many effective hits. Of two films of one estimator and as many samples
/// one side suffices: the other then expects as many. With 1000 the mean of Bernoulli hits has skewness 0.03, and the normal tail at five
/// standard errors is off by exp(0.03·5³/6), less than a factor of two.
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

/// Two pictures of independent samples side by side, by their luminance.
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
    /// Probability that the worst of the tiles deviates as much as it does (Šidák: tiles
    /// are independent).
    #[must_use]
    pub fn worst_tile_p(&self) -> f64 {
        // 1 - (1-p)ⁿ without its cancellation.
        -(self.count() * (-self.worst.p).ln_1p()).exp_m1()
    }

    /// Probability that the tiles together deviate as much as they do (χ² of their z):
    /// it sees small differences of either sign that are everywhere.
    #[must_use]
    pub fn all_tiles_p(&self) -> f64 {
        p_of_squares(self.rms_z * self.rms_z * self.count(), self.count())
    }

    /// Family-wise p-value: the least of image, worst tile and all tiles, times three
    /// (Bonferroni, as the three are not independent).
    #[must_use]
    pub fn p(&self) -> f64 {
        (3.0 * self.image.p.min(self.worst_tile_p()).min(self.all_tiles_p())).min(1.0)
    }

    /// Whether the two disagree at the family-wise level `alpha`.
    #[must_use]
    pub fn disagrees(&self, alpha: f64) -> bool {
        self.p() < alpha
    }

    #[expect(clippy::cast_precision_loss, reason = "a count of tiles")]
    fn count(&self) -> f64 {
        self.tiles as f64
    }
}

/// Compares two films of the same picture with independent samples.
///
/// # Panics
/// If the films differ in size.
#[must_use]
pub fn compare(a: &Film, b: &Film) -> Comparison {
    assert_eq!(a.size(), b.size(), "films of one picture");
    let pixels = std::iter::zip(groups(a), groups(b)).map(|(a, b)| [a, b]);
    over_tiles(a.size(), pixels, ROUNDING, |sides| sides.iter().any(has_hits))
}

/// Compares two stored pictures with independent samples. Where one has no error bars,
/// its values are taken as exact. Each side with error bars needs its own hits: of another
/// estimator, or of fewer samples, it may not expect as many, and then its variance is mostly
/// too small where it is too dark.
///
/// # Panics
/// If the pictures differ in size.
#[must_use]
pub fn compare_pictures(a: &Measured<'_>, b: &Measured<'_>) -> Comparison {
    let exact = [a.bars.is_none(), b.bars.is_none()];
    let enough =
        |sides: &Sides| std::iter::zip(sides, exact).all(|(side, exact)| exact || has_hits(side));
    over_tiles(a.size, Measured::side_by_side(a, b), rounding(a, b), enough)
}

/// The relative rounding to be granted to two stored pictures.
pub(super) fn rounding(a: &Measured<'_>, b: &Measured<'_>) -> f64 {
    ROUNDING.max(a.rounding).max(b.rounding)
}

fn over_tiles(
    size: ImageSize,
    pixels: impl Iterator<Item = Sides>,
    rounding: f64,
    enough: impl Fn(&Sides) -> bool,
) -> Comparison {
    let mut image = Sides::default();
    let mut tested = Vec::new();
    let mut pool = Sides::default();
    for tile in blocks(size, TILE, pixels) {
        add(&mut image, &tile);
        if enough(&tile) {
            tested.push(tile);
        } else {
            add(&mut pool, &tile);
            if enough(&pool) {
                tested.push(std::mem::take(&mut pool));
            }
        }
    }
    match tested.last_mut() {
        Some(last) => add(last, &pool),
        None => tested.push(image),
    }
    let deviations: Vec<f64> = tested.iter().map(|tile| z(tile, rounding)).collect();
    let worst = deviations.iter().copied().max_by(|a, b| a.abs().total_cmp(&b.abs()));
    #[expect(clippy::cast_precision_loss, reason = "a count of tiles")]
    let count = deviations.len() as f64;
    Comparison {
        tiles: tested.len(),
        image: deviation(z(&image, rounding)),
        worst: deviation(worst.expect("at least one tile or pool")),
        mean_z: deviations.iter().sum::<f64>() / count,
        rms_z: (deviations.iter().map(|z| z * z).sum::<f64>() / count).sqrt(),
        conclusive: enough(&image),
    }
}

fn has_hits(side: &Group) -> bool {
    side.hits() >= MIN_HITS
}

fn deviation(z: f64) -> Deviation {
    Deviation { z, p: p_value(z) }
}

/// The pixels of a film.
#[expect(clippy::cast_precision_loss, reason = "a count of samples")]
fn groups(film: &Film) -> impl Iterator<Item = Group> {
    let n = film.samples().count() as f64;
    film.pixels().iter().map(move |words| {
        let pixel = estimate(film, words);
        Group {
            mean: pixel.luminance,
            variance: pixel.variance / n,
            sum: pixel.luminance * n,
            squares: pixel.mean_square * n,
            proven: !pixel.is_unproven(),
        }
    })
}
