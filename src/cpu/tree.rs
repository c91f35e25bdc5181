//! Which spheres a ray can meet at all: a hierarchy over those seen from outside that are
//! not huge.
//!
//! It loses no hit that the formulas of `sphere.rs` report, wrong ones included. Let E =
//! k·u·(|f|² + R²), u = 2⁻⁵³, bound the errors of c and of b² − Δ, which are both f² − R² but
//! for rounding. A hit is at t = c/(r + |b|) with r = √Δ, which is |b| − r + s with |s| ≤
//! 2E/(r + |b|). From the centre the ray's line is at most √(R² + E) away, so where t is
//! beyond the nearest point, t > |b|, the ray has come into the ball of that radius before.
//! Elsewhere the point at t has the squared distance l² + (r − s)², l² + r² ≤ R² + E. That is
//! the most for s ≥ 0. For s < 0, r·|s| ≤ 2E, and as t is 0 or more only |s| ≤ |b| − r
//! counts, so s² ≤ 2E·(|b| − r)/(|b| + r) ≤ 2E: it is in the ball of the radius √(R² + 7E),
//! though t may be √u·R too short. For |f| ≤ 2R that is within 18k·u·R of the sphere; for
//! larger |f|, |b| is at least ½|f| and |s| ≤ 5k·u·|f|. A direction is unit to some 16u, and
//! the operations count up to k < 64. So what is hit at t lies within 2⁻⁴²·(|f| + R) of the
//! sphere, and |f| is at most the distances of origin and centre from the focus together.
//! Boxes are wider than that by [`SLACK`] of the centre's and radius's part, rays see them
//! wider by the origin's. What is left of it also covers the test itself, which sees a plane
//! of a box off by 3u of its distance.

use super::scene::PreparedSphere;
use super::sphere::{MISS, Ray};
use crate::hierarchy::{Bounds, Hierarchy, MOST_LEVELS};
use glam::DVec3;

/// By how much boxes are wider than spheres, of the coordinates that meet there: four times
/// what the formulas need, and nothing beside the rounding of boxes to `f32`.
const SLACK: f64 = 4096.0 * f64::EPSILON;

/// A sphere in a leaf.
#[derive(Debug, Clone)]
pub(super) struct Member {
    pub(super) center: DVec3,
    pub(super) radius: f64,
    /// Its place in the scene.
    pub(super) sphere: usize,
}

/// A hierarchy of spheres.
#[derive(Debug, Clone)]
pub(super) struct Tree {
    focus: DVec3,
    hierarchy: Hierarchy,
    /// In the order of the hierarchy.
    members: Vec<Member>,
    /// Places of the spheres that are not in it, ascending.
    outside: Vec<usize>,
}

impl Tree {
    /// Builds the tree in coordinates around `focus`, over the spheres that are small; the others
    /// stay outside of it.
    pub(super) fn over(
        spheres: &[PreparedSphere],
        focus: DVec3,
        is_small: impl Fn(usize) -> bool,
    ) -> Self {
        Self::with_boxes(spheres, focus, is_small, |sphere| bounds(sphere, focus))
    }

    fn with_boxes(
        spheres: &[PreparedSphere],
        focus: DVec3,
        is_small: impl Fn(usize) -> bool,
        bounds: impl Fn(&PreparedSphere) -> Bounds,
    ) -> Self {
        let (within, outside): (Vec<usize>, Vec<usize>) =
            (0..spheres.len()).partition(|&i| is_small(i));
        let bounds: Vec<Bounds> = within.iter().map(|&i| bounds(&spheres[i])).collect();
        let hierarchy = Hierarchy::build(&bounds);
        let member = |&place: &u32| {
            let sphere = within[place as usize];
            Member { center: spheres[sphere].center, radius: spheres[sphere].radius, sphere }
        };
        let members = hierarchy.order().iter().map(member).collect();
        Self { focus, hierarchy, members, outside }
    }

    /// Places of the spheres that are not in the tree.
    pub(super) fn outside(&self) -> &[usize] {
        &self.outside
    }

