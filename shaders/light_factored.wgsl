// Every light is in factored form.

fn outer_cone(light: u32, position: vec3<f32>) -> Cone {
    return cone_factored(position, spheres[light].position, spheres[light].size);
}

fn light_quadratic(light: u32, ray: Ray) -> Quadratic {
    return factored(ray, spheres[light].position, spheres[light].size);
}
