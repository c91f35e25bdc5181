// What every path needs: where it starts, what it hits, what it brings back.

struct SurfacePoint {
    position: vec3<f32>,
    // Unit normal on the side that the ray came from.
    normal: vec3<f32>,
}

// On a sphere in factored form the point is put back onto the surface along the
// normal, which takes off most of the rounding of the distance.
fn surface_point(ray: Ray, hit: Hit) -> SurfacePoint {
    let place = scene.spheres[hit.sphere].position;
    let size = scene.spheres[hit.sphere].size;
    let reached = ray.origin + hit.distance * ray.direction;
    let is_factored = hit.sphere < scene.factored_count;
    let outward = normalize(select(place + size * reached, reached - place, is_factored));
    let position = select(reached, place + size * outward, is_factored);
    return SurfacePoint(position, facing_normal(outward, hit.sphere));
}

// The ray through a point of the pixel drawn uniformly (box filter). That of a camera many
// extents away starts on a plane before all that it sees: from the camera, f32 directions
// are 6e-8 apart, which is a coarse grid on a far scene.
fn camera_ray(pixel: vec2<u32>, u: vec2<f32>) -> Ray {
    let x = 2.0 * (f32(pixel.x) + u.x) / f32(WIDTH) - 1.0;
    let y = 1.0 - 2.0 * (f32(pixel.y) + u.y) / f32(HEIGHT);
    let offset = x * scene.right + y * scene.up;
    return Ray(scene.origin + scene.approach * offset, normalize(scene.forward + offset));
}

// Whether a direction is one: NaN would turn into a hit or a miss and be lost, so it is
// told by its bits. Squared length from ½ to 2.
fn is_direction(direction: vec3<f32>) -> bool {
    return bitcast<u32>(dot(direction, direction)) - 0x3f000000u <= 0x01000000u;
}

// What a sample brings whose path lost its direction: invalid, by NaN, by size or by sign.
fn no_direction(direction: vec3<f32>) -> vec3<f32> {
    return select(3.0e38 * direction, vec3<f32>(-1.0), all(direction == vec3<f32>(0.0)));
}

struct Sample {
    radiance: vec3<f32>,
    // False where a driver cut a loop short.
    finished: bool,
}
