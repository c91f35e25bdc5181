// A few lights are scanned.

fn pick_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    return scan_for_light(point, key, bounce);
}
