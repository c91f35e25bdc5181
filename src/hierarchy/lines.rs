//! How many nodes a line goes through.

use super::{Hierarchy, Node};
use glam::DVec3;
use rayon::prelude::*;

impl Hierarchy {
    /// Most nodes whose boxes one of some lines goes through, inner ones and leaves. A line is
    /// a point and a direction, of any length but 0, and has no ends.
    #[must_use]
    pub fn most_met(&self, lines: &[(DVec3, DVec3)]) -> usize {
        lines.par_iter().map(|&(point, direction)| self.met(point, direction)).max().unwrap_or(0)
    }

    fn met(&self, point: DVec3, direction: DVec3) -> usize {
        let inverse = direction.recip();
        let mut met = 0;
        let mut waiting = Vec::from_iter((!self.nodes().is_empty()).then_some(0));
        while let Some(place) = waiting.pop() {
            let node = &self.nodes()[place];
            if !is_met(node, point, inverse) {
                continue;
            }
            met += 1;
            if node.count == 0 {
                waiting.extend([place + 1, node.first as usize]);
            }
        }
        met
    }
}

/// Whether a line goes through a node's box. Where it lies in the plane of a side, 0·∞ is no
/// number, which `min` and `max` pass over.
fn is_met(node: &Node, point: DVec3, inverse: DVec3) -> bool {
    let low = (node.bounds.low.as_dvec3() - point) * inverse;
    let high = (node.bounds.high.as_dvec3() - point) * inverse;
    let axes = [0, 1, 2].map(|axis| (low[axis], high[axis]));
    let enter = axes.iter().map(|&(a, b)| a.min(b)).fold(f64::NEG_INFINITY, f64::max);
    let leave = axes.iter().map(|&(a, b)| a.max(b)).fold(f64::INFINITY, f64::min);
    enter <= leave
}

#[cfg(test)]
mod tests {
    use crate::hierarchy::{Bounds, Hierarchy};
    use glam::DVec3;

    /// A row of balls along x: the line along it goes through every node, one beside it through
    /// none, and one across a ball through its leaf and what is above.
    #[test]
    fn lines_meet_what_is_on_them() {
        let ball = |i: i32| Bounds::of_sphere(f64::from(3 * i) * DVec3::X, 1.0);
        let row = Hierarchy::build(&(0..100).map(ball).collect::<Vec<_>>());
        assert_eq!(row.most_met(&[(DVec3::ZERO, DVec3::X)]), row.nodes().len());
        assert_eq!(row.most_met(&[(DVec3::ZERO, -1e-3 * DVec3::X)]), row.nodes().len());
        assert_eq!(row.most_met(&[(2.0 * DVec3::Y, DVec3::X)]), 0);
        let across = row.most_met(&[(150.0 * DVec3::X, DVec3::Y)]);
        assert!((2..=row.depth() as usize + 1).contains(&across), "{across}");
        assert_eq!(Hierarchy::build(&[]).most_met(&[(DVec3::ZERO, DVec3::X)]), 0);
    }
}
