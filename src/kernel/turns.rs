//! How often a ray may turn in the loop that goes through the hierarchy.

use super::layout;
use crate::hierarchy::Hierarchy;
use glam::DVec3;

/// Hierarchies of up to this many nodes and leaves may be gone through whole.
const FEW_NODES: usize = 4096;

/// Lines that are tried in larger ones.
const LINES: u64 = 4096;

/// Most turns that a ray is to be reckoned with, in a hierarchy that the kernel has `wide` nodes
/// of. A turn looks at one node, at the spheres of a leaf, or at both, so that there are never
/// more than nodes and leaves. In large hierarchies, where no ray comes near that, it is twice the
/// most nodes that a line goes through, among many lines through two spheres each: a ray ends
/// where it hits something, a line has no ends; but the kernel's boxes are a little larger, and
/// not every line is tried.
pub(super) fn most_turns(hierarchy: &Hierarchy, wide: usize, spheres: &[layout::Sphere]) -> u64 {
    let leaves = hierarchy.nodes().iter().filter(|node| node.count > 0).count();
    let all = wide + leaves;
    let most = if all <= FEW_NODES { all } else { 2 * hierarchy.most_met(&lines(spheres)) };
    most.min(all) as u64
}

/// Lines through the centres of two spheres, from all over the scene.
fn lines(spheres: &[layout::Sphere]) -> Vec<(DVec3, DVec3)> {
    // Multiples of two large primes, which are as good as random here.
    let center = |number: u64| {
        let place = usize::try_from(number % spheres.len() as u64).expect("fewer than spheres");
        DVec3::from(spheres[place].position.map(f64::from))
    };
    (0..LINES)
        .map(|i| (center(i * 2_654_435_761), center(i * 2_246_822_519 + 1)))
        .filter(|(from, to)| from != to)
        .map(|(from, to)| (from, to - from))
        .collect()
}
