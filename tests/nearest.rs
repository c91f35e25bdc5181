//! Packed surfaces, the nearest hit, and the point and normal there.

#![expect(clippy::many_single_char_names, reason = "the names of the formulas")]

mod support {
    pub mod gpu;
    pub mod hits;
    pub mod rays;
    pub mod scenes;
}

use candor::kernel::{KernelUnits, Packed, layout};
use candor::viewpoint::Viewpoint;
use glam::{DVec3, Vec3};
use support::hits::{Case, U};
use support::rays::{Found, MISS, Ray, anywhere, case, draw, next_rays, rays, trace};
use support::scenes::{classic, diffuse, emitter, many, packed, room, seen, size, sphere};

/// `normalize` as WGSL grants it: a length (dot product 2 roundings, √ 9), a division
/// (5).
const NORMALIZE: f64 = 16.0 * U;

/// Whether some sphere is certainly hit before `found`, or `found` is not on a sphere
/// that can be hit there.
fn is_nearest(scene: &Packed, ray: &Ray, found: &Found) -> bool {
    let within = |place: usize| {
        let case = case(scene, place, ray);
        let (t, bound) = (case.exact().1, case.bounds(U).distance);
        // Not certain of being hit at all: no claim.
        let certain = case.judge(MISS).is_none() && bound < f64::INFINITY;
        (t, bound, certain)
    };
    let met = f64::from(found.distance);
    let spheres = (0..scene.scene.sphere_count).filter(|&place| place != ray.leaving);
    let first = spheres
        .map(|place| within(place as usize))
        .all(|(t, bound, certain)| !certain || met <= t + bound);
    let there = found.sphere == layout::NO_SPHERE
        || case(scene, found.sphere as usize, ray).judge(found.distance).is_some();
    let left = found.sphere != layout::NO_SPHERE && found.sphere == ray.leaving;
    first && there && !left
}

/// How far position and normal are from what they should be, as shares of their bounds.
fn point_errors(scene: &Packed, ray: &Ray, found: &Found) -> (f64, f64) {
    let case = case(scene, found.sphere as usize, ray);
    let (p, n, t) = (found.position.as_dvec3(), found.normal.as_dvec3(), f64::from(found.distance));
    let (place, size) = (case.position.as_dvec3(), f64::from(case.size));
    let reach = ray.origin.as_dvec3().length() + t;
    let at = Case { origin: found.position, ..case };
    let (outward, off, turned) = if case.anchored {
        // One rounding each of t·d, the sum, and the distance under its angle.
        let (gradient, dt) = (place + size * p, case.bounds(U).distance);
        let cosine = gradient.dot(ray.direction.as_dvec3()).abs();
        let off = cosine * dt + size * dt * dt + 3.0 * U * reach;
        (gradient, off, NORMALIZE + U * (gradient.length() + 2.0 * size * p.length()))
    } else {
        // The normal's length, its product with the radius, and the sum.
        let off = (NORMALIZE + U) * size + U * p.length();
        (p - place, off, 2.0 * NORMALIZE + 2.0 * U * (p.length() + size) / size)
    };
    (at.residual(0.0) / off, n.distance(outward.normalize()) / turned)
}

/// Surfaces of the packed scene against those of the scene: every coefficient is off by
/// one rounding.
#[test]
fn packed_walls_lie_on_the_walls_of_the_scene() {
    for radius in [30.0, 1e2, 1e4, 1e6, 1e9, 1e12] {
        let scene = room(radius, true);
        let (packed, units) = (packed(&scene), KernelUnits::of(&Viewpoint::of(&scene)));
        let mut worst = 0.0_f64;
        for index in 0..4096 {
            let row = packed.spheres[1 + index % 6];
            let wall = &scene.spheres()[row.index as usize];
            // A point of the wall within three of its middle, without cancellation.
            let axis = wall.center().normalize();
            let [x, y, ..] = draw(index, 0);
            let across = 6.0
                * (axis.any_orthonormal_vector() * (x - 0.5)
                    + axis.cross(axis.any_orthonormal_vector()) * (y - 0.5));
            let back = across.length_squared() / radius;
            let point = (3.0 + back / (1.0 + (1.0 - back / radius).sqrt())) * axis + across;
            let p = units.point(point);
            let (m, k, e) = (
                Vec3::from_array(row.position).as_dvec3(),
                f64::from(row.size),
                f64::from(row.offset),
            );
            let value = k / 2.0 * p.length_squared() + m.dot(p) + e;
            let bound = U * (m.length() * p.length() + e.abs() + k / 2.0 * p.length_squared());
            // f64 has its own rounding in a centre that is `radius` away: 4·2^-53 of it.
            let bound = bound + radius * U * U / 8.0;
            worst = worst.max(value.abs() / bound);
            assert!(value.abs() <= bound, "radius {radius:e}: {p} is {value:e} off");
        }
        println!("wall of radius {radius:e}: packed within {worst:.2} of the bound");
    }
}

