//! A validated scene in kernel units, ready for the device.

use super::layout::{self, SPHERE_CAPACITY};
use super::turns::most_turns;
use super::wide::Wide;
use crate::effects::{Effect, Effects};
use crate::film::SampleScale;
use crate::hierarchy::{Bounds, Hierarchy};
use crate::light_tree::{LightTree, Node};
use crate::scene::{Scene, Sphere, Surface};
use crate::viewpoint::{Form, Viewpoint, is_small};
use glam::DVec3;

/// From scene units to kernel units: `(p - focus)·2^-exponent`, so that the extent lies
/// in [1, 2). Scaling by a power of two rounds nothing.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct KernelUnits {
    focus: DVec3,
    scale: f64,
}

impl KernelUnits {
    /// The units of a scene seen from `viewpoint`.
    #[must_use]
    pub fn of(viewpoint: &Viewpoint) -> Self {
        Self { focus: viewpoint.focus(), scale: (-viewpoint.extent().log2().floor()).exp2() }
    }

    /// A point in kernel units.
    #[must_use]
    pub fn point(&self, p: DVec3) -> DVec3 {
        (p - self.focus) * self.scale
    }

    /// A length in kernel units.
    #[must_use]
    pub fn length(&self, length: f64) -> f64 {
        length * self.scale
    }
}

/// A packed scene.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Packed {
    /// What goes into the uniform buffer.
    pub scene: layout::Scene,
    /// Those under the hierarchy leaf by leaf, then the others in factored form, then those in
    /// anchored form, the last two in the order of the scene file.
    pub spheres: Vec<layout::Sphere>,
    /// Places of the emitters among them, in the order of the scene file.
    pub lights: Vec<u32>,
    /// The hierarchy; empty where there is none.
    pub nodes: Vec<layout::Node>,
    /// Most siblings that wait while a ray goes through the hierarchy.
    pub stack: u32,
    /// Most turns that a ray is to be reckoned with in its loop there.
    pub turns: u64,
    /// The tree over the lights; empty where there is none.
    pub light_tree: Vec<layout::LightNode>,
    /// Form of every sphere, in the order of the scene file.
    pub forms: Vec<Form>,
}

impl Packed {
    /// Whether spheres and lights go into storage buffers, not into uniform ones.
    #[must_use]
    pub fn is_stored(&self) -> bool {
        !self.nodes.is_empty() || self.spheres.len() > SPHERE_CAPACITY
    }
}

/// Packs a scene for the device: with a hierarchy, if that is among the effects and there is
/// a sphere for it.
#[must_use]
pub fn pack(scene: &Scene, viewpoint: &Viewpoint, effects: Effects, scale: SampleScale) -> Packed {
    let spheres = scene.spheres();
    let units = KernelUnits::of(viewpoint);
    let (forms, inside) = (viewpoint.forms(), viewpoint.inside());
    let packed_sphere =
        |&index: &usize| pack_sphere(&spheres[index], index, forms[index], inside[index], &units);
    let (small, large): (Vec<usize>, Vec<usize>) = (0..spheres.len())
        .partition(|&i| effects.has(Effect::Hierarchy) && is_small(forms[i], inside[i]));
    let small: Vec<layout::Sphere> = small.iter().map(packed_sphere).collect();
    let boxes: Vec<Bounds> = small.iter().map(bounds).collect();
    let hierarchy = Hierarchy::build(&boxes);
    let wide = Wide::of(&hierarchy);
    let of_form = |wanted| large.iter().filter(move |&&index| forms[index] == wanted);

    let mut packed: Vec<layout::Sphere> = wide.order.iter().map(|&i| small[i as usize]).collect();
    packed.extend(of_form(Form::Factored).map(packed_sphere));
    let factored_count = word(packed.len());
    packed.extend(of_form(Form::Anchored).map(packed_sphere));

    let mut header: layout::Scene = bytemuck::Zeroable::zeroed();
    pack_camera(&mut header, scene, viewpoint, &units);
    header.hierarchy_count = word(wide.order.len());
    header.factored_count = factored_count;
    header.sphere_count = word(packed.len());
    header.seed = scene.settings().seed();
    header.film_shift = scale.shift();
    header.bound_bits = scale.bound().to_bits();
    let lights = lights(&packed);
    header.light_count = word(lights.len());
    let light_tree = if effects.has(Effect::LightTree) {
        pack_light_tree(&LightTree::of(scene, viewpoint), &mut packed, &units)
    } else {
        Vec::new()
    };
    let turns = most_turns(&hierarchy, wide.nodes.len(), &small);
    Packed {
        scene: header,
        spheres: packed,
        lights,
        nodes: wide.nodes,
        stack: wide.stack,
        turns,
        light_tree,
        forms: forms.to_vec(),
    }
}

