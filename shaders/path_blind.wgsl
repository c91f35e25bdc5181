// One path that counts light only where it hits it by itself, as in the source.

// Follows one segment and scatters at its end; whether the path goes on.
fn advance(path: ptr<function, Path>, key: SampleKey, bounce: u32) -> bool {
    let ray = (*path).ray;
    let hit = nearest(ray, (*path).leaving);
    (*path).finished = hit.sphere != UNFINISHED;
    if hit.sphere >= UNFINISHED {
        return false;
    }
    let color = spheres[hit.sphere].color;
    if spheres[hit.sphere].kind == KIND_EMITTER {
        (*path).radiance = (*path).throughput * color;
        return false;
    }
    if bounce == BOUNCES {
        return false;
    }
    let point = surface_point(ray, hit);
    let u = unit_floats(random_bits(key, bounce + 1u));
    let scattering = scatter(hit.sphere, point.normal, ray.direction, u);
    if !is_direction(scattering.direction) {
        (*path).radiance = no_direction(scattering.direction);
        return false;
    }
    if scattering.weight == 0.0 {
        return false;
    }
    (*path).finished = false;
    (*path).throughput *= scattering.weight * color;
    (*path).ray = Ray(point.position, scattering.direction);
    (*path).leaving = hit.sphere;
    return true;
}
