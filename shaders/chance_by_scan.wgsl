// A few lights are scanned.

fn chance_of(light: u32, point: SurfacePoint) -> f32 {
    return chance_in_scan(light, point);
}
