// Directions drawn around an axis: a polar angle from one number, then the azimuth.

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