    /// Shows `meet` all members that are hit within a limit, and others; near ones come first
    /// by and large. The limit is `limit`, and then what `meet` returns: a negative one ends
    /// the search.
    pub(super) fn visit(&self, ray: &Ray, limit: f64, mut meet: impl FnMut(&Member) -> f64) {
        let nodes = self.hierarchy.nodes();
        let probe = Probe::new(ray, self.focus);
        let mut open = [(0, 0.0); MOST_LEVELS as usize];
        let (mut limit, mut waiting) = (limit, 0);
        let mut next = (!nodes.is_empty()).then_some(0);
        while let Some(index) = next {
            let node = &nodes[index];
            let first = node.first as usize;
            next = None;
            if node.count == 0 {
                let children = [index + 1, first].map(|i| (i, probe.entry(&nodes[i].bounds)));
                let is_swapped = children[1].1 < children[0].1;
                let (near, far) =
                    if is_swapped { (children[1], children[0]) } else { children.into() };
                let is_in_reach = |entry: f64| entry < MISS && entry <= limit;
                if is_in_reach(far.1) {
                    open[waiting] = far;
                    waiting += 1;
                }
                next = is_in_reach(near.1).then_some(near.0);
            } else {
                for member in &self.members[first..first + node.count as usize] {
                    limit = meet(member);
                }
            }
            while next.is_none() && waiting > 0 {
                waiting -= 1;
                next = (open[waiting].1 <= limit).then_some(open[waiting].0);
            }
        }
    }
}

/// The box of a sphere, around the focus.
fn bounds(sphere: &PreparedSphere, focus: DVec3) -> Bounds {
    let center = sphere.center - focus;
    let slack = SLACK * (center.length() + sphere.radius);
    Bounds::of_sphere(center, sphere.radius + slack)
}

/// A ray against boxes.
struct Probe {
    /// Where it starts, moved forwards and back by the slack along each axis.
    ahead: DVec3,
    behind: DVec3,
    /// One over its direction, infinite across.
    inverse: DVec3,
}

impl Probe {
    fn new(ray: &Ray, focus: DVec3) -> Self {
        let origin = ray.origin - focus;
        let slack = SLACK * origin.length();
        Self { ahead: origin + slack, behind: origin - slack, inverse: ray.direction.recip() }
    }

    /// Where the ray comes into a box, not before it starts; [`MISS`] where it does not.
    #[inline]
    fn entry(&self, bounds: &Bounds) -> f64 {
        let low = (bounds.low.as_dvec3() - self.ahead) * self.inverse;
        let high = (bounds.high.as_dvec3() - self.behind) * self.inverse;
        let near = low.min(high).max_element().max(0.0);
        if near <= low.max(high).min_element() { near } else { MISS }
    }
}

#[cfg(test)]
mod tests {
    use super::super::scene::PreparedSphere;
    use super::super::sphere::{MISS, Ray, entry, factored};
    use super::{Bounds, DVec3, Tree};
    use crate::scene::{Albedo, Surface};

    fn sphere(y: f64, radius: f64) -> PreparedSphere {
        let surface = Surface::Diffuse(Albedo::new(DVec3::ONE).expect("an albedo"));
        PreparedSphere { center: DVec3::new(0.0, y, 0.0), radius, inside: false, surface }
    }

    /// How many spheres a tree shows to a ray along x at the height y.
    fn shown(tree: &Tree, y: f64) -> u32 {
        let ray = Ray { origin: DVec3::new(-5.0, y, 0.0), direction: DVec3::X };
        let mut shown = 0;
        tree.visit(&ray, MISS, |_| {
            shown += 1;
            MISS
        });
        shown
    }

    /// ¾ + 2⁻⁵³ from -¼ is 1 to `f64`: a ray that misses a unit sphere by a rounding, and its
    /// box, which ends at ¾ to the bit, is said to hit it.
    #[test]
    fn hits_that_only_rounding_makes_are_kept() {
        let height = 0.75_f64.next_up();
        let spheres = [sphere(-0.25, 1.0), sphere(6.0, 1.0)];
        let ray = Ray { origin: DVec3::new(-5.0, height, 0.0), direction: DVec3::X };
        assert!(entry(factored(&ray, spheres[0].center, 1.0)) < MISS);
        let tree = Tree::over(&spheres, DVec3::ZERO, |_| true);
        assert_eq!(shown(&tree, height), 1);
        // The judge sees boxes that are a rounding of `f32` too small.
        let small = |s: &PreparedSphere| Bounds::of_sphere(s.center, s.radius * (1.0 - 6e-8));
        let small = Tree::with_boxes(&spheres, DVec3::ZERO, |_| true, small);
        assert_eq!(shown(&small, height), 0);
    }

    /// Members know their places in the scene, whatever stays outside.
    #[test]
    fn what_stays_outside_is_not_in_the_tree() {
        let spheres = [0.0, 3.0, 6.0, 9.0].map(|y| sphere(y, 1.0));
        let tree = Tree::over(&spheres, DVec3::ZERO, |i| i == 0 || i == 3);
        assert_eq!(tree.outside(), [1, 2]);
        let mut members: Vec<(usize, u64)> =
            tree.members.iter().map(|member| (member.sphere, member.center.y.to_bits())).collect();
        members.sort_unstable();
        assert_eq!(members, [(0, 0.0_f64.to_bits()), (3, 9.0_f64.to_bits())]);
    }
}
