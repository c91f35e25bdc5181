// Ray/sphere intersection in two forms; directions have unit length. DESIGN.md
// ("Hits") derives both and their error bounds.
//
// Paths never cross a surface, so whether a sphere is seen from outside or from
// inside is settled by the camera's place, once, on the host. A ray origin that
// rounding put on the wrong side is therefore known to be on the surface: it hits
// at distance 0 where it heads through the surface, and not at all where it heads
// away. That is the whole treatment of touching spheres; no epsilon moves a ray.

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

const MISS: f32 = 3.0e38;

// A ray against one sphere, in either form: half the quadratic's middle
// coefficient (negative where the ray heads inwards), its constant term (negative
// inside) and the discriminant, all divided so that the leading coefficient is
// `leading`: 1 in factored form, the curvature in anchored form.
struct Quadratic {
    b: f32,
    c: f32,
    discriminant: f32,
    leading: f32,
}

// Centre and radius, with the discriminant factored so that it does not cancel for
// small far spheres (Haines, Günther & Akenine-Möller, "Precision Improvements for
// Ray/Sphere Intersection", Ray Tracing Gems, 2019, ch. 7).
fn factored(ray: Ray, centre: vec3<f32>, radius: f32) -> Quadratic {
    let f = ray.origin - centre;
    let b = dot(f, ray.direction);
    let l = f - b * ray.direction;
    return Quadratic(b, dot(f, f) - radius * radius, radius * radius - dot(l, l), 1.0);
}

// The function F(p) = ½κ|p|² + m·p + e, whose zeros are the sphere, whose gradient
// κp + m is its unit normal there, and whose value is the distance for κ = 0, a
// plane. Nothing in it grows with the radius.
fn anchored(ray: Ray, gradient: vec3<f32>, offset: f32, curvature: f32) -> Quadratic {
    let g = gradient + curvature * ray.origin;
    let c = dot(gradient + g, ray.origin) + 2.0 * offset;
    let b = dot(g, ray.direction);
    return Quadratic(b, c, b * b - curvature * c, curvature);
}

// Distance to the near side from outside.
fn entry(q: Quadratic) -> f32 {
    let t = max(q.c / (sqrt(max(q.discriminant, 0.0)) - q.b), 0.0);
    return select(MISS, t, q.b < 0.0 && q.discriminant >= 0.0);
}

// Distance to the far side from inside. A ray that `leaves` this very sphere has
// c = 0, which makes it the chord.
fn exit(q: Quadratic, leaves: bool) -> f32 {
    let root = sqrt(max(q.discriminant, 0.0));
    let chord = 2.0 * abs(q.b) / q.leading;
    let ahead = (root - q.b) / q.leading;
    let behind = max(-q.c / (root + q.b), 0.0);
    return select(select(behind, ahead, q.b <= 0.0), chord, leaves);
}
