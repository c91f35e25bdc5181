// No lights are sampled.

fn connection_of(point: SurfacePoint, sphere: u32, key: SampleKey, bounce: u32) -> Connection {
    return Connection(NO_SPHERE, false);
}
