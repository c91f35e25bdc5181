// Whether one of the spheres in factored form that no hierarchy holds, other than `light`, is
// seen first: one that is nearer than `distance`, or as near and earlier in the scene file.
fn occluded_factored(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let place = spheres[light].index;
    var first = MISS;
    var earlier = MISS;
    var i = scene.hierarchy_count;
    for (; i < scene.factored_count; i++) {
        let s = shape_of(i);
        let t = select(distance_to(factored(ray, s.position, s.size), i, leaving), MISS, i == light);
        first = min(first, t);
        earlier = select(earlier, min(earlier, t), spheres[i].index < place);
    }
    unfinished = unfinished || i != scene.factored_count;
    return first < distance || earlier <= distance;
}
