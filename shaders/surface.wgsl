// What a path needs where it scatters.

struct SurfacePoint {
    position: vec3<f32>,
    // Unit normal on the side that the ray came from.
    normal: vec3<f32>,
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
