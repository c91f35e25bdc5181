// The scattering of a direction that was not drawn from the surface's density: what
// `scatter` would say of it.

struct Worth {
    // f_r·cosθ/p without the albedo.
    weight: f32,
    // 2π·p.
    density: f32,
}

// Lambertian surface under cosine-weighted directions: weight 1.
fn evaluate_diffuse(normal: vec3<f32>, direction: vec3<f32>) -> Worth {
    return Worth(1.0, 2.0 * max(dot(normal, direction), 0.0));
}

// Phong lobe: cosⁿα = exp(n·log(1 - t)) with t = 1 - cosα = |mirror - direction|²/2, as
// cosα from a dot product has no digits left for large n.
fn evaluate_glossy(
    normal: vec3<f32>,
    incoming: vec3<f32>,
    direction: vec3<f32>,
    exponent: f32,
) -> Worth {
    let off = mirror_direction(normal, incoming) - direction;
    let t = 0.5 * dot(off, off);
    let lobe = exp_minus(exponent * minus_log_complement(min(t, LARGEST_BELOW_ONE)));
    let density = (exponent + 1.0) * lobe;
    return Worth(weight_glossy(normal, direction), select(density, 0.0, t >= 1.0));
}

const LARGEST_BELOW_ONE: f32 = 0.99999994;
