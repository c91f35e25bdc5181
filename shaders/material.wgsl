// Scattering: a direction and its weight f_r·cosθ/p, without the albedo. A weight
// of zero ends the path; the sample still counts.

struct Scattering {
    direction: vec3<f32>,
    weight: f32,
}

fn mirror_direction(normal: vec3<f32>, incoming: vec3<f32>) -> vec3<f32> {
    return normalize(incoming - 2.0 * dot(incoming, normal) * normal);
}

// Lambertian surface, uniform hemisphere: (1/π)·cosθ·2π = 2cosθ.
fn weight_diffuse(polar: vec2<f32>) -> f32 {
    return 2.0 * polar.y;
}

// Phong lobe about the mirror direction: f_r/p = 1, so the weight is cosθ, and 0
// for the part of the lobe that lies under the surface.
fn weight_glossy(normal: vec3<f32>, direction: vec3<f32>) -> f32 {
    return max(dot(normal, direction), 0.0);
}
