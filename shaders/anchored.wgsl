// Spheres in anchored form.

// The function F(p) = ½κ|p|² + m·p + e, whose zeros are the sphere, whose gradient
// κp + m is its unit normal there, and whose value is the distance for κ = 0, a
// plane. Nothing in it grows with the radius.
fn anchored(ray: Ray, gradient: vec3<f32>, offset: f32, curvature: f32) -> Quadratic {
    let g = gradient + curvature * ray.origin;
    let c = dot(gradient + g, ray.origin) + 2.0 * offset;
    let b = dot(g, ray.direction);
    return Quadratic(b, c, b * b - curvature * c, curvature);
}
