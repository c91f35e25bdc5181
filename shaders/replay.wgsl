// Traces one sample again, once for each segment of its path, and records that segment: one
// each, so that no loop comes nearer to the number of iterations after which a driver cuts it
// short.

// A sampled light, or NO_SPHERE.
struct Connection {
    light: u32,
    visible: bool,
}

struct Request {
    pixel: u32,
    // Sample index, 64 bits.
    index_low: u32,
    index_high: u32,
}

// One segment, in kernel units, and the sample's radiance.
struct Replay {
    origin: vec3<f32>,
    // 1 where the path came this far.
    reached: u32,
    direction: vec3<f32>,
    // Place of the sphere that was hit, NO_SPHERE or UNFINISHED.
    sphere: u32,
    position: vec3<f32>,
    distance: f32,
    normal: vec3<f32>,
    // Place of the light that was sampled, or NO_SPHERE.
    light: u32,
    // After the scattering at the segment's end.
    throughput: vec3<f32>,
    // 1 where nothing stands before the light.
    visible: u32,
    radiance: vec3<f32>,
    // 1 where the path does not end here.
    goes_on: u32,
    // Of the whole sample.
    sample: vec3<f32>,
    finished: u32,
}

@group(0) @binding(1) var<uniform> request: Request;
@group(0) @binding(2) var<storage, read_write> replayed: array<Replay>;

// The segment that this invocation records; that from the camera is 0.
var<private> watched: u32;

// What lies before a path.
fn look_ahead(path: Path, key: SampleKey, bounce: u32) {
    let hit = nearest(path.ray, path.leaving);
    replayed[watched].reached = 1u;
    replayed[watched].origin = path.ray.origin;
    replayed[watched].direction = path.ray.direction;
    replayed[watched].sphere = hit.sphere;
    replayed[watched].light = NO_SPHERE;
    if hit.sphere >= UNFINISHED {
        return;
    }
    let point = surface_point(path.ray, hit);
    let connection = connection_of(point, hit.sphere, key, bounce);
    replayed[watched].position = point.position;
    replayed[watched].distance = hit.distance;
    replayed[watched].normal = point.normal;
    replayed[watched].light = connection.light;
    replayed[watched].visible = u32(connection.visible);
}

// Advances a path as `render` does, and watches it on the segment that was asked for.
fn observe(path: ptr<function, Path>, key: SampleKey, bounce: u32) -> bool {
    if bounce == watched {
        look_ahead(*path, key, bounce);
    }
    let goes_on = advance(path, key, bounce);
    if bounce == watched {
        replayed[watched].throughput = (*path).throughput;
        replayed[watched].radiance = (*path).radiance;
        replayed[watched].goes_on = u32(goes_on);
    }
    return goes_on;
}

@compute @workgroup_size(1)
fn replay(@builtin(workgroup_id) group: vec3<u32>) {
    watched = group.x;
    let key = SampleKey(request.pixel, request.index_low, request.index_high);
    let sample = trace(vec2<u32>(request.pixel % WIDTH, request.pixel / WIDTH), key);
    replayed[watched].sample = sample.radiance;
    replayed[watched].finished = u32(sample.finished);
}
