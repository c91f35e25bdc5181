// Diffuse surfaces, uniform hemisphere: p = 1/2π, weight (1/π)·cosθ·2π = 2cosθ.

fn polar_diffuse(u: f32) -> vec2<f32> {
    return polar_hemisphere(u);
}

fn weight_diffuse(polar: vec2<f32>) -> f32 {
    return 2.0 * polar.y;
}

fn density_diffuse(polar: vec2<f32>) -> f32 {
    return 1.0;
}
