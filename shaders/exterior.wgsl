// The side from which spheres are seen: the camera is inside none, so every sphere
// is seen from outside, and a ray that leaves a sphere cannot meet it again.

fn distance_to(q: Quadratic, sphere: u32, leaving: u32) -> f32 {
    return select(entry(q), MISS, sphere == leaving);
}