#[test]
fn the_nearest_sphere_is_found_with_its_point_and_normal() {
    for scene in [classic(size(8, 8)), many(size(8, 8)), room(1e7, true)] {
        let packed = packed(&scene);
        let mut rays = rays(&packed, 1 << 14);
        let (mut off, mut turned, mut length) = (0.0_f64, 0.0_f64, 0.0_f64);
        for _ in 0..3 {
            let found = trace(&packed, &rays);
            for (ray, found) in rays.iter().zip(&found) {
                assert!(is_nearest(&packed, ray, found), "{ray:?}: {found:?}");
                if found.sphere != layout::NO_SPHERE {
                    let (o, t) = point_errors(&packed, ray, found);
                    assert!(o <= 1.0 && t <= 1.0, "{ray:?}: {found:?}, {o} and {t} of the bounds");
                    (off, turned) = (off.max(o), turned.max(t));
                    length = length.max((found.normal.as_dvec3().length() - 1.0).abs());
                }
            }
            rays = next_rays(&found, &anywhere);
        }
        println!(
            "point {off:.2}, normal {turned:.2} of their bounds; length of normals {length:.1e}"
        );
        assert!(length <= 1e-6);
    }
}

/// The judge rejects the second sphere, the one left, and a point beside the surface.
#[test]
fn wrong_hits_are_rejected() {
    let packed = packed(&many(size(8, 8)));
    let rays = rays(&packed, 4096);
    let found = trace(&packed, &rays);
    let rejected = |fault: &dyn Fn(&Found) -> Found| {
        let hits = rays.iter().zip(&found).filter(|(_, f)| f.sphere != layout::NO_SPHERE);
        hits.filter(|(ray, found)| {
            let fault = fault(found);
            let wrong = !is_nearest(&packed, ray, &fault);
            wrong || point_errors(&packed, ray, &fault) > (1.0, 1.0)
        })
        .count()
    };
    let hits = found.iter().filter(|f| f.sphere != layout::NO_SPHERE).count();
    assert_eq!(rejected(&|f| *f), 0);
    assert!(
        rejected(&|f| Found { sphere: (f.sphere + 1) % packed.scene.sphere_count, ..*f })
            > hits / 2
    );
    assert!(rejected(&|f| Found { distance: f.distance * 1.0001, ..*f }) > hits / 2);
    assert!(rejected(&|f| Found { position: f.position * 1.0001, ..*f }) > hits / 2);
    let self_hits = rays.iter().zip(&found).filter(|(ray, found)| {
        let leaving = Ray { leaving: found.sphere, ..**ray };
        found.sphere != layout::NO_SPHERE && !is_nearest(&packed, &leaving, found)
    });
    assert_eq!(self_hits.count(), hits);
}

/// A ray that leaves a sphere does not meet it again, even where rounding has it head
/// inwards; without the skip it does, at once.
#[test]
fn a_ray_does_not_meet_the_sphere_that_it_leaves() {
    for scene in [classic(size(8, 8)), many(size(8, 8))] {
        let packed = packed(&scene);
        let found = trace(&packed, &rays(&packed, 4096));
        let away = next_rays(&found, &anywhere);
        let inward = |ray: &Ray| Ray { direction: -ray.direction, ..*ray };
        let inward: Vec<Ray> = away.iter().map(inward).collect();
        let meets_own = |rays: &[Ray], left: &[Ray]| {
            let found = trace(&packed, rays);
            found.iter().zip(left).filter(|(found, left)| found.sphere == left.leaving).count()
        };
        assert_eq!(meets_own(&away, &away) + meets_own(&inward, &inward), 0);
        let forgetful: Vec<Ray> =
            inward.iter().map(|ray| Ray { leaving: layout::NO_SPHERE, ..*ray }).collect();
        assert!(2 * meets_own(&forgetful, &inward) > inward.len());
    }
}

/// Equal distances: the lowest index of the file wins, within a form and across.
#[test]
fn ties_go_to_the_first_in_the_file() {
    // All of them touch in (0, 0, 1), in front of the ray.
    let ball = |radius: f64| sphere([0.0, 0.0, 1.0 - radius], radius, diffuse(0.1));
    let wall = || ball(4097.0);
    let lamp = || sphere([0.0, 4.0, 0.0], 0.5, emitter([1.0; 3]));
    let scenes = [
        vec![ball(1.0), ball(2.0), lamp()],
        vec![lamp(), ball(2.0), ball(1.0)],
        // A nanometre apart: two walls to the file, one to the device.
        vec![wall(), ball(4097.0 + 1e-9), lamp()],
        vec![wall(), ball(1.0), lamp()],
        vec![ball(1.0), wall(), lamp()],
    ];
    for (spheres, first) in scenes.into_iter().zip([0, 1, 0, 0, 0]) {
        let scene = seen([0.0, 0.0, 5.0], DVec3::ZERO, size(1, 1), 0, spheres);
        let packed = packed(&scene);
        let origin = Vec3::from_array(packed.scene.origin);
        let ray = Ray { origin, direction: Vec3::NEG_Z, leaving: layout::NO_SPHERE };
        let found = trace(&packed, &[ray])[0];
        assert_eq!(packed.spheres[found.sphere as usize].index, first, "{scene:?}");
        // Without the winner, the other one is found at the very same distance.
        let other = trace(&packed, &[Ray { leaving: found.sphere, ..ray }])[0];
        assert_ne!(other.sphere, found.sphere);
        assert_eq!(other.distance.to_bits(), found.distance.to_bits(), "no tie: {scene:?}");
    }
}
