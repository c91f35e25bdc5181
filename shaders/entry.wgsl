// Spheres seen from outside.

// Distance to the near side from outside.
fn entry(q: Quadratic) -> f32 {
    let t = max(q.c / (sqrt(max(q.discriminant, 0.0)) - q.b), 0.0);
    return select(MISS, t, q.b < 0.0 && q.discriminant >= 0.0);
}
