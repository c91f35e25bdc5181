//! Pairs of spheres that meet or nearly do.

use crate::hierarchy::{Bounds, Hierarchy, TooManyPairs};
use crate::scene::Sphere;
use glam::DVec3;

/// Most pairs that are looked at, some seconds of work. Only spheres that nearly all overlap
/// make so many, 16,000 of them.
const MOST_PAIRS: u64 = 1 << 27;

/// Of all pairs whose boxes are nearer to each other than `margin` of either, the first that
/// `judge` says something of, and what: first by the smaller sphere's number and then by the
/// larger one's. `judge` gets the smaller sphere first, of two that are as large the earlier
/// one. Boxes are made around `focus`, where `f32` has most digits.
pub(super) fn first_close_pair<'a, T: Send>(
    spheres: &'a [Sphere],
    focus: DVec3,
    margin: impl Fn(&Sphere) -> f64 + Sync,
    judge: impl Fn(&'a Sphere, &'a Sphere) -> Option<T> + Sync,
) -> Result<Option<T>, TooManyPairs> {
    let margins: Vec<f64> = spheres.iter().map(margin).collect();
    let around = |(sphere, margin): (&Sphere, &f64)| {
        // Rounding moves the box by less than it grows.
        let (center, reach) = (sphere.center() - focus, sphere.radius() + margin);
        Bounds::of_sphere(center, reach + 4.0 * f64::EPSILON * (center.length() + reach))
    };
    let bounds: Vec<Bounds> = spheres.iter().zip(&margins).map(around).collect();
    let tree = Hierarchy::build(&bounds);
    let first = tree.least_of_pairs(MOST_PAIRS, |i, j| {
        let (i, j) = (i as usize, j as usize);
        let (a, b) = (&spheres[i], &spheres[j]);
        let apart = (a.center() - b.center()).abs().max_element();
        if apart > a.radius() + b.radius() + margins[i].max(margins[j]) {
            return None;
        }
        let size_and_number = |sphere: &Sphere| (sphere.radius(), sphere.ordinal());
        let is_ordered = size_and_number(a) <= size_and_number(b);
        let (small, large) = if is_ordered { (a, b) } else { (b, a) };
        judge(small, large).map(|found| ((small.ordinal(), large.ordinal()), found))
    });
    Ok(first?.map(|(_, found)| found))
}

#[cfg(test)]
mod tests {
    use super::{Sphere, first_close_pair};
    use crate::scene::{Albedo, Camera, ImageSize, RenderSettings, Scene, Surface};
    use glam::DVec3;
    use std::sync::Mutex;

    fn scene(spheres: impl IntoIterator<Item = (DVec3, f64)>) -> Scene {
        let surface = Surface::Diffuse(Albedo::new(DVec3::ONE).expect("an albedo"));
        let sphere = |(center, radius)| Sphere::new(center, radius, surface).expect("a sphere");
        let camera = Camera::new(DVec3::ZERO, DVec3::X, DVec3::Z, 60.0).expect("a camera");
        let size = ImageSize::new(2, 2).expect("a size");
        let spheres = spheres.into_iter().map(sphere).collect();
        Scene::new(camera, size, RenderSettings::default(), spheres)
    }

    /// Spheres of radii over `decades`, the smallest 0.01, in a cube of side 2 around `center`:
    /// spread evenly, by multiples of irrational numbers.
    fn spread(count: u32, decades: f64, center: DVec3) -> Scene {
        let steps = [2_f64, 3.0, 5.0, 7.0].map(f64::sqrt);
        scene((0..count).map(|index| {
            let [x, y, z, size] = steps.map(|step| (f64::from(index) * step).fract());
            let place = 2.0 * DVec3::new(x, y, z) - 1.0;
            (center + place, 10_f64.powf(decades * size - 2.0))
        }))
    }

    fn is_close(a: &Sphere, b: &Sphere, margin: f64) -> bool {
        let apart = (a.center() - b.center()).abs().max_element();
        apart <= a.radius() + b.radius() + margin
    }

