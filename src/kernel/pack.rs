//! A validated scene in kernel units, ready for the device.

use super::layout::{self, SPHERE_CAPACITY};
use crate::film::SampleScale;
use crate::scene::{Scene, Sphere, Surface};
use crate::viewpoint::Viewpoint;
use glam::DVec3;

/// The scene has more spheres than the uniform buffer holds.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "the scene has {0} spheres; this version traces at most {SPHERE_CAPACITY} on a device \
     (--device cpu traces any number)"
)]
pub struct TooManySpheres(pub usize);

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

/// A sphere that rays start farther from than this many radii is small, whatever the
/// extent: the anchored discriminant is off by 3u(distance/R)², the factored miss distance
/// by 3u(distance/R) of the radius, and they meet near six radii.
const SMALL_FROM: f64 = 8.0;

/// How a sphere is intersected.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Form {
    /// By centre and radius: spheres up to the scene's extent, and far ones.
    Factored,
    /// By curvature and gradient at the focus: larger ones.
    Anchored,
}

/// A packed scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Packed {
    /// What goes into the uniform buffer.
    pub scene: Box<layout::Scene>,
    /// Form of every sphere, in the order of the scene file.
    pub forms: Vec<Form>,
}

impl Packed {
    /// Places of the lights in the uniform buffer.
    #[must_use]
    pub fn light_places(&self) -> &[u32] {
        &self.scene.lights[..self.scene.light_count as usize]
    }
}

/// Checks that the uniform buffer holds all spheres.
///
/// # Errors
/// If there are more than [`SPHERE_CAPACITY`].
pub fn check_count(scene: &Scene) -> Result<(), TooManySpheres> {
    let count = scene.spheres().len();
    if count > SPHERE_CAPACITY { Err(TooManySpheres(count)) } else { Ok(()) }
}

/// Packs a scene for the device.
///
/// # Errors
/// If it has more than [`SPHERE_CAPACITY`] spheres.
pub fn pack(
    scene: &Scene,
    viewpoint: &Viewpoint,
    scale: SampleScale,
) -> Result<Packed, TooManySpheres> {
    let spheres = scene.spheres();
    check_count(scene)?;
    let units = KernelUnits::of(viewpoint);
    let forms: Vec<Form> = spheres.iter().map(|s| form_of(s, scene, viewpoint)).collect();
    let of_form = |wanted| {
        let matches = std::iter::zip(0.., &forms).filter(move |(_, form)| **form == wanted);
        matches.map(|(index, _): (usize, _)| index)
    };

    let mut packed: Box<layout::Scene> = bytemuck::zeroed_box();
    pack_camera(&mut packed, scene, viewpoint, &units);
    for (place, index) in of_form(Form::Factored).chain(of_form(Form::Anchored)).enumerate() {
        let inside = viewpoint.inside()[index];
        packed.spheres[place] = pack_sphere(&spheres[index], index, forms[index], inside, &units);
    }
    pack_lights(&mut packed, spheres.len());
    packed.factored_count = word(of_form(Form::Factored).count());
    packed.sphere_count = word(spheres.len());
    packed.seed = scene.settings().seed();
    packed.film_shift = scale.shift();
    packed.bound_bits = scale.bound().to_bits();
    Ok(Packed { scene: packed, forms })
}

fn form_of(sphere: &Sphere, scene: &Scene, viewpoint: &Viewpoint) -> Form {
    let distance = viewpoint.ray_start(scene.camera()).distance(sphere.center());
    let small = sphere.radius() <= viewpoint.extent() || distance > SMALL_FROM * sphere.radius();
    if small { Form::Factored } else { Form::Anchored }
}

/// Lists the places of the emitters among the packed spheres.
fn pack_lights(packed: &mut layout::Scene, spheres: usize) {
    let emits = |place: &usize| packed.spheres[*place].kind == layout::KIND_EMITTER;
    let places: Vec<u32> = (0..spheres).filter(emits).map(word).collect();
    packed.lights[..places.len()].copy_from_slice(&places);
    packed.light_count = word(places.len());
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
fn float(x: f64) -> f32 {
    x as f32
}

fn floats(v: DVec3) -> [f32; 3] {
    v.to_array().map(float)
}

fn word(count: usize) -> u32 {
    u32::try_from(count).expect("at most SPHERE_CAPACITY spheres")
}
