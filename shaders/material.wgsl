// Scattering: a direction and its weight f_r·cosθ/p, without the albedo. A weight
// of zero ends the path; the sample still counts.

struct Scattering {
    direction: vec3<f32>,
    weight: f32,
}

// Lambertian surface, uniform hemisphere: (1/π)·cosθ·2π = 2cosθ.
fn scatter_diffuse(normal: vec3<f32>, u: vec2<f32>) -> Scattering {
    let local = sample_hemisphere(u);
    return Scattering(from_local(normal, local), 2.0 * local.z);
}

// Phong lobe about the mirror direction: f_r/p = 1, so the weight is cosθ, and 0
// for the part of the lobe that lies under the surface.
fn scatter_glossy(normal: vec3<f32>, incoming: vec3<f32>, exponent: f32, u: vec2<f32>) -> Scattering {
    let mirror = normalize(incoming - 2.0 * dot(incoming, normal) * normal);
    let direction = from_local(mirror, sample_phong(u, exponent));
    return Scattering(direction, max(dot(normal, direction), 0.0));
}
