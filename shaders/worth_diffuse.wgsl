// What a direction is worth at a diffuse surface.

// Lambertian surface under cosine-weighted directions: weight 1.
fn evaluate_diffuse(normal: vec3<f32>, direction: vec3<f32>) -> Worth {
    return Worth(1.0, 2.0 * max(dot(normal, direction), 0.0));
}
