// The cone of a light in factored form.

// cos²σ = (d - r)(d + r)/d².
fn cone_factored(position: vec3<f32>, centre: vec3<f32>, radius: f32) -> Cone {
    let to_centre = centre - position;
    let d = length(to_centre);
    let sine = radius / d;
    return cone_from(to_centre / d, sine * sine, (d - radius) * (d + radius) / (d * d));
}
