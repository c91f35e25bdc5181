// One path in a scene where nothing scatters: what the camera sees of the lights.

struct Path {
    ray: Ray,
    throughput: vec3<f32>,
    // The sphere that the ray starts on: none.
    leaving: u32,
    radiance: vec3<f32>,
    // Whether the path came to an end of its own.
    finished: bool,
}

fn start(ray: Ray) -> Path {
    return Path(ray, vec3<f32>(1.0), NO_SPHERE, vec3<f32>(0.0), false);
}

// Follows the only segment.
fn advance(path: ptr<function, Path>, key: SampleKey, bounce: u32) -> bool {
    let hit = nearest((*path).ray, NO_SPHERE);
    (*path).finished = hit.sphere != UNFINISHED;
    if hit.sphere < UNFINISHED && spheres[hit.sphere].kind == KIND_EMITTER {
        (*path).radiance = spheres[hit.sphere].color;
    }
    return false;
}
