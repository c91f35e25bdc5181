//! Where the time goes on the way through the hierarchy: kernels in which one part of it is
//! done twice, beside the kernel as it is.

use crate::counted::{Change, changed, counted};
use crate::processor::timed;
use crate::turns::{self, Measure, Middle, median};
use crate::{SIDE, tracer};
use candor::bound::sample_scale;
use candor::effects::{Effect, Effects};
use candor::gpu::Adapter;
use candor::kernel::{self, Kernel};
use candor::scene::Scene;
use candor::tracer::Tracer;
use candor::viewpoint::Viewpoint;

/// A part that is done twice. Each has a use for both results that a compiler cannot see to
/// be none.
const PARTS: [(&str, &[Change]); 6] = [
    ("a node's words are read", &[(
        "    let node = nodes[place];\n",
        "    let first = nodes[place];
    let mixed = bitcast<vec3<u32>>(first.origin) ^ first.low ^ first.high;
    let rest_mixed = first.kinds ^ first.first_node ^ first.first_sphere;
    let other = (mixed.x ^ mixed.y ^ mixed.z ^ rest_mixed) == 0x9e3779b9u;
    let node = nodes[place + u32(other)];\n",
    )]),
    ("a ray meets a node's four boxes", &[(
        "    let key = sorted(entries(node, climber, limit));\n",
        "    let first = sorted(entries(node, climber, limit));
    let other = all(first == vec4<u32>(0x9e3779b9u));
    let key = sorted(entries(node, climber, select(limit, 0.5 * limit, other)));\n",
    )]),
    ("a leaf's spheres are tested", &[(
        "            best = nearest_of(way.item, best, ray, leaving);\n",
        "            best = nearest_of(way.item, best, ray, leaving);
            best = nearest_of(way.item, best, ray, leaving);\n",
    )]),
    ("siblings are put aside", &[(
        "            waiting[(*way).height] = (*way).siblings.rest;\n",
        "            waiting[(*way).height] = (*way).siblings.rest;
            put_aside[(*way).height] = (*way).siblings.rest;\n",
    ), (
        "        let rest = waiting[(*way).height];\n",
        "        let rest = waiting[(*way).height] & put_aside[(*way).height];\n",
    ), (
        "var<private> waiting: array<u32, STACK>;\n",
        "var<private> waiting: array<u32, STACK>;\nvar<private> put_aside: array<u32, STACK>;\n",
    )]),
    ("what waits is read again from its node", &[(
        "        (*way).siblings = Siblings(
            nodes[place].kinds, nodes[place].first_node, nodes[place].first_sphere, rest);\n",
        "        let mixed = nodes[place].kinds ^ nodes[place].first_node ^ nodes[place].first_sphere;
        let other = place + u32(mixed == 0x9e3779b9u);
        (*way).siblings = Siblings(
            nodes[other].kinds, nodes[other].first_node, nodes[other].first_sphere, rest);\n",
    )]),
    ("the next sibling is taken", &[(
        "        (*way).item = child((*way).siblings, rest & 3u);\n",
        "        let first = child((*way).siblings, rest & 3u);
        (*way).item = child((*way).siblings, (rest & 3u) ^ u32(first == 0x9e3779b9u));\n",
    )]),
];

/// Prints what each part takes in a scene.
pub fn print(scene: &Scene, adapter: &Adapter, rounds: u64) {
    let viewpoint = Viewpoint::of(scene);
    let effects = Effects::of(scene, &viewpoint).with(Effect::Hierarchy);
    let packed = kernel::pack(scene, &viewpoint, effects, sample_scale(scene));
    let wgsl = Kernel::of(scene, effects, &packed).wgsl();
    let counted = counted(&wgsl, |wgsl| tracer(scene, adapter, &packed, wgsl));
    println!(
        "{} spheres; {:.2} segments a sample, each of which looks at {:.1} nodes of four boxes and \
         {:.2} spheres",
        scene.spheres().len() - 1,
        counted.segments,
        counted.nodes,
        counted.spheres
    );
    let texts = std::iter::once(wgsl.clone());
    let texts = texts.chain(PARTS.iter().map(|(_, changes)| changed(&wgsl, changes)));
    let mut rows: Vec<Measure> = texts
        .map(|text| {
            let mut tracer = tracer(scene, adapter, &packed, &text);
            tracer.add_samples(0..4).expect("samples");
            let measure = move |round: u64| {
                let samples = 4 * (round + 1)..4 * (round + 2);
                timed(|| tracer.add_samples(samples).expect("samples")).processor
            };
            Box::new(measure) as Measure
        })
        .collect();
    let times = turns::take(rounds, &mut rows);
    let samples = 4.0 * f64::from(SIDE * SIDE) * counted.segments;
    println!("As it is: {:.0} ns of processors a segment.\n", median(&times[0]) * 1e9 / samples);
    println!("| done twice | adds |\n|---|---|");
    for ((name, _), values) in PARTS.iter().zip(&times[1..]) {
        let ratios = std::iter::zip(values, &times[0]).map(|(a, b)| 100.0 * (a / b - 1.0));
        println!("| {name} | {} % |", Middle::of(&ratios.collect::<Vec<f64>>()));
    }
}
