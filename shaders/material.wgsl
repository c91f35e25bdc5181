// Scattering: a direction drawn from a surface's density, and what it is worth.

struct Scattering {
    direction: vec3<f32>,
    // f_r·cosθ/p without the albedo. A weight of zero ends the path; the sample still
    // counts.
    weight: f32,
    // 2π·p: the density over that of the uniform hemisphere, so that no factor of π
    // enters the ratio of two densities.
    density: f32,
}
