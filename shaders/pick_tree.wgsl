// Many lights: one is picked by a walk down a tree of them, half of the time, and half of the
// time evenly. The tree is complete (src/light_tree.rs): node 1 is the root, the children of
// node m are 2m and 2m + 1, and of n lights the leaves are n to 2n - 1.

struct LightNode {
    // A sphere around the lights.
    center: vec3<f32>,
    radius: f32,
    // Radiance that makes the sphere as bright, from far away, as its lights together.
    brightness: f32,
    // What lights contribute that look much the same from everywhere in the scene.
    everywhere: f32,
    // Of a leaf: place of the light.
    light: u32,
}

@group(0) @binding(9) var<storage, read> light_tree: array<LightNode>;

// What a node's lights are taken to contribute. Within its sphere they may be in any
// direction; its very centre has no axis.
fn node_potential(node: u32, point: SurfacePoint) -> f32 {
    let lights = light_tree[node];
    let cone = cone_factored(point.position, lights.center, lights.radius);
    let cosine = select(1.0, largest_cosine(cone, point.normal), cone.height < 1.0);
    return lights.brightness * cone.height * cosine + lights.everywhere;
}

// The same of a node's children; a leaf counts as one child and none.
fn halves(node: u32, point: SurfacePoint) -> vec2<f32> {
    if node >= scene.light_count {
        return vec2<f32>(node_potential(node, point), 0.0);
    }
    return vec2<f32>(node_potential(2u * node, point), node_potential(2u * node + 1u, point));
}

struct Walk {
    node: u32,
    // Chance of having come here.
    chance: f32,
}

// Goes to a child of the node, whose two sides may contribute so much: towards the leaf `to`,
// or to where `bits` decide if that is 0. The chance is rounded to the numbers that decide it,
// multiples of 2^-24, so that a turn is taken as often as it says.
fn turned(walk: Walk, left: f32, right: f32, to: u32, bits: u32) -> Walk {
    let total = left + right;
    let chance = select(0.5, round(left / total * 16777216.0) * 5.9604644775390625e-8, total > 0.0);
    let below = 2u * walk.node;
    // The digits of a number, after the first, are the turns to it.
    let toward = to >> ((firstLeadingBit(to) - firstLeadingBit(below)) & 31u);
    let goes_left = select(toward == below, unit_float(bits) < chance, to == 0u);
    return Walk(below + u32(!goes_left), walk.chance * select(1.0 - chance, chance, goes_left));
}

// Walks to the leaf `to`, or to one that is drawn if that is 0. Two turns are decided by what
// the four nodes below them may contribute, which is as many as two turns by two nodes each
// would look at.
fn walk_to(to: u32, point: SurfacePoint, key: vec4<u32>) -> Walk {
    var bits = key;
    var walk = Walk(1u, 1.0);
    var fresh = false;
    while walk.node < scene.light_count {
        fresh = !fresh;
        bits = select(bits.zwxy, pcg4d(bits), fresh);
        let left = halves(2u * walk.node, point);
        let right = halves(2u * walk.node + 1u, point);
        walk = turned(walk, left.x + left.y, right.x + right.y, to, bits.x);
        if walk.node < scene.light_count {
            let side = select(left, right, (walk.node & 1u) == 1u);
            walk = turned(walk, side.x, side.y, to, bits.y);
        }
    }
    unfinished = unfinished || walk.node < scene.light_count;
    return walk;
}

fn with_even_half(walked: f32) -> f32 {
    return 0.5 * walked + 0.5 / f32(scene.light_count);
}

// A number below `count` by 64 random bits, each with the same chance but for count/2^64 of it.
fn evenly(high: u32, low: u32, count: u32) -> u32 {
    let whole = multiply(high, count);
    return whole.y + u32(whole.x + multiply(low, count).y < whole.x);
}

fn walk_for_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    let bits = random_bits(key, PICK_BLOCKS + bounce);
    let leaf = scene.light_count + evenly(bits.y, bits.z, scene.light_count);
    let walk = walk_to(select(0u, leaf, (bits.x >> 31u) == 1u), point, bits);
    return Pick(light_tree[walk.node].light, with_even_half(walk.chance));
}
