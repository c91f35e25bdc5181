// Spheres found through a hierarchy of boxes, four to a node. A box holds a little more than
// its spheres, and a ray meets it with a little more room, so that no hit is lost that going
// through all spheres would find (DESIGN.md, "Many spheres"): the hits are the same, to the
// bit. Only spheres in factored form that do not hold the camera are under it.

// Up to four children and their boxes on a grid.
struct Node {
    origin: vec3<f32>,
    // Four bits for each child: 0 none, 15 a node, otherwise how many spheres, 1 or 2; then the
    // biased exponent of the grid's step.
    kinds: u32,
    // A word for each axis, a byte for each child.
    low: vec3<u32>,
    first_node: u32,
    high: vec3<u32>,
    first_sphere: u32,
}

@group(0) @binding(8) var<storage, read> nodes: array<Node>;

// A ray as boxes are met with it: t = inverse·(plane - origin).
struct Climber {
    inverse: vec3<f32>,
    origin: vec3<f32>,
    // The largest coordinate of the origin.
    size: f32,
}

// By how much of its coordinates a ray may pass a box and still hit a sphere in it: 256u.
const PAD: f32 = 1.52587890625e-5;

// A direction of zero would give 0·∞.
const STEEPEST: f32 = 1.0e-12;

fn climber(ray: Ray) -> Climber {
    let d = select(ray.direction, vec3<f32>(STEEPEST), abs(ray.direction) < vec3<f32>(STEEPEST));
    return Climber(1.0 / d, ray.origin, largest(ray.origin));
}

fn largest(v: vec3<f32>) -> f32 {
    return max(max(abs(v.x), abs(v.y)), abs(v.z));
}

// What is to be looked at: a node or spheres, as (place << 4) | kind.
const A_NODE: u32 = 15u;
const ROOT: u32 = 15u;
const NOTHING: u32 = 0u;

// A node's children that are yet to be looked at.
struct Siblings {
    // Of the node.
    kinds: u32,
    first_node: u32,
    first_sphere: u32,
    // (place of the node << 8) | (how many << 6) | their numbers, two bits each, the next one
    // lowest.
    rest: u32,
}

fn has_more(siblings: Siblings) -> bool {
    return (siblings.rest & 0xc0u) != 0u;
}

// The siblings but for the next one.
fn without_next(rest: u32) -> u32 {
    return (rest & 0xffffff00u) | ((rest - 0x40u) & 0xc0u) | ((rest & 0x3fu) >> 2u);
}

// The child with a number. Places of nodes and of spheres are counted on from the first ones.
fn child(siblings: Siblings, number: u32) -> u32 {
    let kind = (siblings.kinds >> (4u * number)) & 15u;
    let earlier = siblings.kinds & ((1u << (4u * number)) - 1u);
    // Which of those are nodes, a bit for each; how many spheres the others are.
    let nodes = earlier & (earlier >> 1u) & (earlier >> 2u) & (earlier >> 3u) & 0x111u;
    let others = earlier - 15u * nodes;
    let spheres = (others & 15u) + ((others >> 4u) & 15u) + (others >> 8u);
    let place = select(
        siblings.first_sphere + spheres, siblings.first_node + countOneBits(nodes), kind == A_NODE);
    return (place << 4u) | kind;
}

