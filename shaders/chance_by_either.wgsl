// The scene may have any number of lights.

fn chance_of(light: u32, point: SurfacePoint) -> f32 {
    if scene.light_count > SCANNED_LIGHTS {
        return chance_in_tree(light, point);
    }
    return chance_in_scan(light, point);
}
