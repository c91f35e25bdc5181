//! The surface-area heuristic over bins (Wald, "On fast Construction of SAH-based Bounding
//! Volume Hierarchies", IEEE Symposium on Interactive Ray Tracing, 2007).

use super::build::Item;
use super::wide::Wide;
use glam::Vec3A;
use rayon::prelude::*;
use std::ops::Range;

/// Most bins along an axis.
const BINS: usize = 16;

/// Fewest: a node of few items has no use for more bins than items.
const FEWEST: usize = 4;

/// From so many items on, bins are filled on several threads.
const SHARED: usize = 1 << 16;

/// From so many items on, only the axis along which they reach farthest is looked at: on the
/// first levels one is as good as another, and all items pass through each of them.
const ONE_AXIS: usize = 1 << 10;

/// What a visit of a node costs beside the intersection of what is in a leaf.
const VISIT: f64 = 1.0;

/// What lies in one bin.
#[derive(Debug, Clone, Copy)]
struct Bin {
    bounds: Wide,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Wide::EMPTY, count: 0 };

    fn join(self, other: Self) -> Self {
        Self { bounds: self.bounds.join(other.bounds), count: self.count + other.count }
    }

    fn cost(self) -> f64 {
        #[expect(clippy::cast_precision_loss, reason = "below 2³¹")]
        let count = self.count as f64;
        self.bounds.half_area() * count
    }
}

/// How places become bins: those between the lowest and the highest middle of the items.
#[derive(Debug, Clone, Copy)]
pub(super) struct Grid {
    low: Vec3A,
    scale: Vec3A,
    bins: usize,
}

impl Grid {
    /// The grid over the box of (twice the) middles of some items.
    fn over(middles: Wide, items: usize) -> Self {
        let bins = items.clamp(FEWEST, BINS);
        #[expect(clippy::cast_precision_loss, reason = "a few bins")]
        let scale = bins as f32 * (middles.high - middles.low).recip();
        Self { low: middles.low, scale, bins }
    }

    /// The bin of an item along each axis. An axis along which all middles are the same has
    /// an infinite scale, and what that makes of a zero is bin 0.
    fn places(&self, item: &Item) -> [usize; 3] {
        let place = (item.bounds.twice_middle() - self.low) * self.scale;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "saturates")]
        place.to_array().map(|at| (at as usize).min(self.bins - 1))
    }
}

/// Where to split: items in bins up to `last` along `axis` go to the first child.
#[derive(Debug, Clone, Copy)]
pub(super) struct Split {
    axis: usize,
    last: usize,
    grid: Grid,
}

impl Split {
    /// Whether an item goes to the first child.
    pub(super) fn is_first(&self, item: &Item) -> bool {
        self.grid.places(item)[self.axis] <= self.last
    }
}

type Bins = [[Bin; BINS]; 3];

fn fill(items: &[Item], grid: Grid, axes: Range<usize>) -> Bins {
    let mut bins = [[Bin::EMPTY; BINS]; 3];
    for item in items {
        let places = grid.places(item);
        for axis in axes.clone() {
            let bin = &mut bins[axis][places[axis]];
            *bin = bin.join(Bin { bounds: item.bounds, count: 1 });
        }
    }
    bins
}

/// Minima, maxima and counts are the same in whatever order they are taken.
fn fill_shared(items: &[Item], grid: Grid, axes: Range<usize>) -> Bins {
    if items.len() < SHARED {
        return fill(items, grid, axes);
    }
    let join = |a: Bins, b: Bins| {
        std::array::from_fn(|axis| std::array::from_fn(|i| a[axis][i].join(b[axis][i])))
    };
    let parts = items.par_chunks(SHARED / 4).map(|part| fill(part, grid, axes.clone()));
    parts.reduce(|| [[Bin::EMPTY; BINS]; 3], join)
}

/// The cheapest split of some items into two that are not empty, unless a leaf is cheaper
/// and `may_be_leaf`; nothing also where all their middles are in one bin.
pub(super) fn cheapest(
    items: &[Item],
    bounds: Wide,
    middles: Wide,
    may_be_leaf: bool,
) -> Option<Split> {
    let grid = Grid::over(middles, items.len());
    let whole = Bin { bounds, count: items.len() };
    let leaf = if may_be_leaf { whole.cost() } else { f64::INFINITY };
    let widest = (middles.high - middles.low).max_position();
    let axes = if items.len() < ONE_AXIS { 0..3 } else { widest..widest + 1 };
    let bins = fill_shared(items, grid, axes.clone());
    let (mut best, mut least) = (None, leaf);
    for axis in axes {
        let bins = &bins[axis];
        // What lies behind each place, from the far end on.
        let mut behind = [Bin::EMPTY; BINS];
        for i in (1..grid.bins).rev() {
            behind[i - 1] = behind[i].join(bins[i]);
        }
        let mut before = Bin::EMPTY;
        for (last, behind) in behind.iter().enumerate().take(grid.bins - 1) {
            before = before.join(bins[last]);
            if before.count == 0 || behind.count == 0 {
                continue;
            }
            let cost = VISIT * bounds.half_area() + before.cost() + behind.cost();
            if cost < least {
                (best, least) = (Some(Split { axis, last, grid }), cost);
            }
        }
    }
    best
}
