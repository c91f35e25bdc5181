//! The hierarchy as the kernel goes through it: four children to a node, their boxes in bytes.

use super::layout;
use super::pack::{float, word};
use crate::hierarchy::{Bounds, Hierarchy, LEAF};
use glam::DVec3;

/// Children of a node.
const WIDTH: usize = 4;

/// The kind of a child that is a node; others say how many spheres there are.
const A_NODE: u32 = 15;

/// Steps of a node's grid along its longest side.
const STEPS: f64 = 255.0;

/// Keeps the step a normal `f32`.
const SMALLEST_SIDE: f64 = 1e-30;

/// The kernel looks at a leaf's spheres two at a time.
const _: () = assert!(LEAF <= 2);

/// A hierarchy with four children to a node.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Wide {
    pub(super) nodes: Vec<layout::Node>,
    /// Indices of the spheres, leaf by leaf.
    pub(super) order: Vec<u32>,
    /// Most siblings that wait at a time while a ray goes through it.
    pub(super) stack: u32,
}

/// A node that is yet to be written.
struct Pending {
    /// In the binary hierarchy.
    node: usize,
    place: usize,
    /// How many siblings wait when a ray comes here.
    waiting: u32,
}

impl Wide {
    /// Takes a binary hierarchy together.
    pub(super) fn of(binary: &Hierarchy) -> Self {
        let mut wide = Self::default();
        if binary.nodes().is_empty() {
            return wide;
        }
        wide.nodes.push(bytemuck::Zeroable::zeroed());
        let mut pending = vec![Pending { node: 0, place: 0, waiting: 0 }];
        while let Some(next) = pending.pop() {
            wide.write(binary, &next, &mut pending);
        }
        wide
    }

    fn write(&mut self, binary: &Hierarchy, next: &Pending, pending: &mut Vec<Pending>) {
        let children = children(binary, next.node);
        let (first_node, first_sphere) = (self.nodes.len(), self.order.len());
        let mut grid = Grid::of(binary.nodes()[next.node].bounds);
        // Siblings wait together, and the latest ones at hand and not on the stack.
        let waiting = next.waiting + 1;
        self.stack = self.stack.max(next.waiting);
        for (slot, &child) in children.iter().enumerate() {
            let node = &binary.nodes()[child];
            let kind = if node.count == 0 { A_NODE } else { node.count };
            grid.set(slot, kind, node.bounds);
            if kind == A_NODE {
                pending.push(Pending { node: child, place: self.nodes.len(), waiting });
                self.nodes.push(bytemuck::Zeroable::zeroed());
            } else {
                let first = node.first as usize;
                // In the order of the scene file, so that at equal distances the first wins.
                let end = self.order.len();
                self.order.extend(&binary.order()[first..first + node.count as usize]);
                self.order[end..].sort_unstable();
            }
        }
        let mut node = grid.node;
        (node.first_node, node.first_sphere) = (word(first_node), word(first_sphere));
        self.nodes[next.place] = node;
    }
}

/// Up to four nodes of the binary hierarchy that together hold what one does: of its children,
/// the one with the largest surface is opened while there is room.
fn children(binary: &Hierarchy, node: usize) -> Vec<usize> {
    let nodes = binary.nodes();
    if nodes[node].count > 0 {
        return vec![node];
    }
    let opened = |node: usize| [node + 1, nodes[node].first as usize];
    let mut children = opened(node).to_vec();
    while children.len() < WIDTH {
        let inner = (0..children.len()).filter(|&i| nodes[children[i]].count == 0);
        let largest = inner.max_by(|&a, &b| {
            let area = |i: usize| nodes[children[i]].bounds.half_area();
            area(a).total_cmp(&area(b))
        });
        let Some(largest) = largest else { break };
        let [first, second] = opened(children[largest]);
        children[largest] = first;
        children.insert(largest + 1, second);
    }
    children
}

/// A node while its boxes are put on its grid, in `f64`, where differences of its `f32`
/// coordinates lose nothing that matters.
struct Grid {
    node: layout::Node,
    origin: DVec3,
    step: f64,
}

impl Grid {
    /// The grid of a node's own box. Its step is the smallest power of two with which it
    /// reaches from end to end.
    fn of(bounds: Bounds) -> Self {
        let (low, high) = (bounds.low.as_dvec3(), bounds.high.as_dvec3());
        let side = (high - low).max_element().max(SMALLEST_SIDE);
        let mut step = (side / STEPS).log2().floor().exp2();
        while step * STEPS < side {
            step *= 2.0;
        }
        let mut node: layout::Node = bytemuck::Zeroable::zeroed();
        node.origin = bounds.low.to_array();
        node.kinds = (float(step).to_bits() >> 23) << 16;
        Self { node, origin: low, step }
    }

    /// Puts a child's box onto the grid, rounded outwards.
    fn set(&mut self, slot: usize, kind: u32, bounds: Bounds) {
        self.node.kinds |= kind << (4 * slot);
        let low = ((bounds.low.as_dvec3() - self.origin) / self.step).floor();
        let high = ((bounds.high.as_dvec3() - self.origin) / self.step).ceil();
        for axis in 0..3 {
            self.node.low[axis] |= byte(low[axis]) << (8 * slot);
            self.node.high[axis] |= byte(high[axis]) << (8 * slot);
        }
    }
}

/// A step on the grid, from 0 to 255.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a small count")]
fn byte(steps: f64) -> u32 {
    steps.clamp(0.0, STEPS) as u32
}
