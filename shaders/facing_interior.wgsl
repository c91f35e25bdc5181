// Normals on the side that is seen: inwards where the sphere holds the camera.
fn facing_normal(outward: vec3<f32>, sphere: u32) -> vec3<f32> {
    return select(outward, -outward, spheres[sphere].inside == 1u);
}
