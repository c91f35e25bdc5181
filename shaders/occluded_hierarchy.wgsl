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
    var item = ROOT;
    var height = 0u;
    while item != NOTHING && !blocked {
        if (item & 15u) == A_NODE {
            let c = children(item >> 4u, climber, distance);
            height = push(push(push(height, c.entry.w, c.item.w), c.entry.z, c.item.z), c.entry.y, c.item.y);
            item = select(NOTHING, c.item.x, c.entry.x < MISS);
        } else {
            blocked = occluded_by(item, ray, leaving, light, distance);
            item = NOTHING;
        }
        if item == NOTHING && height > 0u {
            height--;
            item = waiting[height];
        }
    }
    unfinished = unfinished || (item != NOTHING && !blocked);
    return blocked;
}
