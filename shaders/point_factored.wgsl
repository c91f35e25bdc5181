// Surface points of spheres in factored form, put back onto the surface along the normal,
// which takes off most of the rounding of the distance.
fn surface_point(ray: Ray, hit: Hit) -> SurfacePoint {
    let centre = spheres[hit.sphere].position;
    let radius = spheres[hit.sphere].size;
    let reached = ray.origin + hit.distance * ray.direction;
    let outward = normalize(reached - centre);
    return SurfacePoint(centre + radius * outward, facing_normal(outward, hit.sphere));
}
