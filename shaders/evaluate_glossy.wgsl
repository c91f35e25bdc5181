// Every surface where lights are sampled is glossy.
fn evaluate(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, direction: vec3<f32>) -> Worth {
    return evaluate_glossy(normal, incoming, direction, spheres[sphere].exponent);
}
