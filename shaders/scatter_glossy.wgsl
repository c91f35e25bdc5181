// Every surface that scatters is glossy.
fn scatter(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattering {
    return scatter_glossy(normal, incoming, scene.spheres[sphere].exponent, u);
}
