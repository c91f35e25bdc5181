// Directions drawn around an axis: a polar angle from one number, then the azimuth.

// (sine, cosine) of the angle from the axis, uniform over the hemisphere, p = 1/2π:
// the cosine is uniform in [0, 1).
fn polar_hemisphere(u: f32) -> vec2<f32> {
    return vec2<f32>(sqrt((1.0 - u) * (1.0 + u)), u);
}

// (sine, cosine) of the angle from the axis, p = cosθ/π: sin²θ is uniform in [0, 1).
// The cosine is never 0, as 1 - u is at least 2^-24.
fn polar_cosine(u: f32) -> vec2<f32> {
    return vec2<f32>(sqrt(u), sqrt(1.0 - u));
}

// (sine, cosine) of the angle α from the axis of a cone, uniform over its solid angle:
// 1 - cosα is uniform in [0, height), height = 1 - cosine of the half angle. It is not
// formed from cosα, which has no digits left in a narrow cone.
fn polar_cone(u: f32, height: f32) -> vec2<f32> {
    let t = u * height;
    return vec2<f32>(sqrt(t * (2.0 - t)), 1.0 - t);
}

// (sine, cosine) of the angle α from the axis of a Phong lobe, p = (n+1)cosⁿα/2π:
// cosα = (1-u)^(1/(n+1)). Computed from t = 1 - cosα, because cosα itself has no
// digits left for large n (at n = 1e7 only 20 distinct floats); sinα = √(t(2-t)).
fn polar_phong(u: f32, exponent: f32) -> vec2<f32> {
    let t = one_minus_exp_minus(minus_log_complement(u) / (exponent + 1.0));
    return vec2<f32>(sqrt(t * (2.0 - t)), 1.0 - t);
}

// The direction at a polar angle from the unit vector `axis`, its azimuth 2πu. The
// frame around the axis is right-handed and orthonormal for every axis, without
// branches (Duff et al., "Building an Orthonormal Basis, Revisited", JCGT 6(1),
// 2017); WGSL's sign(0) is 0, hence the select.
fn around(axis: vec3<f32>, polar: vec2<f32>, u: f32) -> vec3<f32> {
    let s = select(-1.0, 1.0, axis.z >= 0.0);
    let a = -1.0 / (s + axis.z);
    let b = axis.x * axis.y * a;
    let tangent = vec3<f32>(1.0 + s * axis.x * axis.x * a, s * b, -s * axis.x);
    let bitangent = vec3<f32>(b, s + axis.y * axis.y * a, -axis.y);
    let azimuth = sincos_2pi(u);
    return polar.x * (azimuth.y * tangent + azimuth.x * bitangent) + polar.y * axis;
}
