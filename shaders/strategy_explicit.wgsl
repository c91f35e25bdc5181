// Next-event estimation: a light is sampled at diffuse surfaces, and what a path hits by
// itself counts straight from the camera or from a glossy surface, where no light was
// sampled.

// f_r·cosθ/q over the albedo is weight·x, with x the ratio p/q of the densities of this
// direction: the BRDF's over the light's.
fn share_of_sampled(x: f32) -> f32 {
    return x;
}

fn samples_light_at(sphere: u32) -> bool {
    return spheres[sphere].kind == KIND_DIFFUSE;
}

// The last segment of a path can only hit a light, which does not count from here.
fn is_done(departure: Departure, bounce: u32) -> bool {
    return bounce == BOUNCES && !departure.alone;
}

fn share_of_hit(light: u32, departure: Departure) -> f32 {
    return select(0.0, 1.0, departure.alone);
}
