// `leaving` is the sphere that the ray starts on.
fn nearest(ray: Ray, leaving: u32) -> Hit {
    var small = Hit(MISS, NO_SPHERE);
    var large = Hit(MISS, NO_SPHERE);
    var i = 0u;
    for (; i < scene.factored_count; i++) {
        small = closer_factored(small, ray, i, leaving);
    }
    for (; i < scene.sphere_count; i++) {
        large = closer_anchored(large, ray, i, leaving);
    }
    if i != scene.sphere_count {
        return Hit(MISS, UNFINISHED);
    }
    return first_of(small, large);
}
