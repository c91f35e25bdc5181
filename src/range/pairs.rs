//! Pairs of spheres that meet or nearly do.

use crate::scene::Sphere;

/// Most pairs that are looked at, some seconds of work. Only spheres that nearly all overlap
/// make so many, 16,000 of them.
const MOST_PAIRS: u64 = 1 << 27;

/// More than [`MOST_PAIRS`] pairs.
pub(super) struct TooManyPairs;

/// Visits every pair whose boxes are nearer to each other than `margin` of either. Sorted
/// along x and swept, so that spheres far apart cost nothing.
pub(super) fn visit_close_pairs<'a>(
    spheres: &'a [Sphere],
    margin: impl Fn(&Sphere) -> f64,
    mut visit: impl FnMut(&'a Sphere, &'a Sphere),
) -> Result<(), TooManyPairs> {
    let boxed = |sphere: &'a Sphere| {
        let reach = sphere.radius() + margin(sphere);
        (sphere.center().x - reach, sphere.center().x + reach, sphere, margin(sphere))
    };
    let mut sorted: Vec<(f64, f64, &Sphere, f64)> = spheres.iter().map(boxed).collect();
    sorted.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut open: Vec<(f64, &Sphere, f64)> = Vec::new();
    let mut looked_at = 0;
    for (low, high, sphere, margin) in sorted {
        open.retain(|&(other_high, ..)| other_high >= low);
        looked_at += open.len() as u64;
        if looked_at > MOST_PAIRS {
            return Err(TooManyPairs);
        }
        for &(_, other, other_margin) in &open {
            let apart = (sphere.center() - other.center()).abs().max_element();
            if apart <= sphere.radius() + other.radius() + margin.max(other_margin) {
                visit(other, sphere);
            }
        }
        open.push((high, sphere, margin));
    }
    Ok(())
}
