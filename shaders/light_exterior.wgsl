// Lights are seen from outside.

fn seen_cone(outer: Cone, light: u32, normal: vec3<f32>) -> Cone {
    return outer;
}

fn seen_distance(q: Quadratic, light: u32) -> f32 {
    return light_distance(q);
}
