//! Rays that start where walls meet never leave a closed room.

#![expect(clippy::many_single_char_names, reason = "the names of the formulas")]

mod support {
    pub mod gpu;
    pub mod hits;
    pub mod rays;
    pub mod scenes;
}

use candor::kernel::{KernelUnits, Packed, layout};
use candor::scene::Scene;
use candor::viewpoint::Viewpoint;
use glam::{DVec3, Vec3, Vec3Swizzles};
use rayon::prelude::*;
use support::hits::{Case, U};
use support::rays::{Found, MISS, Ray, anywhere, case, draw, next_rays, on_sphere, rays, trace};
use support::scenes::{packed, room};

/// Where three walls (or two, at height z) of the room meet, in the positive octant.
fn meeting(radius: f64, z: Option<f64>) -> DVec3 {
    let far = radius + 3.0;
    let (walls, constant) =
        z.map_or((3.0, 6.0 * radius + 9.0), |z| (2.0, 6.0 * radius + 9.0 + z * z));
    let s = constant / (far + (far * far - walls * constant).sqrt());
    DVec3::new(s, s, z.unwrap_or(s))
}

/// A point within 1e-9 to 1e-5 of an edge or a corner of the room.
fn near_edge(radius: f64, index: usize) -> DVec3 {
    let [kind, z, decades, _] = draw(index, 4);
    let z = (kind < 0.5).then_some(5.0 * z - 2.5);
    let point =
        meeting(radius, z) + 1e-9 * 10.0_f64.powf(4.0 * decades) * on_sphere(draw(index, 5));
    let signs = (index / 7) % 8;
    let sign = |axis: usize| if signs >> axis & 1 == 0 { 1.0 } else { -1.0 };
    let p = DVec3::new(sign(0) * point.x, sign(1) * point.y, sign(2) * point.z);
    match index % 3 {
        0 => p,
        1 => p.yzx(),
        _ => p.zxy(),
    }
}

/// A hit point is never deeper in another wall than this, in kernel units (the scene
/// reaches to 2): a wall that the ray meets at a certain distance is met first, and what
/// is uncertain about it, seen under the ray's angle, is the error of c over two, at
/// most 16 roundings of lengths below 4.
const DEPTH: f64 = 64.0 * U;

/// Whether a ray ended nowhere, or behind a wall.
fn is_lost(scene: &Packed, found: &Found) -> bool {
    let ray = Ray { origin: found.position, direction: Vec3::X, leaving: found.sphere };
    let walls = (0..scene.spheres.len()).map(|place| case(scene, place, &ray));
    let depth = |case: Case| {
        let c = -case.exact().0.c / 2.0;
        if case.anchored { c } else { c / f64::from(case.size) }
    };
    found.sphere == layout::NO_SPHERE || walls.map(depth).any(|depth| depth > DEPTH)
}

/// Sends rays into the edges and corners of the room and on from there; returns how many
/// were lost, of how many.
fn escapes(
    scene: &Scene,
    radius: f64,
    nearest: &dyn Fn(&Packed, &[Ray]) -> Vec<Found>,
) -> (usize, usize) {
    let packed = packed(scene);
    let units = KernelUnits::of(&Viewpoint::of(scene));
    let aim = |origin: Vec3, index| {
        (units.point(near_edge(radius, index)) - origin.as_dvec3()).normalize()
    };
    let mut rays = rays(&packed, 1 << 16);
    for (index, ray) in rays.iter_mut().enumerate() {
        ray.origin = units.point(on_sphere(draw(index, 6))).as_vec3();
        ray.direction = aim(ray.origin, index).as_vec3();
    }
    let (mut escapes, mut total) = (0, 0);
    for stage in 0..4 {
        let found = nearest(&packed, &rays);
        total += rays.len();
        escapes += found.par_iter().filter(|found| is_lost(&packed, found)).count();
        // Once more into the edges, now along the walls.
        rays = next_rays(&found, if stage == 1 { &aim } else { &anywhere });
    }
    (escapes, total)
}

#[test]
fn no_ray_escapes_from_a_closed_room() {
    let rooms = [
        (30.0, false),
        (30.0, true),
        (1e2, true),
        (1e4, true),
        (1e5, true),
        (1e7, true),
        (1e9, true),
    ];
    let mut total = 0;
    for (radius, lamp) in rooms {
        let (escaped, rays) = escapes(&room(radius, lamp), radius, &trace);
        assert_eq!(escaped, 0, "of {rays} rays in a room of radius {radius:e}");
        total += rays;
    }
    println!("{total} rays, no escape");
    assert!(total > 1_000_000);
}

/// The kernel's anchored form, but a hit must lie ahead, as where rays are kept off
/// surfaces by an epsilon: points that rounding put into the next wall are lost.
fn strictly_ahead(scene: &Packed, rays: &[Ray]) -> Vec<Found> {
    let hit = |ray: &Ray| {
        let mut found = Found {
            distance: MISS,
            sphere: layout::NO_SPHERE,
            position: Vec3::ZERO,
            normal: Vec3::ZERO,
        };
        for (place, sphere) in (0..).zip(&scene.spheres) {
            let (m, k) = (Vec3::from_array(sphere.position), sphere.size);
            let g = m + k * ray.origin;
            let (b, c) = (g.dot(ray.direction), (m + g).dot(ray.origin) + 2.0 * sphere.offset);
            let t = c / ((b * b - k * c).max(0.0).sqrt() - b);
            if place >= scene.scene.factored_count
                && place != ray.leaving
                && b < 0.0
                && t > 0.0
                && t < found.distance
            {
                let position = ray.origin + t * ray.direction;
                found = Found {
                    distance: t,
                    sphere: place,
                    position,
                    normal: (m + k * position).normalize(),
                };
            }
        }
        found
    };
    rays.iter().map(hit).collect()
}

#[test]
fn strict_hits_are_rejected() {
    let (escaped, rays) = escapes(&room(1e5, true), 1e5, &strictly_ahead);
    println!("{escaped} of {rays} rays escape if hits must lie ahead");
    assert!(escaped > 1000);
}
