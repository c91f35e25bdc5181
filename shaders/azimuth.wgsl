// Sine and cosine of azimuths, with bounds of their own: WGSL grants an absolute error of
// 2^-11. This uses only + - * and integer operations.

// (sin 2πu, cos 2πu) for u in [0, 1). The quadrant is taken off exactly; on the
// rest, |x| <= π/4, minimax polynomials (Cephes sinf.c, Moshier 1989).
fn sincos_2pi(u: f32) -> vec2<f32> {
    let quadrant = floor(4.0 * u + 0.5);
    let x = (4.0 * u - quadrant) * 1.5707963267948966;
    let x2 = x * x;
    let s = x + x * x2 * (-1.6666654611e-1 + x2 * (8.3321608736e-3 + x2 * -1.9515295891e-4));
    let c = 1.0 - 0.5 * x2
        + x2 * x2 * (4.166664568298827e-2 + x2 * (-1.388731625493765e-3 + x2 * 2.443315711809948e-5));
    let q = u32(quadrant);
    let swapped = (q & 1u) != 0u;
    let sine = select(s, c, swapped);
    let cosine = select(c, s, swapped);
    return vec2<f32>(
        select(sine, -sine, (q & 2u) != 0u),
        select(cosine, -cosine, ((q + 1u) & 2u) != 0u),
    );
}
