//! Pairs of spheres that meet or nearly do.

use crate::scene::Sphere;

/// Every pair whose boxes are nearer to each other than `margin` of either. Sorted along x
/// and swept, so that spheres far apart cost nothing.
pub(super) fn close_pairs(
    spheres: &[Sphere],
    margin: impl Fn(&Sphere) -> f64,
) -> Vec<(&Sphere, &Sphere)> {
    let low = |s: &Sphere| s.center().x - s.radius();
    let mut sorted: Vec<&Sphere> = spheres.iter().collect();
    sorted.sort_by(|a, b| low(a).total_cmp(&low(b)));
    let (mut open, mut found): (Vec<&Sphere>, _) = (Vec::new(), Vec::new());
    for sphere in sorted {
        open.retain(|other| other.center().x + other.radius() + margin(other) >= low(sphere));
        found.extend(open.iter().filter_map(|other| {
            let apart = (sphere.center() - other.center()).abs().max_element();
            let near = sphere.radius() + other.radius() + margin(sphere).max(margin(other));
            (apart <= near).then_some((*other, sphere))
        }));
        open.push(sphere);
    }
    found
}
