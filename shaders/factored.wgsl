// Spheres in factored form.

// Centre and radius, with the discriminant factored so that it does not cancel for
// small far spheres (Haines, Günther & Akenine-Möller, "Precision Improvements for
// Ray/Sphere Intersection", Ray Tracing Gems, 2019, ch. 7).
fn factored(ray: Ray, centre: vec3<f32>, radius: f32) -> Quadratic {
    let f = ray.origin - centre;
    let b = dot(f, ray.direction);
    let l = f - b * ray.direction;
    return Quadratic(b, dot(f, f) - radius * radius, radius * radius - dot(l, l), 1.0);
}
