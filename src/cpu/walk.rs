//! Picks one of many lights by a walk down the tree of them, half of the time, and half of
//! the time evenly, as in `shaders/pick_tree.wgsl`.

use super::light::cone_from;
use super::pick::{PICK_BLOCKS, largest_cosine};
use super::rng::{SampleKey, pcg4d, random_bits, unit_float};
use super::trace::SurfacePoint;
use crate::light_tree::{LightTree, Node};

/// Numbers that decide a turn are multiples of 2⁻²⁴.
const TURN_STEPS: f64 = (1 << 24) as f64;

/// What a node's lights are taken to contribute. Within its sphere they may be in any direction.
fn potential(node: &Node, point: &SurfacePoint) -> f64 {
    let cone = cone_from(node.center - point.position, node.radius);
    let cosine = if cone.height < 1.0 { largest_cosine(&cone, point.normal) } else { 1.0 };
    node.brightness * cone.height * cosine + node.everywhere
}

/// The same of a node's children; a leaf counts as one child and none.
fn halves(tree: &LightTree, node: usize, point: &SurfacePoint) -> [f64; 2] {
    let of = |node: usize| potential(&tree.nodes()[node], point);
    if node < tree.lights().len() { [of(2 * node), of(2 * node + 1)] } else { [of(node), 0.0] }
}

/// Chance of turning left, rounded to the numbers that decide it, so that it is taken as often
/// as it says.
fn chance_of_left([left, right]: [f64; 2]) -> f64 {
    let total = left + right;
    let chance = if total > 0.0 { left / total } else { 0.5 };
    (chance * TURN_STEPS).round_ties_even() / TURN_STEPS
}

/// A walk under way.
struct Walk {
    node: usize,
    /// Chance of having come here.
    chance: f64,
}

impl Walk {
    /// Goes to a child of the node, whose two sides may contribute so much: towards the leaf
    /// `to`, or to where `bits` decide.
    fn turn(&mut self, sides: [f64; 2], to: Option<usize>, bits: u32) {
        let left = chance_of_left(sides);
        let below = 2 * self.node;
        // The digits of a number, after the first, are the turns to it.
        let goes_left = match to {
            Some(leaf) => leaf >> (leaf.ilog2() - below.ilog2()) == below,
            None => unit_float(bits) < left,
        };
        self.chance *= if goes_left { left } else { 1.0 - left };
        self.node = below + usize::from(!goes_left);
    }
}

/// Walks to the leaf `to`, or to one that is drawn. Two turns are decided by what the four
/// nodes below them may contribute, which is as many as two turns by two nodes each would look
/// at.
fn walk(tree: &LightTree, point: &SurfacePoint, to: Option<usize>, mut bits: [u32; 4]) -> Walk {
    let count = tree.lights().len();
    let mut walk = Walk { node: 1, chance: 1.0 };
    let mut fresh = false;
    while walk.node < count {
        fresh = !fresh;
        bits = if fresh { pcg4d(bits) } else { [bits[2], bits[3], bits[0], bits[1]] };
        let sides = [2 * walk.node, 2 * walk.node + 1].map(|side| halves(tree, side, point));
        walk.turn(sides.map(|[a, b]| a + b), to, bits[0]);
        if walk.node < count {
            walk.turn(sides[walk.node % 2], to, bits[1]);
        }
    }
    walk
}

/// Chance of a leaf: half of the time by walks, half of the time evenly.
fn with_even_half(tree: &LightTree, walked: f64) -> f64 {
    #[expect(clippy::cast_precision_loss, reason = "a count of spheres")]
    let count = tree.lights().len() as f64;
    0.5 * walked + 0.5 / count
}

/// A number below `count` by 64 random bits, each with the same chance but for `count`/2⁶⁴ of it.
#[expect(clippy::cast_possible_truncation, reason = "less than `count`")]
fn evenly(fraction: u64, count: usize) -> usize {
    ((u128::from(fraction) * count as u128) >> 64) as usize
}

/// Number and chance of the leaf that is picked for a vertex.
pub(super) fn pick_leaf(
    tree: &LightTree,
    point: &SurfacePoint,
    key: SampleKey,
    bounce: u32,
    seed: u32,
) -> (usize, f64) {
    let bits = random_bits(key, PICK_BLOCKS + bounce, seed);
    let count = tree.lights().len();
    let even = bits[0] >> 31 == 1;
    let fraction = (u64::from(bits[1]) << 32) | u64::from(bits[2]);
    let to = even.then(|| count + evenly(fraction, count));
    let Walk { node, chance } = walk(tree, point, to, bits);
    (node, with_even_half(tree, chance))
}

