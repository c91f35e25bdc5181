// There are so many lights that a tree of them is walked.

fn pick_light(point: SurfacePoint, key: SampleKey, bounce: u32) -> Pick {
    return walk_for_light(point, key, bounce);
}
