// Spheres that are looked at one by one.

// What a ray needs to know of a sphere to meet it.
struct Shape {
    position: vec3<f32>,
    size: f32,
    offset: f32,
}

fn shape_of(i: u32) -> Shape {
    return Shape(spheres[i].position, spheres[i].size, spheres[i].offset);
}

fn closer(best: Hit, q: Quadratic, i: u32, leaving: u32) -> Hit {
    let t = distance_to(q, i, leaving);
    let is_closer = t < best.distance;
    return Hit(select(best.distance, t, is_closer), select(best.sphere, i, is_closer));
}
