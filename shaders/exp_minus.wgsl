// The exponential of a lobe that is evaluated.

// exp(-x) for x in [0, 80]; beyond, less than 2^-115, which counts as 0.
fn exp_minus(x: f32) -> f32 {
    let e = exponential_minus(min(x, 80.0));
    return select(e.power + e.power * e.rest, 0.0, x > 80.0);
}
