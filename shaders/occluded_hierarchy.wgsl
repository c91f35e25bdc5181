// Whether one of the spheres under the hierarchy, other than `light`, is seen first: one that
// is nearer than `distance`, or as near and earlier in the scene file.

fn occluded_by(item: u32, ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let place = spheres[light].index;
    var blocked = false;
    let end = (item >> 4u) + (item & 15u);
    var i = item >> 4u;
    for (; i < end; i++) {
        let q = factored(ray, spheres[i].position, spheres[i].size);
        let t = select(entry(q), MISS, i == leaving || i == light);
        blocked = blocked || t < distance || (t == distance && spheres[i].index < place);
    }
    unfinished = unfinished || i != end;
    return blocked;
}

fn occluded_hierarchy(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {
    let climber = climber(ray);
    var blocked = false;
    var way = Way(ROOT, Siblings(0u, 0u, 0u, 0u), 0u);
    while !is_at_end(way) && !blocked {
        if holds_spheres(way) {
            blocked = occluded_by(way.item, ray, leaving, light, distance);
            way.item = NOTHING;
        }
        go_on(&way);
        if holds_node(way) {
            descend(&way, climber, distance);
        }
    }
    unfinished = unfinished || (!is_at_end(way) && !blocked);
    return blocked;
}
