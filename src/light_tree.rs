//! A tree over many lights, so that picking one takes a walk and not a scan.
//!
//! The idea is that of Estevez & Kulla, "Importance Sampling of Many Lights with Adaptive Tree
//! Splitting" (Proc. ACM CGIT 1(2), 2018), without the splitting: a walk goes left or right in
//! proportion to what the lights there may contribute. Here the tree is complete, so that it
//! needs no pointers and no stack: node 1 is the root, the children of node m are 2m and
//! 2m + 1, and light k of n is node n + k. The binary digits of a node's number, after the
//! first, are the turns from the root to it.
//!
//! Which lights a node holds is decided here; each tracer weighs them by itself.

use crate::scene::{Scene, Sphere, Surface};
use crate::viewpoint::Viewpoint;
use glam::DVec3;

/// Up to this many lights are scanned, which takes longer but bounds each of them on its own
/// (BENCHMARKS.md, "Many lights"). With more of them a tree is walked.
pub const SCANNED_LIGHTS: usize = 128;

/// Below this many lights, sorting them costs less than handing half of them to another thread.
const PARALLEL_LIGHTS: usize = 4096;

/// What is known of a node's lights. At a point they are taken to contribute `everywhere`, and
/// `brightness` times what a light of the size of the node's sphere would: for a leaf that is
/// the bound by which lights are scanned; from far away a node's is the sum of its leaves'.
/// Lengths are in scene units, radiance in the scene's own.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Node {
    /// Centre of a sphere around the lights.
    pub center: DVec3,
    /// Its radius; 1 where there are none, so that nothing is divided by 0.
    pub radius: f64,
    /// Radiance that makes the sphere as bright, from far away, as its lights together:
    /// Σ L·r² over the square of the radius, L the brightest channel; 0 where there are none.
    pub brightness: f64,
    /// Bound on what lights contribute that hold the camera or are larger than the scene: they
    /// look much the same from everywhere in it.
    pub everywhere: f64,
}

impl Node {
    /// Of lights that are worth the same everywhere.
    fn without_sphere(everywhere: f64) -> Self {
        Self { radius: 1.0, everywhere, ..Self::default() }
    }
}

/// A complete binary tree over a scene's lights.
#[derive(Debug, Clone, PartialEq)]
pub struct LightTree {
    /// Of every node; the one before the root is empty.
    nodes: Vec<Node>,
    /// Places of the lights in the scene, in the order of the leaves.
    lights: Vec<usize>,
    /// For each sphere of the scene, the number of its leaf; 0 if it is no light.
    leaves: Vec<usize>,
}

/// The lights' places in the scene, in the order of the file.
pub fn places(scene: &Scene) -> impl Iterator<Item = usize> + '_ {
    let spheres = scene.spheres().iter().enumerate();
    spheres.filter(|(_, sphere)| sphere.emits()).map(|(place, _)| place)
}

/// Most iterations of loops over lights at one vertex: of scans, two to pick a light and one
/// for the chance of a light that the path hits by itself; of walks, which take two turns in
/// one iteration, one for each.
#[must_use]
pub fn most_iterations(lights: usize) -> u64 {
    let most_turns = lights.next_power_of_two().trailing_zeros();
    if lights > SCANNED_LIGHTS {
        2 * (u64::from(most_turns.div_ceil(2)) + 1)
    } else {
        3 * (lights as u64 + 1)
    }
}

impl LightTree {
    /// The tree of a scene's lights; without any it has no node.
    #[must_use]
    pub fn of(scene: &Scene, viewpoint: &Viewpoint) -> Self {
        let leaf = |place| Leaf::of(scene, viewpoint, place);
        let mut leaves: Vec<Leaf> = places(scene).map(leaf).collect();
        arrange(&mut leaves);
        let count = leaves.len();
        let mut nodes = vec![Node::default(); 2 * count];
        // From left to right, the leaves of the lower row come first.
        let lower = (2 * count).saturating_sub(count.next_power_of_two());
        leaves.rotate_left(lower);
        for (node, leaf) in nodes[count..].iter_mut().zip(&leaves) {
            *node = leaf.node;
        }
        if count > 1 {
            join_below(&mut nodes, 1);
        }
        let lights: Vec<usize> = leaves.into_iter().map(|leaf| leaf.place).collect();
        let mut leaves = vec![0; scene.spheres().len()];
        for (number, &place) in (count..).zip(&lights) {
            leaves[place] = number;
        }
        Self { nodes, lights, leaves }
    }

    /// All nodes by their numbers; number 0 is empty.
    #[must_use]
    pub fn nodes(&self) -> &[Node] {
        &self.nodes
    }

