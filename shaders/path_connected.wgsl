// One path that samples a light where it scatters (next-event estimation; Kajiya 1986,
// section 4). A connection to a light uses up one scattering.

// Whether a driver cut a loop short, other than that of `nearest`.
var<private> unfinished: bool;

// How a path left its last vertex.
struct Departure {
    point: SurfacePoint,
    // Density of the direction, times 2π.
    density: f32,
    // Whether nothing but this direction could find the light that it hits.
    alone: bool,
}

// The cone in which a light is sampled. From inside a light, where every direction meets
// it, that is the half-space above the surface.
fn cone_of(light: u32, point: SurfacePoint) -> Cone {
    return seen_cone(outer_cone(light, point.position), light, point.normal);
}

// What one sampled light sends over this vertex, per unit of albedo.
fn connect(point: SurfacePoint, sphere: u32, incoming: vec3<f32>, u: vec2<f32>,
           key: SampleKey, bounce: u32) -> vec3<f32> {
    let pick = pick_light(point, key, bounce);
    let cone = cone_of(pick.light, point);
    let direction = around(cone.axis, polar_cone(u.x, cone.height), u.y);
    let worth = evaluate(sphere, point.normal, incoming, direction);
    let share = worth.weight * share_of_sampled(worth.density * cone.height / pick.chance);
    let ray = Ray(point.position, direction);
    let distance = seen_distance(light_quadratic(pick.light, ray), pick.light);
    let blocked = occluded(ray, sphere, pick.light, distance);
    let light = select(share, 0.0, blocked || !samples_light_at(sphere)) * spheres[pick.light].color;
    return select(no_direction(direction), light, is_direction(direction));
}

struct Path {
    ray: Ray,
    throughput: vec3<f32>,
    // The sphere that the ray starts on.
    leaving: u32,
    departure: Departure,
    radiance: vec3<f32>,
    // Whether the path came to an end of its own.
    finished: bool,
}

fn start(ray: Ray) -> Path {
    let eye = Departure(SurfacePoint(ray.origin, ray.direction), 0.0, true);
    return Path(ray, vec3<f32>(1.0), NO_SPHERE, eye, vec3<f32>(0.0), false);
}

// Follows one segment, connects and scatters at its end; whether the path goes on.
fn advance(path: ptr<function, Path>, key: SampleKey, bounce: u32) -> bool {
    let ray = (*path).ray;
    let hit = nearest(ray, (*path).leaving);
    (*path).finished = hit.sphere != UNFINISHED && !unfinished;
    if hit.sphere >= UNFINISHED {
        return false;
    }
    let color = spheres[hit.sphere].color;
    if spheres[hit.sphere].kind == KIND_EMITTER {
        let share = share_of_hit(hit.sphere, (*path).departure);
        (*path).radiance += (*path).throughput * share * color;
        (*path).finished = !unfinished;
        return false;
    }
    if bounce == BOUNCES {
        return false;
    }
    let point = surface_point(ray, hit);
    let bits = random_bits(key, bounce + 1u);
    let light_u = vec2<f32>(unit_float(bits.z), unit_float(bits.w));
    let throughput = (*path).throughput * color;
    (*path).radiance += throughput * connect(point, hit.sphere, ray.direction, light_u, key, bounce);
    let scattering = scatter(hit.sphere, point.normal, ray.direction, unit_floats(bits));
    let departure = Departure(point, scattering.density, !samples_light_at(hit.sphere));
    (*path).finished = !unfinished;
    if !is_direction(scattering.direction) {
        (*path).radiance = no_direction(scattering.direction);
        return false;
    }
    if scattering.weight == 0.0 || is_done(departure, bounce + 1u) {
        return false;
    }
    (*path).finished = false;
    (*path).departure = departure;
    (*path).throughput = throughput * scattering.weight;
    (*path).ray = Ray(point.position, scattering.direction);
    (*path).leaving = hit.sphere;
    return true;
}
