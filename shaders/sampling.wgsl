// Directions drawn at a surface point.

// A right-handed orthonormal frame around the unit vector n; free of branches and
// of square roots, stable for every n (Duff et al., "Building an Orthonormal Basis,
// Revisited", JCGT 6(1), 2017). WGSL's sign(0) is 0, hence the select.
fn from_local(n: vec3<f32>, local: vec3<f32>) -> vec3<f32> {
    let s = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (s + n.z);
    let b = n.x * n.y * a;
    let tangent = vec3<f32>(1.0 + s * n.x * n.x * a, s * b, -s * n.x);
    let bitangent = vec3<f32>(b, s + n.y * n.y * a, -n.y);
    return local.x * tangent + local.y * bitangent + local.z * n;
}

// Uniform over the hemisphere, p = 1/2π: cosθ is uniform in [0, 1).
fn sample_hemisphere(u: vec2<f32>) -> vec3<f32> {
    let cosine = u.x;
    let sine = sqrt((1.0 - cosine) * (1.0 + cosine));
    let azimuth = sincos_2pi(u.y);
    return vec3<f32>(sine * azimuth.y, sine * azimuth.x, cosine);
}

// Phong lobe about +z, p = (n+1)cosⁿα/2π: cosα = (1-u)^(1/(n+1)). Computed from
// t = 1 - cosα, because cosα itself has no digits left for large n (at n = 1e7 only
// 20 distinct floats); sinα = √(t(2-t)).
fn sample_phong(u: vec2<f32>, exponent: f32) -> vec3<f32> {
    let t = one_minus_exp_minus(minus_log_complement(u.x) / (exponent + 1.0));
    let sine = sqrt(t * (2.0 - t));
    let azimuth = sincos_2pi(u.y);
    return vec3<f32>(sine * azimuth.y, sine * azimuth.x, 1.0 - t);
}
