// The nearest of the spheres in factored form that no hierarchy holds. They keep the order of
// the scene file, so a strict comparison leaves the lowest index.
fn nearest_factored(ray: Ray, leaving: u32) -> Hit {
    var best = Hit(MISS, NO_SPHERE);
    var i = scene.hierarchy_count;
    for (; i < scene.factored_count; i++) {
        best = closer_factored(best, ray, shape_of(i), i, leaving);
    }
    if i != scene.factored_count {
        return Hit(MISS, UNFINISHED);
    }
    return best;
}
