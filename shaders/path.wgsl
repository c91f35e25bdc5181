// A path under way that samples no lights.

struct Path {
    ray: Ray,
    throughput: vec3<f32>,
    // The sphere that the ray starts on.
    leaving: u32,
    radiance: vec3<f32>,
    // Whether the path came to an end of its own.
    finished: bool,
}

fn start(ray: Ray) -> Path {
    return Path(ray, vec3<f32>(1.0), NO_SPHERE, vec3<f32>(0.0), false);
}
