// The chance of a light that the path hits by itself, where a tree is walked.

// A light has no exponent; the number of its leaf is there.
fn chance_in_tree(light: u32, point: SurfacePoint) -> f32 {
    let leaf = u32(spheres[light].exponent);
    return with_even_half(walk_to(leaf, point, vec4<u32>(0u)).chance);
}
