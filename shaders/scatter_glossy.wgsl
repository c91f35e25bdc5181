// Every surface that scatters is glossy.
fn scatter(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattering {
    let exponent = spheres[sphere].exponent;
    let polar = polar_phong(u.x, exponent);
    let direction = around(mirror_direction(normal, incoming), polar, u.y);
    return Scattering(direction, weight_glossy(normal, direction), density_drawn(polar, u.x, exponent));
}
