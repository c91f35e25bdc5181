//! Pairs whose boxes overlap: both halves of the tree go down together, so that what is far
//! apart is told so once for many.

use super::{Hierarchy, Node};
use std::sync::atomic::{AtomicU64, Ordering};

/// From so many nodes on, the two halves are searched on two threads.
const SHARED: usize = 1 << 12;

/// There are more pairs than were to be looked at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct TooManyPairs;

/// What is said of some pairs: the least key, and what goes with it.
type Least<K, T> = Result<Option<(K, T)>, TooManyPairs>;

impl Hierarchy {
    /// Of all pairs of boxes that overlap or touch, and of some others, what `judge` says with
    /// the least key. It is asked once about each, in any order, on several threads.
    ///
    /// # Errors
    /// If there are more than `most` pairs, which depends on the boxes alone.
    pub fn least_of_pairs<K: Ord + Send, T: Send>(
        &self,
        most: u64,
        judge: impl Fn(u32, u32) -> Option<(K, T)> + Sync,
    ) -> Least<K, T> {
        if self.nodes.is_empty() {
            return Ok(None);
        }
        Search { tree: self, most, seen: AtomicU64::new(0), judge }.within(0)
    }
}

struct Search<'a, J> {
    tree: &'a Hierarchy,
    most: u64,
    seen: AtomicU64,
    judge: J,
}

impl<J> Search<'_, J> {
    /// The pairs within one subtree.
    fn within<K, T>(&self, index: usize) -> Least<K, T>
    where
        K: Ord + Send,
        T: Send,
        J: Fn(u32, u32) -> Option<(K, T)> + Sync,
    {
        let node = &self.tree.nodes[index];
        if node.count > 0 {
            let things = self.things(node);
            let places = 0..things.len();
            let pairs = places.flat_map(|i| things[i + 1..].iter().map(move |&b| (things[i], b)));
            return self.look(things.len() * (things.len() - 1) / 2, pairs);
        }
        let [left, right] = [index + 1, node.first as usize];
        let of_halves = both(right - left, || self.within(left), || self.within(right))?;
        Ok(lesser(of_halves, self.across(left, right)?))
    }

    /// The pairs of one thing of each of two subtrees.
    fn across<K, T>(&self, a: usize, b: usize) -> Least<K, T>
    where
        K: Ord + Send,
        T: Send,
        J: Fn(u32, u32) -> Option<(K, T)> + Sync,
    {
        let (first, second) = (&self.tree.nodes[a], &self.tree.nodes[b]);
        if !first.bounds.overlaps(&second.bounds) {
            return Ok(None);
        }
        let size = |node: &Node| (node.bounds.high - node.bounds.low).element_sum();
        if first.count > 0 && second.count > 0 {
            let (ours, theirs) = (self.things(first), self.things(second));
            let pairs = ours.iter().flat_map(|&i| theirs.iter().map(move |&j| (i, j)));
            self.look(ours.len() * theirs.len(), pairs)
        } else if second.count > 0 || (first.count == 0 && size(first) >= size(second)) {
            let [left, right] = [a + 1, first.first as usize];
            both(right - left, || self.across(left, b), || self.across(right, b))
        } else {
            let [left, right] = [b + 1, second.first as usize];
            both(right - left, || self.across(a, left), || self.across(a, right))
        }
    }

    /// What is in a leaf.
    fn things(&self, leaf: &Node) -> &[u32] {
        let first = leaf.first as usize;
        &self.tree.order[first..first + leaf.count as usize]
    }

    fn look<K: Ord, T>(&self, count: usize, pairs: impl Iterator<Item = (u32, u32)>) -> Least<K, T>
    where
        J: Fn(u32, u32) -> Option<(K, T)>,
    {
        let count = count as u64;
        if self.seen.fetch_add(count, Ordering::Relaxed) + count > self.most {
            return Err(TooManyPairs);
        }
        Ok(pairs.map(|(a, b)| (self.judge)(a, b)).fold(None, lesser))
    }
}

/// The lesser of what two searches find; on two threads where one has many nodes before it.
fn both<K: Ord + Send, T: Send>(
    nodes: usize,
    a: impl FnOnce() -> Least<K, T> + Send,
    b: impl FnOnce() -> Least<K, T> + Send,
) -> Least<K, T> {
    let (a, b) = if nodes < SHARED { (a(), b()) } else { rayon::join(a, b) };
    Ok(lesser(a?, b?))
}

/// The one with the lesser key.
fn lesser<K: Ord, T>(a: Option<(K, T)>, b: Option<(K, T)>) -> Option<(K, T)> {
    match (a, b) {
        (Some(a), Some(b)) => Some(if b.0 < a.0 { b } else { a }),
        (a, b) => a.or(b),
    }
}
