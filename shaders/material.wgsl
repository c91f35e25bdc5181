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

fn mirror_direction(normal: vec3<f32>, incoming: vec3<f32>) -> vec3<f32> {
    return normalize(incoming - 2.0 * dot(incoming, normal) * normal);
}

// Phong lobe about the mirror direction: f_r/p = 1, so the weight is cosθ, and 0
// for the part of the lobe that lies under the surface.
fn weight_glossy(normal: vec3<f32>, direction: vec3<f32>) -> f32 {
    return max(dot(normal, direction), 0.0);
}

// Density of a direction drawn with the number u: cosⁿ⁺¹α = 1 - u, so
// cosⁿα = (1 - u)/cosα, which is at most 1 (n = 0).
fn density_drawn(polar: vec2<f32>, u: f32, exponent: f32) -> f32 {
    return (exponent + 1.0) * min((1.0 - u) / max(polar.y, 1.0 - u), 1.0);
}
