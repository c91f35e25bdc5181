// Light and BRDF sampling at every surface, combined with the power heuristic, exponent 2
// (Veach & Guibas, "Optimally Combining Sampling Techniques for Monte Carlo Rendering",
// SIGGRAPH 1995, section 3.2). Both shares are written in the ratio x = p/q of the
// densities, the BRDF's over the light's, so that neither can overflow: x is below 1e13.

// f_r·cosθ/q · q²/(p² + q²) over the albedo is weight·x/(1 + x²), never above ½.
fn share_of_sampled(x: f32) -> f32 {
    return x / (1.0 + x * x);
}

fn samples_light_at(sphere: u32) -> bool {
    return true;
}

fn is_done(departure: Departure, bounce: u32) -> bool {
    return false;
}

fn share_of_hit(light: u32, departure: Departure) -> f32 {
    let point = departure.point;
    let x = departure.density * cone_of(light, point).height / chance_of(light, point);
    return select(x * share_of_sampled(x), 1.0, departure.alone);
}
