// One path in a scene where nothing scatters: what the camera sees of the lights.

// Follows the only segment.
fn advance(path: ptr<function, Path>, key: SampleKey, bounce: u32) -> bool {
    let hit = nearest((*path).ray, NO_SPHERE);
    (*path).finished = hit.sphere != UNFINISHED;
    if hit.sphere < UNFINISHED && spheres[hit.sphere].kind == KIND_EMITTER {
        (*path).radiance = spheres[hit.sphere].color;
    }
    return false;
}
