// The Phong lobe about the mirror direction.

// (sine, cosine) of the angle α from the axis of a Phong lobe, p = (n+1)cosⁿα/2π:
// cosα = (1-u)^(1/(n+1)). Computed from t = 1 - cosα, because cosα itself has no
// digits left for large n (at n = 1e7 only 20 distinct floats); sinα = √(t(2-t)).
fn polar_phong(u: f32, exponent: f32) -> vec2<f32> {
    let t = one_minus_exp_minus(minus_log_complement(u) / (exponent + 1.0));
    return vec2<f32>(sqrt(t * (2.0 - t)), 1.0 - t);
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
