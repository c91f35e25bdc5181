// The scattering of a direction that was not drawn from the surface's density: what
// `scatter` would say of it.

struct Worth {
    // f_r·cosθ/p without the albedo.
    weight: f32,
    // 2π·p.
    density: f32,
}
