// A tree of many lights is walked.

fn chance_of(light: u32, point: SurfacePoint) -> f32 {
    return chance_in_tree(light, point);
}
