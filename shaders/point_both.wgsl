// Surface points of both forms. On a sphere in factored form the point is put back onto the
// surface along the normal, which takes off most of the rounding of the distance.
fn surface_point(ray: Ray, hit: Hit) -> SurfacePoint {
    let place = spheres[hit.sphere].position;
    let size = spheres[hit.sphere].size;
    let reached = ray.origin + hit.distance * ray.direction;
    let is_factored = hit.sphere < scene.factored_count;
    let outward = normalize(select(place + size * reached, reached - place, is_factored));
    let position = select(reached, place + size * outward, is_factored);
    return SurfacePoint(position, facing_normal(outward, hit.sphere));
}
