// Diffuse and glossy surfaces: axis and polar angle differ, the rest is shared, since
// a group of invocations pays for both sides of a branch.
fn scatter(sphere: u32, normal: vec3<f32>, incoming: vec3<f32>, u: vec2<f32>) -> Scattering {
    let glossy = scene.spheres[sphere].kind == KIND_GLOSSY;
    let axis = select(normal, mirror_direction(normal, incoming), glossy);
    let lobe = polar_phong(u.x, scene.spheres[sphere].exponent);
    let polar = select(polar_hemisphere(u.x), lobe, glossy);
    let direction = around(axis, polar, u.y);
    let weight = select(weight_diffuse(polar), weight_glossy(normal, direction), glossy);
    return Scattering(direction, weight);
}
