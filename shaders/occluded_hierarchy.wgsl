// Whether one of the spheres under the hierarchy, other than `light`, is seen first: one that
// is nearer than `distance`, or as near and earlier in the scene file.

fn hides(i: u32, ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let q = factored(ray, spheres[i].position, spheres[i].size);
    let t = select(entry(q), MISS, i == leaving || i == light);
    return t < distance || (t == distance && spheres[i].index < spheres[light].index);
}

fn occluded_hierarchy(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let climber = climber(ray);
    var blocked = false;
    var way = Way(ROOT, Siblings(0u, 0u, 0u, 0u), 0u);
    while !has_ended(way) && !blocked {
        if holds_spheres(way) {
            let pair = pair_of(way.item);
            blocked = hides(pair.x, ray, leaving, light, distance)
                || hides(pair.y, ray, leaving, light, distance);
            way.item = NOTHING;
        }
        go_on(&way);
        if holds_node(way) {
            descend(&way, climber, distance);
        }
    }
    unfinished = unfinished || (!has_ended(way) && !blocked);
    return blocked;
}
