//! Spheres in the place of another.

use std::hash::{DefaultHasher, Hash, Hasher};

use glam::DVec3;
use rayon::prelude::*;

use super::Sphere;

/// Drops each sphere with the same centre and radius as an earlier one.
pub(super) fn drop_hidden(spheres: &mut Vec<Sphere>) {
    // Sorting by hashes finds equals as fast as a hash table does on one core, and uses all; where
    // hashes agree the places decide, so that no choice of places makes it slow.
    let mut order: Vec<(u64, usize)> =
        spheres.par_iter().enumerate().map(|(index, sphere)| (hash(sphere), index)).collect();
    order.par_sort_unstable_by(|&(a_hash, a), &(b_hash, b)| {
        a_hash
            .cmp(&b_hash)
            .then_with(|| place(&spheres[a]).cmp(&place(&spheres[b])))
            .then(a.cmp(&b))
    });
    let mut hidden: Vec<usize> = order
        .windows(2)
        .filter(|pair| pair[0].0 == pair[1].0)
        .filter(|pair| place(&spheres[pair[0].1]) == place(&spheres[pair[1].1]))
        .map(|pair| pair[1].1)
        .collect();
    if hidden.is_empty() {
        return;
    }
    hidden.sort_unstable();
    let mut index = 0;
    spheres.retain(|_| {
        index += 1;
        hidden.binary_search(&(index - 1)).is_err()
    });
}

/// Centre and radius, equal as bits where they are equal as numbers.
fn place(sphere: &Sphere) -> [u64; 4] {
    let place = (sphere.center() + DVec3::ZERO).extend(sphere.radius());
    place.to_array().map(f64::to_bits)
}

fn hash(sphere: &Sphere) -> u64 {
    let mut hasher = DefaultHasher::new();
    place(sphere).hash(&mut hasher);
    hasher.finish()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Albedo, Surface};

    /// Spheres on a small grid, so that most are in the place of an earlier one, with zeros of
    /// both signs.
    fn crowd() -> Vec<Sphere> {
        let surface = Surface::Diffuse(Albedo::new(DVec3::ONE).expect("an albedo"));
        let mut state = 1_u32;
        let mut next = |most: u32| {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            f64::from((state >> 16) % most)
        };
        (0..3000)
            .map(|_| {
                let center = DVec3::new(-next(7), next(7), 0.0 * (next(2) - 0.5));
                Sphere::new(center, 1.0 + next(20), surface).expect("a sphere")
            })
            .collect()
    }

    #[test]
    fn the_first_in_each_place_stays() {
        let mut spheres = crowd();
        for (number, sphere) in (1..).zip(&mut spheres) {
            sphere.set_ordinal(number);
        }
        let mut expected: Vec<Sphere> = Vec::new();
        for sphere in &spheres {
            let same = |other: &Sphere| {
                other.center() == sphere.center()
                    && other.radius() <= sphere.radius()
                    && other.radius() >= sphere.radius()
            };
            if !expected.iter().any(same) {
                expected.push(sphere.clone());
            }
        }
        drop_hidden(&mut spheres);
        assert!(expected.len() > 900 && expected.len() < 1000, "{} places", expected.len());
        assert_eq!(spheres, expected);
    }
}
