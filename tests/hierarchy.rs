//! The tree of boxes: it holds everything once, its boxes hold what is below them, its depth
//! is bounded, and threads do not change it.

#[path = "../benches/support/volume.rs"]
mod volume;

use candor::hierarchy::{Bounds, Hierarchy, LEAF, MOST_LEVELS, Node};
use glam::DVec3;

fn boxes(spheres: &[(DVec3, f64)]) -> Vec<Bounds> {
    spheres.iter().map(|&(center, radius)| Bounds::of_sphere(center, radius)).collect()
}

fn uniform(count: usize) -> Vec<(DVec3, f64)> {
    let radius = volume::radius(count);
    volume::centers(count).into_iter().map(|center| (center, radius)).collect()
}

/// Each eight times as large and as far as the one before, over the range of `f32`: the split
/// by cost takes off one at a time.
fn chain() -> Vec<(DVec3, f64)> {
    let link = |i: i32| (DVec3::new(3.0 * 8_f64.powi(i), 0.0, 0.0), 8_f64.powi(i));
    (-40..40).map(link).collect()
}

/// Sets of spheres that could upset a builder.
fn hostile() -> Vec<(&'static str, Vec<(DVec3, f64)>)> {
    let at = DVec3::new(0.1, 0.2, 0.3);
    let line = |i: u32| (DVec3::new(f64::from(i), 0.0, 0.0), 0.25);
    let nested = |i: i32| (at, 1.5_f64.powi(i));
    vec![
        ("one", vec![(at, 1.0)]),
        ("five", uniform(5)),
        ("uniform", uniform(20_000)),
        ("all the same", vec![(at, 1.0); 5000]),
        ("one of them elsewhere", [vec![(at, 1.0); 5000], vec![(-at, 1.0)]].concat()),
        ("on a line", (0..3000).map(line).collect()),
        ("one in another", (0..170).map(nested).collect()),
        ("chain", chain()),
        ("chains over each other", (0..40).flat_map(|_| chain()).collect()),
        ("beyond f32", vec![(DVec3::splat(1e300), 1e290), (at, 1e39), (at, 1e-300), (-at, 1.0)]),
    ]
}

/// What is wrong with a tree over some boxes.
fn fault(tree: &[Node], order: &[u32], boxes: &[Bounds]) -> Option<String> {
    let mut seen: Vec<u32> = order.to_vec();
    seen.sort_unstable();
    if !seen.iter().copied().eq(0..u32::try_from(boxes.len()).expect("few")) {
        return Some("the order is not one of all boxes".to_owned());
    }
    let holds = |a: &Bounds, b: &Bounds| a.low.cmple(b.low).all() && a.high.cmpge(b.high).all();
    let (mut open, mut next, mut place) = (vec![], 0, 0);
    // Depth first, without a look at `first` of inner nodes but to compare it.
    while let Some(node) = tree.get(next) {
        let parents: &[usize] = &open;
        if let Some(parent) = parents.iter().find(|&&p| !holds(&tree[p].bounds, &node.bounds)) {
            return Some(format!("node {next} sticks out of {parent}"));
        }
        if parents.len() > MOST_LEVELS as usize {
            return Some(format!("node {next} is too deep"));
        }
        next += 1;
        if node.count == 0 {
            open.push(next - 1);
            continue;
        }
        if node.count as usize > LEAF || node.first as usize != place {
            return Some(format!("leaf {node:?} should begin at {place}"));
        }
        let leaf = &order[place..place + node.count as usize];
        if leaf.iter().any(|&i| !holds(&node.bounds, &boxes[i as usize])) {
            return Some(format!("leaf {node:?} does not hold its boxes"));
        }
        place += leaf.len();
        // The end of a subtree: its parent goes on with the second child or has ended too.
        while let Some(&parent) = open.last() {
            let second = tree[parent].first as usize;
            if second == next {
                break;
            }
            if second > next {
                return Some(format!("the second child of {parent} is not {next}"));
            }
            open.pop();
        }
    }
    (place != boxes.len()).then(|| format!("{place} of {} boxes are in leaves", boxes.len()))
}

#[test]
fn trees_hold_everything_and_are_not_deep() {
    for (name, spheres) in hostile() {
        let boxes = boxes(&spheres);
        let tree = Hierarchy::build(&boxes);
        let found = fault(tree.nodes(), tree.order(), &boxes);
        assert_eq!(found, None, "{name}");
        assert!(tree.depth() <= MOST_LEVELS, "{name}: {}", tree.depth());
    }
    assert_eq!(Hierarchy::build(&[]), Hierarchy::default());
}

/// The chain is what makes trees deep; without the bound it would be nearly 80 levels.
#[test]
fn a_chain_reaches_the_bound() {
    let tree = Hierarchy::build(&boxes(&chain()));
    assert!((MOST_LEVELS - 3..=MOST_LEVELS).contains(&tree.depth()), "{}", tree.depth());
}

#[test]
fn the_judge_rejects_faults() {
    let boxes = boxes(&uniform(300));
    let tree = Hierarchy::build(&boxes);
    let (nodes, order) = (tree.nodes(), tree.order());
    let with = |index: usize, change: &dyn Fn(&mut Node)| {
        let mut nodes = nodes.to_vec();
        change(&mut nodes[index]);
        fault(&nodes, order, &boxes)
    };
    let leaf = nodes.iter().position(|node| node.count > 1).expect("a leaf of two or more");
    assert!(with(0, &|node| node.bounds.high.y = node.bounds.high.y.next_down()).is_some());
    assert!(with(leaf, &|node| node.bounds.low.x = node.bounds.low.x.next_up()).is_some());
    assert!(with(leaf, &|node| node.count -= 1).is_some());
    assert!(with(0, &|node| node.first += 2).is_some());
    let mut twice = order.to_vec();
    twice[7] = twice[8];
    assert!(fault(nodes, &twice, &boxes).is_some());
}

#[test]
fn threads_do_not_change_the_tree() {
    for spheres in [uniform(200_000), (0..300).flat_map(|_| chain()).collect()] {
        let boxes = boxes(&spheres);
        let on = |threads| {
            let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build();
            pool.expect("threads").install(|| Hierarchy::build(&boxes))
        };
        let alone = on(1);
        assert!([2, 3, 8].into_iter().all(|threads| on(threads) == alone));
    }
}
