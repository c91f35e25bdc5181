// The uniform hemisphere.

// (sine, cosine) of the angle from the axis, uniform over the hemisphere, p = 1/2π:
// the cosine is uniform in [0, 1).
fn polar_hemisphere(u: f32) -> vec2<f32> {
    return vec2<f32>(sqrt((1.0 - u) * (1.0 + u)), u);
}
