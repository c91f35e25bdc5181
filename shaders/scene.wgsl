// The packed scene and the work of one dispatch, as the host lays them out
// (src/kernel/layout.rs mirrors every struct; a test compares both with naga).
// Lengths are in kernel units: the scene re-centred on its focus and scaled by a
// power of two. Radiance is in the scene's own unit.

const NO_SPHERE: u32 = 0xffffffffu;

const KIND_EMITTER: u32 = 0u;
const KIND_DIFFUSE: u32 = 1u;
const KIND_GLOSSY: u32 = 2u;

struct Sphere {
    // Factored form: centre. Anchored form: gradient of the sphere's function at
    // the focus.
    position: vec3<f32>,
    // Factored form: radius. Anchored form: curvature 1/R.
    size: f32,
    // Albedo, or radiance of an emitter.
    color: vec3<f32>,
    // Phong exponent of a glossy surface; of an emitter in the light tree, the number of its
    // leaf.
    exponent: f32,
    // Anchored form: value of the sphere's function at the focus.
    offset: f32,
    // Place in the scene file; at equal distances the lowest wins.
    index: u32,
    kind: u32,
    // 1 where the camera is inside this sphere: paths then see only its inner side.
    inside: u32,
}

struct Scene {
    // Camera: where its axis starts, view direction, and the half extents of the picture
    // on the plane at distance 1.
    origin: vec3<f32>,
    seed: u32,
    forward: vec3<f32>,
    // Spheres 0..hierarchy_count are under the hierarchy, hierarchy_count..factored_count
    // are the others in factored form, the rest are in anchored form.
    factored_count: u32,
    right: vec3<f32>,
    // A sample x enters the film as the integer trunc(x·2^film_shift).
    film_shift: i32,
    up: vec3<f32>,
    // Bit pattern of the proven bound on one sample.
    bound_bits: u32,
    sphere_count: u32,
    light_count: u32,
    // How far along the view axis rays start, where the camera is far away.
    approach: f32,
    hierarchy_count: u32,
}

struct Dispatch {
    // Index of the first sample, 64 bits; then how many samples of every pixel.
    first_sample_low: u32,
    first_sample_high: u32,
    sample_count: u32,
    // Rows of the band that the film buffer holds.
    band_start: u32,
    // First row of this dispatch, and the row after its last.
    row_start: u32,
    row_end: u32,
}

@group(0) @binding(0) var<uniform> scene: Scene;
