// The chance of a light that the path hits by itself, where lights are scanned.

fn chance_in_scan(light: u32, point: SurfacePoint) -> f32 {
    return chance_among(potential(light, point), total_potential(point));
}
