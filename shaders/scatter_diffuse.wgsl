// Every surface that scatters is diffuse.
fn scatter(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattering {
    let polar = polar_diffuse(u.x);
    return Scattering(around(normal, polar, u.y), weight_diffuse(polar), density_diffuse(polar));
}
