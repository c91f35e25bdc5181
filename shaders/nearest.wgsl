// The sphere that a ray meets first.

struct Hit {
    distance: f32,
    sphere: u32,
}

// A loop that a driver cut short leaves this in place of a sphere.
const UNFINISHED: u32 = 0xfffffffeu;
