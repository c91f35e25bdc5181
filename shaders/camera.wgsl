// Where every path starts, and what it brings back.

// The ray through a point of the pixel drawn uniformly (box filter). That of a camera many
// extents away starts on a plane before all that it sees: from the camera, f32 directions
// are 6e-8 apart, which is a coarse grid on a far scene.
fn camera_ray(pixel: vec2<u32>, u: vec2<f32>) -> Ray {
    let x = 2.0 * (f32(pixel.x) + u.x) / f32(WIDTH) - 1.0;
    let y = 1.0 - 2.0 * (f32(pixel.y) + u.y) / f32(HEIGHT);
    let offset = x * scene.right + y * scene.up;
    return Ray(scene.origin + scene.approach * offset, normalize(scene.forward + offset));
}

struct Sample {
    radiance: vec3<f32>,
    // False where a driver cut a loop short.
    finished: bool,
}
