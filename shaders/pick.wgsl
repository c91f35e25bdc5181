// One of several lights, picked for a vertex.

struct Pick {
    light: u32,
    // Probability of picking this light.
    chance: f32,
}

// The blocks of random numbers from here on, beyond those of the scatterings, pick lights.
const PICK_BLOCKS: u32 = 128u;

// Largest cosine of a direction in a cone: cos(θ - σ) for an axis at the angle θ > σ from the
// normal, never below 0.
fn largest_cosine(cone: Cone, normal: vec3<f32>) -> f32 {
    let cos_theta = dot(cone.axis, normal);
    let cos_sigma = 1.0 - cone.height;
    let sines = sqrt(max(1.0 - cos_theta * cos_theta, 0.0) * cone.height * (2.0 - cone.height));
    return select(max(cos_theta * cos_sigma + sines, 0.0), 1.0, cos_theta >= cos_sigma);
}
