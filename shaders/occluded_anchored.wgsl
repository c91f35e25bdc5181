// The same of the spheres in anchored form.
fn occluded_anchored(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let place = spheres[light].index;
    var first = MISS;
    var earlier = MISS;
    var i = scene.factored_count;
    for (; i < scene.sphere_count; i++) {
        let s = shape_of(i);
        let q = anchored(ray, s.position, s.offset, s.size);
        let t = select(distance_to(q, i, leaving), MISS, i == light);
        first = min(first, t);
        earlier = select(earlier, min(earlier, t), spheres[i].index < place);
    }
    unfinished = unfinished || i != scene.sphere_count;
    return first < distance || earlier <= distance;
}
