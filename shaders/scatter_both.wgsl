// Diffuse and glossy surfaces: axis and polar angle differ, the rest is shared, since
// a group of invocations pays for both sides of a branch.
fn scatter(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattering {
    let glossy = spheres[sphere].kind == KIND_GLOSSY;
    let exponent = spheres[sphere].exponent;
    let axis = select(normal, mirror_direction(normal, incoming), glossy);
    let polar = select(polar_diffuse(u.x), polar_phong(u.x, exponent), glossy);
    let direction = around(axis, polar, u.y);
    let weight = select(weight_diffuse(polar), weight_glossy(normal, direction), glossy);
    let density = select(density_diffuse(polar), density_drawn(polar, u.x, exponent), glossy);
    return Scattering(direction, weight, density);
}
