//! Rust mirrors of the WGSL structs of `shaders/scene.wgsl` and `shaders/ledger.wgsl`,
//! field for field; `tests/layout.rs` compares them with naga's offsets and through an
//! echo on the device. Padding that WGSL leaves implicit is spelled out here.

use crate::tracer::LEDGER_RECORDS;
use bytemuck::{Pod, Zeroable};

/// Spheres that the uniform buffer holds.
pub const SPHERE_CAPACITY: usize = 512;
/// In place of a sphere, in the kernel and in the probe's tables: none.
pub const NO_SPHERE: u32 = u32::MAX;
/// Words of one record of the ledger.
pub const RECORD_WORDS: usize = 8;

/// [`Sphere::kind`] of an emitter.
pub const KIND_EMITTER: u32 = 0;
/// [`Sphere::kind`] of a diffuse surface.
pub const KIND_DIFFUSE: u32 = 1;
/// [`Sphere::kind`] of a glossy surface.
pub const KIND_GLOSSY: u32 = 2;

/// One sphere, in kernel units.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Sphere {
    /// Factored form: centre. Anchored form: gradient of the sphere's function at the focus.
    pub position: [f32; 3],
    /// Factored form: radius. Anchored form: curvature 1/R.
    pub size: f32,
    /// Albedo, or radiance of an emitter.
    pub color: [f32; 3],
    /// Phong exponent of a glossy surface; of an emitter in the light tree, the number of its
    /// leaf, which is exact up to 2²⁴.
    pub exponent: f32,
    /// Anchored form: value of the sphere's function at the focus.
    pub offset: f32,
    /// Place in the scene file.
    pub index: u32,
    /// One of the `KIND_` constants.
    pub kind: u32,
    /// 1 where the camera is inside the sphere.
    pub inside: u32,
}

/// The scene but for its spheres.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Scene {
    /// Where the camera's axis starts, in kernel units: at the camera, or `approach` before it.
    pub origin: [f32; 3],
    /// Seed of the random numbers.
    pub seed: u32,
    /// Unit view direction.
    pub forward: [f32; 3],
    /// Spheres in factored form; they come before those in anchored form.
    pub factored_count: u32,
    /// Half the picture's width on the plane at distance 1.
    pub right: [f32; 3],
    /// Film scale: a sample x becomes trunc(x·2^`film_shift`).
    pub film_shift: i32,
    /// Half the picture's height on the plane at distance 1.
    pub up: [f32; 3],
    /// Bit pattern of the bound on one sample.
    pub bound_bits: u32,
    /// All spheres.
    pub sphere_count: u32,
    /// Emitters among them.
    pub light_count: u32,
    /// How far before the camera rays start, in kernel units; 0 unless the camera is far away.
    pub approach: f32,
    /// Spheres under the hierarchy; they come first of all.
    pub hierarchy_count: u32,
}

/// A node of the hierarchy: up to four children and their boxes, on a grid of 255 cubes a
/// side from `origin` on.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Node {
    /// Where the grid starts, in kernel units.
    pub origin: [f32; 3],
    /// From the low end: four bits for each child, 0 for none, 15 for a node, otherwise how
    /// many spheres there are; then the biased exponent of the grid's step, 8 bits, as that
    /// of an `f32`.
    pub kinds: u32,
    /// Low corners, a word for each axis, a byte for each child.
    pub low: [u32; 3],
    /// Place of the first child that is a node; the others follow.
    pub first_node: u32,
    /// High corners.
    pub high: [u32; 3],
    /// Place of the first sphere of the first child that is none; the others follow.
    pub first_sphere: u32,
}

/// A node of the light tree.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct LightNode {
    /// Centre of a sphere around the lights, in kernel units.
    pub center: [f32; 3],
    /// Its radius.
    pub radius: f32,
    /// Radiance that makes the sphere as bright, from far away, as its lights together.
    pub brightness: f32,
    /// What lights contribute that look much the same from everywhere in the scene.
    pub everywhere: f32,
    /// Of a leaf: place of the light.
    pub light: u32,
    /// Implicit in WGSL.
    pub padding: u32,
}

/// The work of one dispatch.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Dispatch {
    /// Low word of the first sample's index.
    pub first_sample_low: u32,
    /// High word of the first sample's index.
    pub first_sample_high: u32,
    /// Samples of every pixel.
    pub sample_count: u32,
    /// First row of the band that the film buffer holds.
    pub band_start: u32,
    /// First row to trace.
    pub row_start: u32,
    /// The row after the last to trace.
    pub row_end: u32,
}

/// Invalid samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Ledger {
    /// How many.
    pub count: u32,
    /// The first ones: pixel, low and high word of the sample index, 1 if it was finished, the
    /// bit patterns of its radiance, and 0.
    pub records: [u32; RECORD_WORDS * LEDGER_RECORDS],
}

/// What the entry point `replay` is asked for.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct Request {
    /// Pixel number, row by row from the top.
    pub pixel: u32,
    /// Low word of the sample index.
    pub index_low: u32,
    /// High word of the sample index.
    pub index_high: u32,
}

/// In place of a sphere: a driver cut the search short.
pub const UNFINISHED: u32 = u32::MAX - 1;

/// One segment of a path, in kernel units, and the sample's radiance.
#[derive(Debug, Clone, Copy, PartialEq, Pod, Zeroable)]
#[repr(C)]
pub struct Replay {
    /// Where the ray starts.
    pub origin: [f32; 3],
    /// 1 where the path came this far.
    pub reached: u32,
    /// Unit vector along the ray.
    pub direction: [f32; 3],
    /// Place of the sphere that was hit, [`NO_SPHERE`] or [`UNFINISHED`].
    pub sphere: u32,
    /// Where it was hit.
    pub position: [f32; 3],
    /// Length of the segment.
    pub distance: f32,
    /// Unit normal on the side that the ray came from.
    pub normal: [f32; 3],
    /// Place of the light that was sampled, or [`NO_SPHERE`].
    pub light: u32,
    /// Product of the weights, that of the scattering at the segment's end included.
    pub throughput: [f32; 3],
    /// 1 where nothing stands before the light.
    pub visible: u32,
    /// Radiance that the path brought so far.
    pub radiance: [f32; 3],
    /// 1 where the path does not end here.
    pub goes_on: u32,
    /// Radiance of the whole sample.
    pub sample: [f32; 3],
    /// 1 if no loop was cut short.
    pub finished: u32,
}
