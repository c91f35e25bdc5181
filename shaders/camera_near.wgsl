// Rays start at the camera.

fn camera_point(offset: vec3<f32>) -> vec3<f32> {
    return scene.origin;
}