fn bytes(word: u32) -> vec4<f32> {
    return vec4<f32>((vec4<u32>(word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u));
}

// Steps of a node's grid.
const GRID: f32 = 255.0;

const NOT_MET: u32 = 0xffffffffu;

// Where a ray enters each child, as bits that grow with the distance, the number of the child
// in the lowest two; NOT_MET where it does not before `limit`.
fn entries(node: Node, climber: Climber, limit: f32) -> vec4<u32> {
    let step = bitcast<f32>((node.kinds >> 16u) << 23u);
    let scale = step * climber.inverse;
    let base = (node.origin - climber.origin) * climber.inverse;
    let ahead = climber.inverse >= vec3<f32>(0.0);
    let near = select(node.high, node.low, ahead);
    let far = select(node.low, node.high, ahead);
    let room = PAD * (climber.size + largest(node.origin) + GRID * step) * abs(climber.inverse);
    let near_base = base - room;
    let far_base = base + room;
    let enter = max(
        max(bytes(near.x) * scale.x + near_base.x, bytes(near.y) * scale.y + near_base.y),
        max(bytes(near.z) * scale.z + near_base.z, vec4<f32>(0.0)));
    let leave = min(
        min(bytes(far.x) * scale.x + far_base.x, bytes(far.y) * scale.y + far_base.y),
        min(bytes(far.z) * scale.z + far_base.z, vec4<f32>(limit)));
    let kind = (vec4<u32>(node.kinds) >> vec4<u32>(0u, 4u, 8u, 12u)) & vec4<u32>(15u);
    let is_met = (enter <= leave) & (kind != vec4<u32>(0u));
    let key = (bitcast<vec4<u32>>(enter) & vec4<u32>(0xfffffffcu)) | vec4<u32>(0u, 1u, 2u, 3u);
    return select(vec4<u32>(NOT_MET), key, is_met);
}

fn sorted(v: vec4<u32>) -> vec4<u32> {
    let a = min(v.xz, v.yw);
    let b = max(v.xz, v.yw);
    let c = vec2<u32>(max(a.x, a.y), min(b.x, b.y));
    return vec4<u32>(min(a.x, a.y), min(c.x, c.y), max(c.x, c.y), max(b.x, b.y));
}

// The way of one ray through the hierarchy.
struct Way {
    item: u32,
    siblings: Siblings,
    // How many others wait.
    height: u32,
}

// Siblings that wait.
var<private> waiting: array<u32, STACK>;

fn holds_node(way: Way) -> bool {
    return (way.item & 15u) == A_NODE;
}

fn holds_spheres(way: Way) -> bool {
    return way.item != NOTHING && !holds_node(way);
}

// A leaf's spheres: two, or twice the same one.
fn pair_of(item: u32) -> vec2<u32> {
    let first = item >> 4u;
    return vec2<u32>(first, first + (item & 15u) - 1u);
}

fn has_ended(way: Way) -> bool {
    return way.item == NOTHING && way.height == 0u && !has_more(way.siblings);
}

// Goes down into a node: the nearest child that the ray meets is next, the others wait.
fn descend(way: ptr<function, Way>, climber: Climber, limit: f32) {
    let place = (*way).item >> 4u;
    let node = nodes[place];
    let key = sorted(entries(node, climber, limit));
    let met = dot(vec4<u32>(key != vec4<u32>(NOT_MET)), vec4<u32>(1u));
    let numbers = (key.y & 3u) | ((key.z & 3u) << 2u) | ((key.w & 3u) << 4u);
    let rest = (place << 8u) | ((met - 1u) << 6u) | numbers;
    let own = Siblings(node.kinds, node.first_node, node.first_sphere, rest);
    (*way).item = NOTHING;
    if met > 0u {
        (*way).item = child(own, key.x & 3u);
    }
    if met > 1u {
        if has_more((*way).siblings) {
            waiting[(*way).height] = (*way).siblings.rest;
            (*way).height++;
        }
        (*way).siblings = own;
    }
}

// Takes what is next, if nothing is at hand.
fn go_on(way: ptr<function, Way>) {
    if (*way).item != NOTHING {
        return;
    }
    if !has_more((*way).siblings) && (*way).height > 0u {
        (*way).height--;
        let rest = waiting[(*way).height];
        let place = rest >> 8u;
        (*way).siblings = Siblings(
            nodes[place].kinds, nodes[place].first_node, nodes[place].first_sphere, rest);
    }
    if has_more((*way).siblings) {
        let rest = (*way).siblings.rest;
        (*way).item = child((*way).siblings, rest & 3u);
        (*way).siblings.rest = without_next(rest);
    }
}
