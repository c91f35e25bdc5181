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

// (sine, cosine) of the angle α from the axis of a cone, uniform over its solid angle:
// 1 - cosα is uniform in [0, height), height = 1 - cosine of the half angle. It is not
// formed from cosα, which has no digits left in a narrow cone.
fn polar_cone(u: f32, height: f32) -> vec2<f32> {
    let t = u * height;
    return vec2<f32>(sqrt(t * (2.0 - t)), 1.0 - t);
}

// Distance to a light along a direction that was drawn inside its cone: the ray is
// known to meet it, and what rounding makes of the rim counts as met. That is what
// keeps a light of a few roundings' width from losing its rim.
fn light_distance(q: Quadratic) -> f32 {
    let root = sqrt(max(q.discriminant, 0.0));
    return max(q.c, 0.0) / max(root + abs(q.b), 1.0e-30);
}
