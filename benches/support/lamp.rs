//! A lamp over a diffuse floor in a picture of eight pixels, each with its true mean and
//! variance.

use crate::closed_form::{hemisphere_second_moment, sphere_form_factor};
use candor::cpu::sphere::{MISS, Ray, entry, factored};
use candor::scene::{
    Albedo, Camera, Estimator, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface,
};
use glam::DVec3;

pub const PIXELS: usize = 8;

const ALBEDO: f64 = 0.75;
const RADIANCE: f64 = 10.0;
const LAMP: DVec3 = DVec3::new(0.0, 1.0, 0.0);
const LAMP_RADIUS: f64 = 0.5;
/// In anchored form.
const FLOOR_RADIUS: f64 = 1e4;
const CAMERA: DVec3 = DVec3::new(-3.0, 4.0, 5.5);
/// The row of pixels lies along the line y = 0, z = 1.5, from x = -1 to 30.
const LOOK_AT: DVec3 = DVec3::new(3.72, 0.0, 1.5);
const FIELD_OF_VIEW: f64 = 8.4;

/// What one pixel must show.
#[derive(Debug, Clone, Copy)]
pub struct Pixel {
    /// Radiance.
    pub mean: f64,
    /// Standard deviation of one sample of `implicit`.
    pub deviation: f64,
    /// Share of the samples that cosine-weighted directions would bring to the lamp.
    pub share: f64,
}

fn spheres() -> (Sphere, Sphere) {
    let light = Surface::Emitter(Radiance::new(DVec3::splat(RADIANCE)).expect("a radiance"));
    let floor = Surface::Diffuse(Albedo::new(DVec3::splat(ALBEDO)).expect("an albedo"));
    (
        Sphere::new(LAMP, LAMP_RADIUS, light).expect("a lamp"),
        Sphere::new(DVec3::NEG_Y * FLOOR_RADIUS, FLOOR_RADIUS, floor).expect("a floor"),
    )
}

pub fn scene() -> Scene {
    let forward = LOOK_AT - CAMERA;
    // The picture's right is the line's direction, as far as it is seen.
    let up = DVec3::X.cross(forward);
    let camera = Camera::new(CAMERA, LOOK_AT, up, FIELD_OF_VIEW).expect("a camera");
    let settings = RenderSettings::default()
        .with_bounces(1)
        .expect("one bounce")
        .with_estimator(Estimator::Implicit);
    let size = ImageSize::new(8, 1).expect("a size");
    let (lamp, floor) = spheres();
    Scene::new(camera, size, settings, vec![lamp, floor])
}

/// Mean and mean square of a sample at a point of the pixel, over ρL: x in [0, 8) along the
/// row, y in [0, 1).
fn moments(scene: &Scene, x: f64, y: f64) -> [f64; 2] {
    let camera = scene.camera();
    let half = (camera.vertical_fov() / 2.0).tan();
    let direction = camera.forward()
        + half * (2.0 * x - PIXELS as f64) * camera.right()
        + half * (1.0 - 2.0 * y) * camera.up();
    let ray = Ray { origin: camera.position(), direction: direction.normalize() };
    let (lamp, floor) = spheres();
    let meet = |sphere: &Sphere| entry(factored(&ray, sphere.center(), sphere.radius()));
    let t = meet(&floor);
    assert!(t < MISS && meet(&lamp) == MISS, "a ray of the picture meets the floor and no lamp");
    let point = ray.origin + t * ray.direction;
    let normal = (point - floor.center()) / floor.radius();
    let (to_lamp, zenith) = (LAMP - point, normal.angle_between(LAMP - point));
    let h = to_lamp.length() / LAMP_RADIUS;
    let half_angle = (1.0 / h).asin();
    assert!(zenith + half_angle <= std::f64::consts::FRAC_PI_2, "the lamp is above the horizon");
    [sphere_form_factor(zenith, h), hemisphere_second_moment(zenith, half_angle)]
}

/// Means over a pixel by Gauss's rule of three points, in `cells`² cells.
fn integrate(scene: &Scene, pixel: usize, cells: u32) -> [f64; 2] {
    let offset = 0.5 * 0.6_f64.sqrt();
    let nodes = [(0.5 - offset, 5.0 / 18.0), (0.5, 8.0 / 18.0), (0.5 + offset, 5.0 / 18.0)];
    let points = || {
        (0..cells).flat_map(|cell| {
            nodes.map(|(at, weight)| {
                ((f64::from(cell) + at) / f64::from(cells), weight / f64::from(cells))
            })
        })
    };
    let mut sums = [0.0; 2];
    for (x, of_x) in points() {
        for (y, of_y) in points() {
            let found = moments(scene, pixel as f64 + x, y);
            std::iter::zip(&mut sums, found).for_each(|(sum, m)| *sum += of_x * of_y * m);
        }
    }
    sums
}

/// The pixels, from the one under the lamp on.
///
/// # Panics
/// If twice as fine a quadrature differs by 1e-9, a thousandth of what a thousand million
/// samples could show.
pub fn pixels() -> [Pixel; PIXELS] {
    let scene = scene();
    std::array::from_fn(|pixel| {
        let [share, square] = integrate(&scene, pixel, 64);
        let coarse = integrate(&scene, pixel, 32)[0];
        assert!((coarse / share - 1.0).abs() < 1e-9, "the quadrature has converged");
        let most = ALBEDO * RADIANCE;
        Pixel { mean: most * share, deviation: most * (square - share * share).sqrt(), share }
    })
}
