// Whether a sphere other than `light` is seen first, of any number: one that is nearer than
// `distance`, or as near and earlier in the scene file.
fn occluded(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let place = scene.spheres[light].index;
    var first = MISS;
    var earlier = MISS;
    var i = 0u;
    for (; i < scene.sphere_count; i++) {
        let s = shape_of(i);
        var q = factored(ray, s.position, s.size);
        if i >= scene.factored_count {
            q = anchored(ray, s.position, s.offset, s.size);
        }
        let t = select(distance_to(q, i, leaving), MISS, i == light);
        first = min(first, t);
        earlier = select(earlier, min(earlier, t), scene.spheres[i].index < place);
    }
    unfinished = unfinished || i != scene.sphere_count;
    return first < distance || earlier <= distance;
}
