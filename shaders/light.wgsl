// What a point sees of a spherical light: a cone, sampled uniformly by solid angle
// (Shirley, Wang & Zimmerman, "Monte Carlo Techniques for Direct Lighting
// Calculations", ACM TOG 15(1), 1996, section 3.2), in a form that keeps its digits for
// small far lights and for points close to the surface.

struct Cone {
    // Unit vector to the light's centre.
    axis: vec3<f32>,
    // 1 - cosσ, σ the half angle; the solid angle is 2π·height. At most 1: a point that
    // rounding put into the light is on it, and sees a half-space.
    height: f32,
}

// 1 - cosσ = sin²σ/(1 + cosσ), which does not cancel.
fn cone_from(axis: vec3<f32>, sine2: f32, cosine2: f32) -> Cone {
    return Cone(axis, min(sine2, 1.0) / (1.0 + sqrt(max(cosine2, 0.0))));
}

// cos²σ = (d - r)(d + r)/d².
fn cone_factored(position: vec3<f32>, centre: vec3<f32>, radius: f32) -> Cone {
    let to_centre = centre - position;
    let d = length(to_centre);
    let sine = radius / d;
    return cone_from(to_centre / d, sine * sine, (d - radius) * (d + radius) / (d * d));
}

// With the gradient g = κp + m, |g| is d/R and |g|² - 1 is 2κF.
fn cone_anchored(position: vec3<f32>, gradient: vec3<f32>, offset: f32, curvature: f32) -> Cone {
    let g = gradient + curvature * position;
    let g2 = dot(g, g);
    let twice_f = dot(gradient + g, position) + 2.0 * offset;
    return cone_from(g * -inverseSqrt(g2), 1.0 / g2, curvature * twice_f / g2);
}

// Distance to a light along a direction that was drawn inside its cone: the ray is
// known to meet it, and what rounding makes of the rim counts as met. That is what
// keeps a light of a few roundings' width from losing its rim.
fn light_distance(q: Quadratic) -> f32 {
    let root = sqrt(max(q.discriminant, 0.0));
    return max(q.c, 0.0) / max(root + abs(q.b), 1.0e-30);
}
