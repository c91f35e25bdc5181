// Some light is a huge sphere, in anchored form.

fn outer_cone(light: u32, position: vec3<f32>) -> Cone {
    let s = shape_of(light);
    if light < scene.factored_count {
        return cone_factored(position, s.position, s.size);
    }
    return cone_anchored(position, s.position, s.offset, s.size);
}

fn light_quadratic(light: u32, ray: Ray) -> Quadratic {
    let s = shape_of(light);
    if light < scene.factored_count {
        return factored(ray, s.position, s.size);
    }
    return anchored(ray, s.position, s.offset, s.size);
}
