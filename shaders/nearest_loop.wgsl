// Any number of spheres: a loop for each form.

fn load_shapes() {}

// `leaving` is the sphere that the ray starts on. Within each form the spheres keep
// the order of the scene file, so a strict comparison leaves the lowest index;
// between the forms it is asked for.
fn nearest(ray: Ray, leaving: u32) -> Hit {
    var small = Hit(MISS, NO_SPHERE);
    var large = Hit(MISS, NO_SPHERE);
    var i = 0u;
    for (; i < scene.factored_count; i++) {
        small = closer_factored(small, ray, shape_of(i), i, leaving);
    }
    for (; i < scene.sphere_count; i++) {
        large = closer_anchored(large, ray, shape_of(i), i, leaving);
    }
    if i != scene.sphere_count {
        return Hit(MISS, UNFINISHED);
    }
    let tie = small.distance == large.distance && large.distance < MISS;
    if large.distance < small.distance
        || (tie && scene.spheres[large.sphere].index < scene.spheres[small.sphere].index) {
        return large;
    }
    return small;
}
