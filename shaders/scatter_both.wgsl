// Diffuse and glossy surfaces.
fn scatter(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattering {
    if scene.spheres[sphere].kind == KIND_GLOSSY {
        return scatter_glossy(normal, incoming, scene.spheres[sphere].exponent, u);
    }
    return scatter_diffuse(normal, u);
}
