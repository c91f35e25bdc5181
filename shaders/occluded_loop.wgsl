// Whether a sphere other than `light` stands before `distance`; any number of spheres.
fn occluded(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    var first = MISS;
    var i = 0u;
    for (; i < scene.sphere_count; i++) {
        let s = shape_of(i);
        var q = factored(ray, s.position, s.size);
        if i >= scene.factored_count {
            q = anchored(ray, s.position, s.offset, s.size);
        }
        first = select(min(first, distance_to(q, i, leaving)), first, i == light);
    }
    unfinished = unfinished || i != scene.sphere_count;
    return first < distance;
}
