// The scene may have any number of lights: up to SCANNED_LIGHTS are scanned.

fn pick_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    if scene.light_count > SCANNED_LIGHTS {
        return walk_for_light(point, key, bounce);
    }
    return scan_for_light(point, key, bounce);
}