/// Room in a box around a sphere, in radii: hits that rounding finds beside the sphere are no
/// farther from it, for rays that start within two radii; for others the kernel gives boxes
/// room by the size of the coordinates (DESIGN.md, "Many spheres").
const ROOM: f64 = 1.0 / 4096.0;

fn bounds(sphere: &layout::Sphere) -> Bounds {
    let center = DVec3::from(sphere.position.map(f64::from));
    Bounds::of_sphere(center, (1.0 + ROOM) * f64::from(sphere.size))
}

/// Places of the emitters among the packed spheres, in the order of the scene file: which one
/// a random number picks does not depend on how the spheres are packed.
fn lights(spheres: &[layout::Sphere]) -> Vec<u32> {
    let emits = |&(_, sphere): &(u32, &layout::Sphere)| sphere.kind == layout::KIND_EMITTER;
    let mut lights: Vec<(u32, &layout::Sphere)> = (0..).zip(spheres).filter(emits).collect();
    lights.sort_unstable_by_key(|(_, sphere)| sphere.index);
    lights.into_iter().map(|(place, _)| place).collect()
}

/// The tree in kernel units. Leaves learn the places of their lights, and lights the numbers
/// of their leaves.
fn pack_light_tree(
    tree: &LightTree,
    spheres: &mut [layout::Sphere],
    units: &KernelUnits,
) -> Vec<layout::LightNode> {
    let mut nodes: Vec<layout::LightNode> =
        tree.nodes().iter().map(|node| pack_light_node(node, units)).collect();
    for (place, sphere) in (0..).zip(spheres) {
        let leaf = tree.leaves()[sphere.index as usize];
        if leaf > 0 {
            nodes[leaf].light = place;
            #[expect(clippy::cast_precision_loss, reason = "exact where the device takes as many")]
            let number = leaf as f32;
            sphere.exponent = number;
        }
    }
    nodes
}

fn pack_light_node(node: &Node, units: &KernelUnits) -> layout::LightNode {
    layout::LightNode {
        center: floats(units.point(node.center)),
        radius: float(units.length(node.radius)),
        brightness: float(node.brightness),
        everywhere: float(node.everywhere),
        light: 0,
        padding: 0,
    }
}

fn pack_camera(
    packed: &mut layout::Scene,
    scene: &Scene,
    viewpoint: &Viewpoint,
    units: &KernelUnits,
) {
    let (camera, size) = (scene.camera(), scene.size());
    let half_height = (camera.vertical_fov() / 2.0).tan();
    let half_width = half_height * f64::from(size.width()) / f64::from(size.height());
    packed.origin = floats(units.point(viewpoint.ray_start(camera)));
    packed.approach = float(units.length(viewpoint.approach()));
    packed.forward = floats(camera.forward());
    packed.right = floats(half_width * camera.right());
    packed.up = floats(half_height * camera.up());
}

fn pack_sphere(
    sphere: &Sphere,
    index: usize,
    form: Form,
    inside: bool,
    units: &KernelUnits,
) -> layout::Sphere {
    let (color, exponent, kind) = match sphere.surface() {
        Surface::Emitter(radiance) => (radiance.rgb(), 0.0, layout::KIND_EMITTER),
        Surface::Diffuse(albedo) => (albedo.rgb(), 0.0, layout::KIND_DIFFUSE),
        Surface::Glossy(albedo, n) => (albedo.rgb(), n.get(), layout::KIND_GLOSSY),
    };
    let (center, radius) = (units.point(sphere.center()), units.length(sphere.radius()));
    let (position, size, offset) = match form {
        Form::Factored => (center, radius, 0.0),
        Form::Anchored => {
            // F(p) = (|p - c|² - R²)/2R at the focus, p = 0: gradient -c/R and value
            // (|c|² - R²)/2R, factored so that it does not cancel for a far centre.
            let distance = center.length();
            let value = (distance - radius) * (distance + radius) / (2.0 * radius);
            (-center / radius, 1.0 / radius, value)
        }
    };
    layout::Sphere {
        position: floats(position),
        size: float(size),
        color: floats(color),
        exponent: float(exponent),
        offset: float(offset),
        index: word(index),
        kind,
        inside: u32::from(inside),
    }
}

#[expect(clippy::cast_possible_truncation, reason = "the device computes in f32")]
pub(super) fn float(x: f64) -> f32 {
    x as f32
}

fn floats(v: DVec3) -> [f32; 3] {
    v.to_array().map(float)
}

pub(super) fn word(count: usize) -> u32 {
    u32::try_from(count).expect("memory for fewer")
}
