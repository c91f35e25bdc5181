// Some light may hold the camera, and with it every point that a path can reach: all
// directions then meet that light, and those above the surface count.

fn seen_cone(outer: Cone, light: u32, normal: vec3<f32>) -> Cone {
    if spheres[light].inside == 1u {
        return Cone(normal, 1.0);
    }
    return outer;
}

fn seen_distance(q: Quadratic, light: u32) -> f32 {
    return select(light_distance(q), exit(q, false), spheres[light].inside == 1u);
}
