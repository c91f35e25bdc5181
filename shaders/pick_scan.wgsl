// Several lights: all of them are scanned to pick one, half of the time in proportion to a bound on what it
// can contribute at this point, half of the time evenly. No light's chance is then
// below half of an even one, whatever the bound misses.

// height · brightest channel · largest cosine.
fn potential(light: u32, point: SurfacePoint) -> f32 {
    let cone = cone_of(light, point);
    let color = spheres[light].color;
    return cone.height * largest_cosine(cone, point.normal) * max(max(color.x, color.y), color.z);
}

fn total_potential(point: SurfacePoint) -> f32 {
    var total = 0.0;
    var i = 0u;
    for (; i < scene.light_count; i++) {
        total += potential(light_at(i), point);
    }
    unfinished = unfinished || i != scene.light_count;
    return total;
}

fn chance_among(potential: f32, total: f32) -> f32 {
    let even = 1.0 / f32(scene.light_count);
    return select(even, 0.5 * (potential / total + even), total > 0.0);
}

fn scan_for_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    let total = total_potential(point);
    let u = unit_float(random_bits(key, PICK_BLOCKS + bounce).x);
    var pick = Pick(NO_SPHERE, 0.0);
    var sum = 0.0;
    var i = 0u;
    // Ends at the light whose share of [0, 1) holds u; the last one takes what rounding
    // leaves.
    for (; i < scene.light_count; i++) {
        let light = light_at(i);
        pick = Pick(light, chance_among(potential(light, point), total));
        sum += pick.chance;
        if u < sum {
            break;
        }
    }
    unfinished = unfinished || (i < scene.light_count && !(u < sum));
    return pick;
}
