// What a direction is worth at a glossy surface.

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
