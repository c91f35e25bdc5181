//! Splits boxes in two until few are left, on several threads.

use super::Node;
use super::bins::cheapest;
use super::bounds::Bounds;
use super::wide::Wide;
use glam::Vec3A;

/// Most things in one leaf.
pub const LEAF: usize = 2;

/// Most inner nodes above a leaf.
///
/// A split by cost may take one item from many, over and over: a chain of spheres with radii
/// 1, 2, 4, 8 … is one. So a node of n items below d inner nodes is split by cost only while
/// d + 1 + ⌈log₂ n⌉ is no more than this, and in halves from there on: either way its
/// children again have d + ⌈log₂ n⌉ within it.
pub const MOST_LEVELS: u32 = 48;

/// Below so many items a subtree is built on one thread.
const ALONE: usize = 1 << 12;

/// A box and whose it is.
#[derive(Debug, Clone, Copy)]
pub(super) struct Item {
    pub(super) bounds: Wide,
    index: u32,
}

/// The nodes, depth first, and the order of the items in their leaves.
pub(super) fn build(bounds: &[Bounds]) -> (Vec<Node>, Vec<u32>) {
    assert!(bounds.len() < 1 << 31, "2³¹ boxes or more");
    let item = |(index, &bounds): (u32, &Bounds)| Item { bounds: bounds.into(), index };
    let mut items: Vec<Item> = std::iter::zip(0.., bounds).map(item).collect();
    let mut nodes = Vec::new();
    if !items.is_empty() {
        grow(&mut items, 0, 0, &mut nodes);
    }
    (nodes, items.iter().map(|item| item.index).collect())
}

/// Appends the subtree over `items`, which stand at `first` in the order of all and below
/// `above` inner nodes, and leaves them in its order.
fn grow(items: &mut [Item], first: usize, above: u32, nodes: &mut Vec<Node>) {
    let (bounds, middles) = around(items);
    let Some(before) = split(items, bounds, middles, above) else {
        nodes.push(Node { bounds: bounds.into(), count: word(items.len()), first: word(first) });
        return;
    };
    let is_shared = items.len() >= ALONE;
    let (left, right) = items.split_at_mut(before);
    let place = nodes.len();
    nodes.push(Node { bounds: bounds.into(), count: 0, first: 0 });
    if is_shared {
        let (mut of_left, mut of_right) = (Vec::new(), Vec::new());
        rayon::join(
            || grow(left, first, above + 1, &mut of_left),
            || grow(right, first + before, above + 1, &mut of_right),
        );
        append(nodes, &of_left);
        nodes[place].first = word(nodes.len());
        append(nodes, &of_right);
    } else {
        grow(left, first, above + 1, nodes);
        nodes[place].first = word(nodes.len());
        grow(right, first + before, above + 1, nodes);
    }
}

/// Appends a subtree, whose inner nodes count from its own root.
fn append(nodes: &mut Vec<Node>, subtree: &[Node]) {
    let root = word(nodes.len());
    nodes.extend(subtree.iter().map(|&node| {
        let first = if node.count == 0 { node.first + root } else { node.first };
        Node { first, ..node }
    }));
}

/// The box around some items, and that of (twice) their middles.
fn around(items: &[Item]) -> (Wide, Wide) {
    items.iter().fold((Wide::EMPTY, Wide::EMPTY), |(bounds, middles), item| {
        (bounds.join(item.bounds), middles.with(item.bounds.twice_middle()))
    })
}

/// Sorts items into those of the first and of the second child; how many the first gets,
/// nothing if they are to be a leaf.
fn split(items: &mut [Item], bounds: Wide, middles: Wide, above: u32) -> Option<usize> {
    let count = items.len();
    let may_be_leaf = count <= LEAF;
    if count == 1 {
        return None;
    }
    let halvings = count.next_power_of_two().ilog2();
    let by_cost = (above + 1 + halvings <= MOST_LEVELS)
        .then(|| cheapest(items, bounds, middles, may_be_leaf))
        .flatten();
    match by_cost {
        Some(split) => Some(partition(items, |item| split.is_first(item))),
        None if may_be_leaf => None,
        None => {
            halve(items, middles.high - middles.low);
            Some(count / 2)
        }
    }
}

/// Puts the items that `is_first` before the others; how many they are.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> usize {
    let (mut low, mut high) = (0, items.len());
    loop {
        while low < high && is_first(&items[low]) {
            low += 1;
        }
        while low < high && !is_first(&items[high - 1]) {
            high -= 1;
        }
        if low == high {
            return low;
        }
        items.swap(low, high - 1);
    }
}

/// Puts the half with the smaller middles along the widest axis first.
fn halve(items: &mut [Item], widths: Vec3A) {
    let axis = widths.max_position();
    let key = |item: &Item| item.bounds.twice_middle()[axis];
    items.select_nth_unstable_by(items.len() / 2, |a, b| {
        key(a).total_cmp(&key(b)).then(a.index.cmp(&b.index))
    });
}

fn word(count: usize) -> u32 {
    u32::try_from(count).expect("fewer than 2³¹ boxes make fewer than 2³² nodes")
}
