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