/// Chance of picking a leaf.
pub(super) fn chance_of_leaf(tree: &LightTree, leaf: usize, point: &SurfacePoint) -> f64 {
    with_even_half(tree, walk(tree, point, Some(leaf), [0; 4]).chance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cpu::sampling::{around, polar_hemisphere};
    use crate::scene::{Camera, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface};
    use crate::viewpoint::Viewpoint;
    use glam::DVec3;
    use statrs::distribution::{ChiSquared, ContinuousCDF};

    /// Chance that correct picks fail a test in distribution.
    const FAMILY: f64 = 1e-6;

    fn draw(index: u64, block: u32) -> [f64; 4] {
        random_bits(SampleKey { pixel: 3, index }, block, 0).map(unit_float)
    }

    fn light(center: DVec3, radius: f64, radiance: f64) -> Sphere {
        let radiance = Radiance::new(DVec3::splat(radiance)).expect("a radiance");
        Sphere::new(center, radius, Surface::Emitter(radiance)).expect("a sphere")
    }

    fn scene(spheres: Vec<Sphere>) -> Scene {
        let camera = Camera::new(DVec3::ZERO, DVec3::X, DVec3::Y, 60.0).expect("a camera");
        let size = ImageSize::new(8, 8).expect("a size");
        Scene::new(camera, size, RenderSettings::default(), spheres)
    }

    /// Lamps in a flat layer; their powers span four decades.
    fn lamps(count: u32) -> Vec<Sphere> {
        let lamp = |index| {
            let [x, y, z, power] = draw(u64::from(index), 1);
            let place = DVec3::new(8.0 * x - 4.0, 1.0 + 0.2 * y, 8.0 * z - 4.0);
            light(place, 0.01, 10_f64.powf(4.0 * power - 2.0))
        };
        (0..count).map(lamp).collect()
    }

    fn tree_of(spheres: Vec<Sphere>) -> LightTree {
        let scene = scene(spheres);
        LightTree::of(&scene, &Viewpoint::of(&scene))
    }

    /// Points under the layer, over it and in it, with normals of any direction.
    fn points(count: u64) -> impl Iterator<Item = SurfacePoint> {
        (0..count).map(|index| {
            let place = DVec3::from_slice(&draw(index, 2));
            let [turn, rise, side, _] = draw(index, 3);
            let up = around(DVec3::Y, polar_hemisphere(rise), turn);
            SurfacePoint {
                position: DVec3::new(10.0, 3.0, 10.0) * place - DVec3::new(5.0, 0.0, 5.0),
                normal: if side < 0.5 { up } else { -up },
            }
        })
    }

    fn chances(tree: &LightTree, point: &SurfacePoint) -> Vec<f64> {
        let count = tree.lights().len();
        (count..2 * count).map(|leaf| chance_of_leaf(tree, leaf, point)).collect()
    }

    /// Sums of at most 1000 products of at most 20 factors.
    #[test]
    fn chances_sum_to_one_and_none_is_below_half_of_an_even_one() {
        for count in (1..=40).chain([63, 64, 65, 300, 1000]) {
            let tree = tree_of(lamps(count));
            for point in points(40) {
                let chances = chances(&tree, &point);
                let sum: f64 = chances.iter().sum();
                assert!((sum - 1.0).abs() < 1e-11, "{count} lights, {point:?}: {sum}");
                let even = 1.0 / f64::from(count);
                assert!(chances.iter().all(|&chance| chance >= 0.5 * even), "{point:?}");
            }
        }
    }

    /// χ² of picks over the leaves at one point, those that expect less than 5 in one cell.
    fn p_value(picks: &[usize], chances: &[f64]) -> f64 {
        let mut counts = vec![0.0; chances.len()];
        for &leaf in picks {
            counts[leaf - chances.len()] += 1.0;
        }
        #[expect(clippy::cast_precision_loss, reason = "a count of picks")]
        let expected = chances.iter().map(|chance| chance * picks.len() as f64);
        let (thin, mut cells): (Vec<_>, Vec<_>) =
            counts.into_iter().zip(expected).partition(|cell| cell.1 < 5.0);
        cells.push(thin.iter().fold((0.0, 0.0), |sum, c| (sum.0 + c.0, sum.1 + c.1)));
        let cells = cells.into_iter().filter(|cell| cell.1 >= 5.0);
        let squares: Vec<f64> = cells.map(|(o, e)| (o - e).powi(2) / e).collect();
        #[expect(clippy::cast_precision_loss, reason = "a count of lights")]
        let freedom = squares.len() as f64 - 1.0;
        ChiSquared::new(freedom).expect("several cells").sf(squares.iter().sum())
    }

    /// The leaf whose turns are those of `leaf` in the opposite order.
    fn reversed(leaf: usize) -> usize {
        let turns = leaf.ilog2();
        (0..turns).fold(1, |number, turn| 2 * number + (leaf >> turn) % 2)
    }

    /// The right chances pass; none of the wrong ones does.
    #[test]
    fn picks_follow_their_chances() {
        const PICKS: u64 = 1 << 17;
        // A full row, so that turns in the opposite order lead to a leaf too.
        let tree = tree_of(lamps(256));
        for point in points(4) {
            let pick = |index| pick_leaf(&tree, &point, SampleKey { pixel: 0, index }, 1, 5).0;
            let picks: Vec<usize> = (0..PICKS).map(pick).collect();
            let right = chances(&tree, &point);
            let p = p_value(&picks, &right);
            println!("p = {p:.4}");
            assert!(p > FAMILY / 4.0, "{point:?}: p = {p:e}");
            let of = |leaf: &dyn Fn(usize) -> usize| -> Vec<f64> {
                (256..512).map(|number| right[leaf(number) - 256]).collect()
            };
            let walked = right.iter().map(|chance| 2.0 * chance - 1.0 / 256.0).collect();
            let faults = [
                ("turns from the last to the first", of(&reversed)),
                ("children exchanged", of(&|leaf| 767 - leaf)),
                ("no even half", walked),
                ("even alone", vec![1.0 / 256.0; 256]),
            ];
            for (fault, wrong) in faults {
                let p = p_value(&picks, &wrong);
                assert!(p < FAMILY, "{fault} passes at {point:?}: p = {p}");
            }
        }
    }

    /// Cells of the 64-bit numbers are as wide as they should be, to one of them.
    #[test]
    fn even_numbers_are_even() {
        for count in [1_usize, 2, 3, 257, 1_000_003] {
            let at = |fraction| evenly(fraction, count);
            assert_eq!((at(0), at(u64::MAX)), (0, count - 1));
            for number in [count / 3, count / 2, count - 1] {
                let first = ((number as u128) << 64).div_ceil(count as u128);
                let first = u64::try_from(first).expect("number is below count");
                assert_eq!(at(first), number, "{count}");
                assert!(number == 0 || at(first - 1) == number - 1, "{count}");
            }
        }
    }

    /// From far away a node is worth what its leaves are worth together.
    #[test]
    fn far_nodes_are_the_sum_of_their_lights() {
        let tree = tree_of(lamps(100));
        let point = SurfacePoint { position: DVec3::new(0.0, -1e6, 0.0), normal: DVec3::Y };
        let leaves: f64 = tree.nodes()[100..].iter().map(|leaf| potential(leaf, &point)).sum();
        let root = potential(&tree.nodes()[1], &point);
        assert!((root / leaves - 1.0).abs() < 1e-5, "{root} for {leaves}");
    }

    /// A light that holds the camera and one that is larger than the scene are worth the same
    /// at every point, and leave the bounds of the others alone.
    #[test]
    fn lights_around_the_scene_count_everywhere() {
        let mut spheres = lamps(300);
        spheres.push(light(DVec3::ZERO, 50.0, 0.25));
        spheres.push(light(DVec3::new(0.0, 1000.0, 0.0), 900.0, 0.125));
        let tree = tree_of(spheres);
        for point in points(40) {
            let chance = |place: usize| chance_of_leaf(&tree, tree.leaves()[place], &point);
            let (sky, sun) = (chance(300), chance(301));
            assert!(sky > 0.001 && sun > 0.001, "{sky}, {sun}");
        }
        let root = tree.nodes()[1];
        assert!(root.radius < 6.0, "{root:?}");
        assert!(root.everywhere > 0.25 && root.everywhere <= 0.375, "{root:?}");
    }

    /// What the picks are for: relative variance of what the lights send to points under them
    /// if nothing is hidden, Σf²/p over (Σf)² less 1, which is exact and without samples.
    #[test]
    fn walks_beat_even_picks() {
        let tree = tree_of(lamps(1000));
        let (mut walked, mut even) = (0.0, 0.0);
        for point in points(200) {
            let floor = SurfacePoint { position: point.position.with_y(0.0), normal: DVec3::Y };
            let leaves = &tree.nodes()[1000..];
            let sent: Vec<f64> = leaves.iter().map(|leaf| potential(leaf, &floor)).collect();
            let squared = sent.iter().sum::<f64>().powi(2);
            let second = |chances: &[f64]| -> f64 {
                sent.iter().zip(chances).map(|(f, p)| f * f / p).sum::<f64>() / squared - 1.0
            };
            walked += second(&chances(&tree, &floor)) / 200.0;
            even += second(&[0.001; 1000]) / 200.0;
        }
        println!("relative variance {walked:.2}, with even picks {even:.2}");
        assert!(10.0 * walked < even);
    }
}
