// Diffuse surfaces, cosine-weighted hemisphere: p = cosθ/π, weight 1.

fn polar_diffuse(u: f32) -> vec2<f32> {
    return polar_cosine(u);
}

fn weight_diffuse(polar: vec2<f32>) -> f32 {
    return 1.0;
}

fn density_diffuse(polar: vec2<f32>) -> f32 {
    return 2.0 * polar.y;
}
