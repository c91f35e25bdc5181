// The cone of a light in anchored form.

// With the gradient g = κp + m, |g| is d/R and |g|² - 1 is 2κF.
fn cone_anchored(position: vec3<f32>, gradient: vec3<f32>, offset: f32, curvature: f32) -> Cone {
    let g = gradient + curvature * position;
    let g2 = dot(g, g);
    let twice_f = dot(gradient + g, position) + 2.0 * offset;
    return cone_from(g * -inverseSqrt(g2), 1.0 / g2, curvature * twice_f / g2);
}
