// The nearest of the spheres in anchored form, likewise.
fn nearest_anchored(ray: Ray, leaving: u32) -> Hit {
    var best = Hit(MISS, NO_SPHERE);
    var i = scene.factored_count;
    for (; i < scene.sphere_count; i++) {
        best = closer_anchored(best, ray, shape_of(i), i, leaving);
    }
    if i != scene.sphere_count {
        return Hit(MISS, UNFINISHED);
    }
    return best;
}
