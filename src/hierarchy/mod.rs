//! A bounding volume hierarchy over many spheres: which of them a ray can meet at all.
//!
//! It knows boxes and nothing of what is in them. The tree is binary and depth first in
//! one array, so that a traversal goes to the next node or to the second child and keeps
//! a short stack; its depth is bounded by [`MOST_LEVELS`] whatever the boxes are. The same
//! boxes give the same tree on any number of threads.

mod bins;
mod bounds;
mod build;
mod lines;
mod pairs;
mod wide;

pub use bounds::Bounds;
pub use build::{LEAF, MOST_LEVELS};
pub use pairs::TooManyPairs;

/// One box of the tree.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Node {
    /// Holds everything below it.
    pub bounds: Bounds,
    /// How many things a leaf holds, at most [`LEAF`]; 0 for an inner node.
    pub count: u32,
    /// Of a leaf, its first place in [`Hierarchy::order`]; of an inner node, the index of
    /// its second child. The first child is the next node.
    pub first: u32,
}

/// A tree of boxes.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Hierarchy {
    nodes: Vec<Node>,
    order: Vec<u32>,
}

impl Hierarchy {
    /// Builds the tree over `bounds`, whose corners are not NaN, on the threads of the pool
    /// that it is called in. Without boxes there are no nodes.
    ///
    /// # Panics
    /// With 2³¹ boxes or more, which a machine has no memory for.
    #[must_use]
    pub fn build(bounds: &[Bounds]) -> Self {
        let (nodes, order) = build::build(bounds);
        Self { nodes, order }
    }

    /// The nodes, depth first; the root is the first.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// Indices into what the tree was built over, each once, leaf by leaf.
    #[must_use]
    pub fn order(&self) -> &[u32] {
        &self.order
    }

    /// Inner nodes above the deepest leaf, at most [`MOST_LEVELS`]: so many places does the
    /// stack of a traversal need that puts one child aside and goes to the other.
    #[must_use]
    pub fn depth(&self) -> u32 {
        let mut depth = 0;
        let mut open = vec![(0, 0)];
        while let Some((index, above)) = open.pop() {
            match self.nodes.get(index) {
                Some(node) if node.count == 0 => {
                    open.push((index + 1, above + 1));
                    open.push((node.first as usize, above + 1));
                }
                _ => depth = depth.max(above),
            }
        }
        depth
    }
}
