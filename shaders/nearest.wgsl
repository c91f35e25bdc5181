// The sphere that a ray meets first.

struct Hit {
    distance: f32,
    sphere: u32,
}

// A loop that a driver cut short leaves this in place of a sphere.
const UNFINISHED: u32 = 0xfffffffeu;

fn closer_factored(best: Hit, ray: Ray, i: u32, leaving: u32) -> Hit {
    let q = factored(ray, scene.spheres[i].position, scene.spheres[i].size);
    let t = distance_to(q, i, leaving);
    let closer = t < best.distance;
    return Hit(select(best.distance, t, closer), select(best.sphere, i, closer));
}

fn closer_anchored(best: Hit, ray: Ray, i: u32, leaving: u32) -> Hit {
    let q = anchored(ray, scene.spheres[i].position, scene.spheres[i].offset, scene.spheres[i].size);
    let t = distance_to(q, i, leaving);
    let closer = t < best.distance;
    return Hit(select(best.distance, t, closer), select(best.sphere, i, closer));
}

// Within each form the spheres keep the order of the scene file, so a strict
// comparison leaves the lowest index; between the forms it is asked for.
fn first_of(a: Hit, b: Hit) -> Hit {
    let tie = a.distance == b.distance && b.distance < MISS;
    if b.distance < a.distance
        || (tie && scene.spheres[b.sphere].index < scene.spheres[a.sphere].index) {
        return b;
    }
    return a;
}
