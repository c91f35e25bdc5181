// The nearest of the spheres under the hierarchy.

// The nearer of a leaf's spheres, which keep the order of the scene file, if it is nearer than
// the best so far; between leaves that order is asked for at equal distances.
fn nearest_of(item: u32, best: Hit, ray: Ray, leaving: u32) -> Hit {
    let pair = pair_of(item);
    let a = factored(ray, spheres[pair.x].position, spheres[pair.x].size);
    let b = factored(ray, spheres[pair.y].position, spheres[pair.y].size);
    let t = vec2<f32>(
        select(entry(a), MISS, pair.x == leaving), select(entry(b), MISS, pair.y == leaving));
    let here = Hit(min(t.x, t.y), select(pair.x, pair.y, t.y < t.x));
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
    while !has_ended(way) {
        if holds_spheres(way) {
            best = nearest_of(way.item, best, ray, leaving);
            way.item = NOTHING;
        }
        go_on(&way);
        if holds_node(way) {
            descend(&way, climber, best.distance);
        }
    }
    if !has_ended(way) {
        return Hit(MISS, UNFINISHED);
    }
    return best;
}
