//! Mutants of the searches by hierarchy and of the walks to a light.

use super::kernel_judge::Judge;
use candor::scene::Estimator::{self, Explicit, Implicit, Mis};

/// What is wrong, under which estimator, what stands in the kernel, what takes its place, and
/// who tells.
pub type Mutant = (&'static str, Estimator, &'static str, &'static str, Judge);

/// Of searches by hierarchy, and of walks to a light.
pub const TREE_MUTANTS: &[Mutant] = &[
    (
        "far side of a box",
        Implicit,
        "select(node.high, node.low, ahead)",
        "select(node.low, node.high, ahead)",
        Judge::Swarm,
    ),
    ("boxes cut short", Implicit, "vec4<f32>(limit)", "vec4<f32>(0.5 * limit)", Judge::Swarm),
    (
        "boxes half as large",
        Implicit,
        "(node.kinds >> 16u) <<",
        "((node.kinds >> 16u) - 1u) <<",
        Judge::Swarm,
    ),
    ("a sibling forgotten", Implicit, "if met > 1u {", "if met > 2u {", Judge::Swarm),
    ("siblings that wait forgotten", Implicit, "(*way).height++;", "", Judge::Swarm),
    ("a child twice", Implicit, "max(c.x, c.y), max(b.x", "min(c.x, c.y), max(b.x", Judge::Swarm),
    ("the same sibling again", Implicit, "((rest & 0x3fu) >> 2u)", "(rest & 0x3fu)", Judge::Swarm),
    ("node of the first child", Implicit, " + countOneBits(nodes)", "", Judge::Swarm),
    (
        "spheres of the first child",
        Implicit,
        "siblings.first_sphere + spheres",
        "siblings.first_sphere",
        Judge::Swarm,
    ),
    (
        "first sphere off by one",
        Implicit,
        "let first = item >> 4u;",
        "let first = (item >> 4u) + 1u;",
        Judge::Swarm,
    ),
    ("last sphere of a leaf", Implicit, "first + (item & 15u) - 1u", "first", Judge::Swarm),
    (
        "last of equal distances",
        Implicit,
        "spheres[here.sphere].index <",
        "spheres[here.sphere].index >",
        Judge::Swarm,
    ),
    ("last of a leaf's equal distances", Implicit, "t.y < t.x", "t.y <= t.x", Judge::Swarm),
    ("earlier ones do not hide", Explicit, "(t == distance &&", "(t > MISS &&", Judge::Swarm),
    (
        "behind the light",
        Explicit,
        "return t < distance || (t ==",
        "return t > distance || (t ==",
        Judge::Swarm,
    ),
    (
        "only the last hides",
        Explicit,
        "blocked = hides(pair.x, ray",
        "blocked = hides(pair.y, ray",
        Judge::Swarm,
    ),
    (
        "later ones hide",
        Explicit,
        "spheres[i].index < spheres[light].index",
        "spheres[i].index > spheres[light].index",
        Judge::Swarm,
    ),
    ("chance of the last turn", Explicit, "walk.chance * select(", "select(", Judge::Layer),
    (
        "light of the next leaf",
        Explicit,
        "light_tree[walk.node].light",
        "light_tree[walk.node ^ 1u].light",
        Judge::Layer,
    ),
    (
        "never evenly",
        Explicit,
        "0.5 * walked + 0.5 / f32(scene.light_count)",
        "walked",
        Judge::Layer,
    ),
    (
        "chance of the other side",
        Mis,
        "select(1.0 - chance, chance, goes_left)",
        "select(chance, 1.0 - chance, goes_left)",
        Judge::Layer,
    ),
];