    fn ordered(a: &Sphere, b: &Sphere) -> (usize, usize) {
        let key = (a.ordinal(), b.ordinal());
        if a.radius() <= b.radius() { key } else { (key.1, key.0) }
    }

    /// Numbers of all close pairs, the smaller sphere's first.
    fn by_force(spheres: &[Sphere], margin: impl Fn(&Sphere) -> f64) -> Vec<(usize, usize)> {
        let mut pairs = Vec::new();
        for (i, a) in spheres.iter().enumerate() {
            let close =
                spheres[i + 1..].iter().filter(|b| is_close(a, b, margin(a).max(margin(b))));
            pairs.extend(close.map(|b| ordered(a, b)));
        }
        pairs.sort_unstable();
        pairs
    }

    /// The pairs that the tree finds.
    fn by_tree(
        spheres: &[Sphere],
        focus: DVec3,
        margin: impl Fn(&Sphere) -> f64 + Sync,
    ) -> Vec<(usize, usize)> {
        let pairs = Mutex::new(Vec::new());
        let judge = |a: &Sphere, b: &Sphere| {
            pairs.lock().expect("no thread panics").push((a.ordinal(), b.ordinal()));
            None::<()>
        };
        let found = first_close_pair(spheres, focus, margin, judge);
        assert_eq!(found.expect("few pairs"), None);
        let mut pairs = pairs.into_inner().expect("no thread panics");
        pairs.sort_unstable();
        pairs
    }

    #[test]
    fn all_close_pairs_are_found() {
        let far = DVec3::new(1e9, -1e8, 1e7);
        let chain = (0..60).map(|i| (DVec3::splat(2_f64.powi(i - 30)), 2_f64.powi(i - 30)));
        let grid = (0..1000).map(|i| {
            let place = [i % 10, i / 10 % 10, i / 100].map(f64::from);
            (DVec3::from(place), 0.5)
        });
        let scenes = [
            (spread(3000, 2.0, DVec3::ZERO), DVec3::ZERO, 0.0),
            (spread(3000, 1.5, DVec3::ZERO), DVec3::ZERO, 1e-3),
            (spread(1000, 2.0, far), far, 1e-12),
            // A focus elsewhere makes boxes coarse, and loses nothing.
            (spread(1000, 1.0, far), DVec3::ZERO, 1e-12),
            (scene(chain), DVec3::ZERO, 1e-9),
            // Touching to the bit.
            (scene(grid), DVec3::new(4.5, 4.5, 4.5), 0.0),
        ];
        for (index, (scene, focus, share)) in scenes.iter().enumerate() {
            let margin = |sphere: &Sphere| share * (sphere.center().length() + sphere.radius());
            let expected = by_force(scene.spheres(), margin);
            assert!(expected.len() > 20, "{index}: {} pairs", expected.len());
            assert_eq!(by_tree(scene.spheres(), *focus, margin), expected, "{index}");
        }
    }

    /// Whatever the threads do: of the pairs with a fault the first by the smaller sphere's
    /// number and the larger's.
    #[test]
    fn the_first_fault_is_the_first_in_the_file() {
        let scene = spread(2000, 2.0, DVec3::ZERO);
        let pairs = by_force(scene.spheres(), |_| 0.01);
        for part in [2, 3, 5, 50] {
            let is_fault = |pair: &(usize, usize)| (pair.0 * 31 + pair.1 * 17) % part == 1;
            let judge = |a: &Sphere, b: &Sphere| {
                let pair = (a.ordinal(), b.ordinal());
                is_fault(&pair).then_some(pair)
            };
            let found = first_close_pair(scene.spheres(), DVec3::ZERO, |_| 0.01, judge);
            assert_eq!(found.expect("few pairs"), pairs.iter().copied().find(is_fault));
        }
    }

    #[test]
    fn too_many_pairs_are_not_all_looked_at() {
        let crowd = scene((0..17_000).map(|i| (DVec3::X * f64::from(i) * 1e-6, 1.0)));
        assert!(
            first_close_pair(crowd.spheres(), DVec3::ZERO, |_| 0.0, |_, _| None::<()>).is_err()
        );
    }
}
