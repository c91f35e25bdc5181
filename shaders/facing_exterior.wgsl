// Normals on the side that is seen: outwards.
fn facing_normal(outward: vec3<f32>, sphere: u32) -> vec3<f32> {
    return outward;
}