    /// The lights' places in the scene: of n lights, number k is leaf n + k.
    #[must_use]
    pub fn lights(&self) -> &[usize] {
        &self.lights
    }

    /// For each sphere of the scene, the number of its leaf; 0 if it is no light.
    #[must_use]
    pub fn leaves(&self) -> &[usize] {
        &self.leaves
    }
}

/// A light before it has its number.
#[derive(Debug, Clone, Copy)]
struct Leaf {
    place: usize,
    node: Node,
    /// Where it is sorted.
    at: DVec3,
}

impl Leaf {
    fn of(scene: &Scene, viewpoint: &Viewpoint, place: usize) -> Self {
        let sphere = &scene.spheres()[place];
        let (center, radius, brightness) = (sphere.center(), sphere.radius(), brightest(sphere));
        let inside = viewpoint.inside()[place];
        if inside || radius > viewpoint.extent() {
            let height = if inside { 1.0 } else { largest_height(sphere, viewpoint) };
            let node = Node::without_sphere(brightness * height);
            return Self { place, node, at: viewpoint.focus() };
        }
        let node = Node { center, radius, brightness, everywhere: 0.0 };
        Self { place, node, at: center }
    }
}

/// The brightest channel of what a sphere emits.
fn brightest(sphere: &Sphere) -> f64 {
    match sphere.surface() {
        Surface::Emitter(radiance) => radiance.rgb().max_element(),
        Surface::Diffuse(_) | Surface::Glossy(..) => 0.0,
    }
}

/// 1 − cosσ of the cone in which a sphere is seen from where the scene comes nearest to it.
fn largest_height(sphere: &Sphere, viewpoint: &Viewpoint) -> f64 {
    let nearest = sphere.center().distance(viewpoint.focus()) - viewpoint.extent();
    let sine = sphere.radius() / nearest.max(sphere.radius());
    sine * sine / (1.0 + (1.0 - sine * sine).sqrt())
}

/// Leaves under the left child of a node with `count` of them, in a complete tree: half of the
/// last full row, and what of the lower row is under it.
fn left_of(count: usize) -> usize {
    let half = 1 << (count.ilog2() - 1);
    half + (count - 2 * half).min(half)
}

/// Puts leaves into their order from left to right: each node's are divided across the axis
/// along which they reach farthest. Where they stand at equal places, the order of the file
/// decides.
fn arrange(leaves: &mut [Leaf]) {
    if leaves.len() < 2 {
        return;
    }
    let (low, high) = leaves.iter().fold((leaves[0].at, leaves[0].at), |(low, high), leaf| {
        (low.min(leaf.at), high.max(leaf.at))
    });
    let axis = (high - low).max_position();
    let middle = left_of(leaves.len());
    leaves.select_nth_unstable_by(middle, |a, b| {
        a.at[axis].total_cmp(&b.at[axis]).then(a.place.cmp(&b.place))
    });
    let parallel = leaves.len() > PARALLEL_LIGHTS;
    let (left, right) = leaves.split_at_mut(middle);
    if parallel {
        rayon::join(|| arrange(left), || arrange(right));
    } else {
        arrange(left);
        arrange(right);
    }
}

/// The corners of a box that holds nothing.
const NOTHING: (DVec3, DVec3) = (DVec3::INFINITY, DVec3::NEG_INFINITY);

/// Fills in the inner nodes from `number` down; the box around what their spheres hold.
fn join_below(nodes: &mut [Node], number: usize) -> (DVec3, DVec3) {
    if 2 * number >= nodes.len() {
        let Node { center, radius, brightness, .. } = nodes[number];
        return if brightness > 0.0 { (center - radius, center + radius) } else { NOTHING };
    }
    let (left, right) = (join_below(nodes, 2 * number), join_below(nodes, 2 * number + 1));
    let (low, high) = (left.0.min(right.0), left.1.max(right.1));
    nodes[number] = join([nodes[2 * number], nodes[2 * number + 1]], low, high);
    (low, high)
}

/// A node of two. Its sphere stands in the middle of the box; the box and the children's
/// spheres both bound how far it must reach.
fn join(children: [Node; 2], low: DVec3, high: DVec3) -> Node {
    let everywhere = children[0].everywhere + children[1].everywhere;
    let shining = || children.iter().filter(|child| child.brightness > 0.0);
    if shining().count() == 0 {
        return Node::without_sphere(everywhere);
    }
    let center = low.midpoint(high);
    let reach = shining().map(|child| child.center.distance(center) + child.radius);
    let radius = reach.fold(0.0, f64::max).min(high.distance(center));
    let share = |child: &Node| child.brightness * (child.radius / radius).powi(2);
    Node { center, radius, brightness: shining().map(share).sum(), everywhere }
}
