// The cosine-weighted hemisphere.

// (sine, cosine) of the angle from the axis, p = cosθ/π: sin²θ is uniform in [0, 1).
// The cosine is never 0, as 1 - u is at least 2^-24.
fn polar_cosine(u: f32) -> vec2<f32> {
    return vec2<f32>(sqrt(u), sqrt(1.0 - u));
}
