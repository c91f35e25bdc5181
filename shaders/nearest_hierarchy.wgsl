// The nearest of the spheres under the hierarchy.

// Some spheres and the nearest hit so far. The spheres of a leaf keep the order of the scene
// file; between leaves it is asked for at equal distances.
fn nearest_of(item: u32, best: Hit, ray: Ray, leaving: u32) -> Hit {
    var here = Hit(MISS, NO_SPHERE);
    let end = (item >> 4u) + (item & 15u);
    var i = item >> 4u;
    for (; i < end; i++) {
        let q = factored(ray, spheres[i].position, spheres[i].size);
        let t = select(entry(q), MISS, i == leaving);
        let is_closer = t < here.distance;
        here = Hit(select(here.distance, t, is_closer), select(here.sphere, i, is_closer));
    }
    if i != end {
        return Hit(MISS, UNFINISHED);
    }
    if here.distance < best.distance || (here.distance == best.distance && here.distance < MISS
        && spheres[here.sphere].index < spheres[best.sphere].index) {
        return here;
    }
    return best;
}

fn nearest_hierarchy(ray: Ray, leaving: u32) -> Hit {
    let climber = climber(ray);
    var best = Hit(MISS, NO_SPHERE);
    var way = Way(ROOT, Siblings(0u, 0u, 0u, 0u), 0u);
    while !is_at_end(way) && best.sphere != UNFINISHED {
        if holds_spheres(way) {
            best = nearest_of(way.item, best, ray, leaving);
            way.item = NOTHING;
        }
        go_on(&way);
        if holds_node(way) {
            descend(&way, climber, best.distance);
        }
    }
    if !is_at_end(way) {
        return Hit(MISS, UNFINISHED);
    }
    return best;
}
