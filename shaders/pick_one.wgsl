// The scene has one light, at place LIGHT.

struct Pick {
    light: u32,
    // Probability of picking this light.
    chance: f32,
}

fn pick_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    return Pick(LIGHT, 1.0);
}
