// Spheres found through a hierarchy of boxes, four to a node. A box holds a little more than
// its spheres, and a ray meets it with a little more room, so that no hit is lost that going
// through all spheres would find (DESIGN.md, "The hierarchy"): the hits are the same, to the
// bit. Only spheres in factored form that do not hold the camera are under it.

// Up to four children and their boxes on a grid.
struct Node {
    origin: vec3<f32>,
    // Four bits for each child: 0 none, 15 a node, otherwise how many spheres; then the
    // biased exponent of the grid's step.
    kinds: u32,
    // A word for each axis, a byte for each child.
    low: vec3<u32>,
    first_node: u32,
    high: vec3<u32>,
    first_sphere: u32,
}

@group(0) @binding(8) var<storage, read> nodes: array<Node>;

// A ray as boxes are met with it: t = inverse·(plane - origin), widened by `pad` on both sides.
struct Climber {
    inverse: vec3<f32>,
    origin: vec3<f32>,
    pad: vec3<f32>,
}

// Roundings by which a ray may pass a box and still hit a sphere in it, in units of the
// coordinates: 64u.
const PAD: f32 = 3.8e-6;

// A direction of zero would give 0·∞.
const STEEPEST: f32 = 1.0e-20;

fn climber(ray: Ray) -> Climber {
    let d = select(ray.direction, vec3<f32>(STEEPEST), abs(ray.direction) < vec3<f32>(STEEPEST));
    let o = abs(ray.origin);
    let inverse = 1.0 / d;
    let room = PAD * (max(max(o.x, o.y), o.z) + scene.reach);
    return Climber(inverse, ray.origin, room * abs(inverse));
}

// What is left to look at: a node or spheres, as (place << 4) | kind.
const A_NODE: u32 = 15u;
const ROOT: u32 = 15u;
const NOTHING: u32 = 0u;

// The children of a node: where a ray enters each, MISS where it does not before `limit`.
struct Children {
    entry: vec4<f32>,
    item: vec4<u32>,
}

fn bytes(word: u32) -> vec4<f32> {
    return vec4<f32>((vec4<u32>(word) >> vec4<u32>(0u, 8u, 16u, 24u)) & vec4<u32>(255u));
}

fn children(place: u32, climber: Climber, limit: f32) -> Children {
    let node = nodes[place];
    let step = bitcast<f32>((node.kinds >> 16u) << 23u);
    let scale = step * climber.inverse;
    let base = (node.origin - climber.origin) * climber.inverse;
    let ahead = climber.inverse >= vec3<f32>(0.0);
    let near = select(node.high, node.low, ahead);
    let far = select(node.low, node.high, ahead);
    let near_base = base - climber.pad;
    let far_base = base + climber.pad;
    let enter = max(
        max(bytes(near.x) * scale.x + near_base.x, bytes(near.y) * scale.y + near_base.y),
        max(bytes(near.z) * scale.z + near_base.z, vec4<f32>(0.0)));
    let leave = min(
        min(bytes(far.x) * scale.x + far_base.x, bytes(far.y) * scale.y + far_base.y),
        min(bytes(far.z) * scale.z + far_base.z, vec4<f32>(limit)));
    let kind = (vec4<u32>(node.kinds) >> vec4<u32>(0u, 4u, 8u, 12u)) & vec4<u32>(15u);
    let is_node = kind == vec4<u32>(A_NODE);
    let number = select(kind, vec4<u32>(1u), is_node);
    // Places of nodes and of spheres are counted on from their first ones.
    let nodes_before = select(vec4<u32>(0u), number, is_node);
    let spheres_before = select(number, vec4<u32>(0u), is_node);
    let first = select(
        node.first_sphere + before(spheres_before), node.first_node + before(nodes_before), is_node);
    let is_met = enter <= leave && kind != vec4<u32>(0u);
    return Children(select(vec4<f32>(MISS), enter, is_met), (first << vec4<u32>(4u)) | kind);
}

// For each of four numbers, the sum of those before it.
fn before(v: vec4<u32>) -> vec4<u32> {
    let two = v.x + v.y;
    return vec4<u32>(0u, v.x, two, two + v.z);
}

// What waits to be looked at.
var<private> waiting: array<u32, STACK>;

// Puts a child that is met on top; the new height.
fn push(height: u32, entry: f32, item: u32) -> u32 {
    if entry < MISS {
        waiting[height] = item;
        return height + 1u;
    }
    return height;
}
