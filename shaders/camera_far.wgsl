// Rays of a camera that is many extents away start on a plane before all that it sees:
// from the camera, f32 directions are 6e-8 apart, which is a coarse grid on a far scene.
// `scene.origin` is where the view axis meets that plane.

fn camera_point(offset: vec3<f32>) -> vec3<f32> {
    return scene.origin + scene.approach * offset;
}
