// Every light is a huge sphere, in anchored form.

fn outer_cone(light: u32, position: vec3<f32>) -> Cone {
    let s = shape_of(light);
    return cone_anchored(position, s.position, s.offset, s.size);
}

fn light_quadratic(light: u32, ray: Ray) -> Quadratic {
    let s = shape_of(light);
    return anchored(ray, s.position, s.offset, s.size);
}
