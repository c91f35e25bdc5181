// A few lights are scanned.

fn pick_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    return scan_for_light(point, key, bounce);
}

fn chance_of(light: u32, point: SurfacePoint) -> f32 {
    return chance_in_scan(light, point);
}
