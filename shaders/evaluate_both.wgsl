// Lights are sampled at diffuse and at glossy surfaces.
fn evaluate(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, direction: vec3<f32>) -> Worth {
    let diffuse = evaluate_diffuse(normal, direction);
    let glossy = evaluate_glossy(normal, incoming, direction, spheres[sphere].exponent);
    let is_glossy = spheres[sphere].kind == KIND_GLOSSY;
    return Worth(
        select(diffuse.weight, glossy.weight, is_glossy),
        select(diffuse.density, glossy.density, is_glossy),
    );
}
