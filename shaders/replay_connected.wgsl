// The light that `connect` samples from a vertex, found once more by the same functions.

fn connection_of(point: SurfacePoint, sphere: u32, key: SampleKey, bounce: u32) -> Connection {
    if bounce == BOUNCES || spheres[sphere].kind == KIND_EMITTER || !samples_light_at(sphere) {
        return Connection(NO_SPHERE, false);
    }
    let bits = random_bits(key, bounce + 1u);
    let pick = pick_light(point, key, bounce);
    let cone = cone_of(pick.light, point);
    let polar = polar_cone(unit_float(bits.z), cone.height);
    let ray = Ray(point.position, around(cone.axis, polar, unit_float(bits.w)));
    let distance = seen_distance(light_quadratic(pick.light, ray), pick.light);
    return Connection(pick.light, !occluded(ray, sphere, pick.light, distance));
}
