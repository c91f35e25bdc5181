// Surface points of spheres in anchored form.
fn surface_point(ray: Ray, hit: Hit) -> SurfacePoint {
    let gradient = spheres[hit.sphere].position;
    let curvature = spheres[hit.sphere].size;
    let reached = ray.origin + hit.distance * ray.direction;
    return SurfacePoint(reached, facing_normal(normalize(gradient + curvature * reached), hit.sphere));
}
