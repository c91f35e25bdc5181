//! Scenes whose radiance can be written down. The body that is looked at touches the
//! origin from below, its normal there is +y, and x is the plane of all angles.

use candor::scene::{
    Albedo, Camera, Exponent, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface,
};
use glam::DVec3;

/// Pixels along a side: enough pixels that the scatter between them is an error bar
/// with hardly wider tails than a normal deviate's.
const SIDE: u32 = 32;
/// Field of view, in degrees, of a camera that sees one point: half of it is less
/// than 1e-8 in radians.
const ONE_POINT: f64 = 1e-6;
/// Distance of the camera from the point that it looks at.
const CAMERA_DISTANCE: f64 = 5.0;
/// Distance of the light's centre from the origin.
const LIGHT_DISTANCE: f64 = 2.0;
/// Radius of the emitting shell around everything.
const SHELL_RADIUS: f64 = 10.0;
/// Radius of the hollow diffuse sphere.
pub const HOLLOW_RADIUS: f64 = 4.0;

pub fn diffuse(rho: impl Into<DVec3>) -> Surface {
    Surface::Diffuse(Albedo::new(rho.into()).expect("an albedo"))
}

pub fn glossy(rho: f64, exponent: f64) -> Surface {
    let exponent = Exponent::new(exponent).expect("an exponent");
    Surface::Glossy(Albedo::new(DVec3::splat(rho)).expect("an albedo"), exponent)
}

pub fn emitter(radiance: impl Into<DVec3>) -> Surface {
    Surface::Emitter(Radiance::new(radiance.into()).expect("a radiance"))
}

pub fn sphere(center: impl Into<DVec3>, radius: f64, surface: Surface) -> Sphere {
    Sphere::new(center.into(), radius, surface).expect("a sphere")
}

/// A direction at an angle from the normal.
pub fn at_angle(angle: f64) -> DVec3 {
    DVec3::new(angle.sin(), angle.cos(), 0.0)
}

/// The body: a sphere under the origin.
pub fn body(radius: f64, surface: Surface) -> Sphere {
    sphere([0.0, -radius, 0.0], radius, surface)
}

/// A light at an angle from the normal, `h` of its radii away.
pub fn light(zenith: f64, h: f64, radiance: f64) -> Sphere {
    let center = LIGHT_DISTANCE * at_angle(zenith);
    sphere(center, LIGHT_DISTANCE / h, emitter(DVec3::splat(radiance)))
}

/// A shell of light around everything.
pub fn shell(radiance: impl Into<DVec3>) -> Sphere {
    sphere(DVec3::ZERO, SHELL_RADIUS, emitter(radiance))
}

/// A hollow diffuse sphere around a light that fills `fraction` of its view.
pub fn hollow(albedo: f64, fraction: f64, radiance: f64) -> Vec<Sphere> {
    vec![
        sphere(DVec3::ZERO, HOLLOW_RADIUS, diffuse(DVec3::splat(albedo))),
        sphere(DVec3::ZERO, HOLLOW_RADIUS * fraction.sqrt(), emitter(DVec3::splat(radiance))),
    ]
}

/// Looks at the origin from `angle` off the normal, on the side away from lights, and
/// sees one point of the body.
pub fn seen_from(angle: f64, bounces: u32, spheres: Vec<Sphere>) -> Scene {
    seen_along(CAMERA_DISTANCE * at_angle(-angle), DVec3::ZERO, bounces, spheres)
}

/// Sees one point, in the direction from `position` to `target`.
pub fn seen_along(
    position: impl Into<DVec3>,
    target: impl Into<DVec3>,
    bounces: u32,
    spheres: Vec<Sphere>,
) -> Scene {
    picture(position.into(), target.into(), ONE_POINT, bounces, spheres)
}

/// Sees a wide field.
pub fn seen_wide(
    position: impl Into<DVec3>,
    target: impl Into<DVec3>,
    bounces: u32,
    spheres: Vec<Sphere>,
) -> Scene {
    picture(position.into(), target.into(), 60.0, bounces, spheres)
}

fn picture(position: DVec3, target: DVec3, fov: f64, bounces: u32, spheres: Vec<Sphere>) -> Scene {
    let camera = Camera::new(position, target, DVec3::Z, fov).expect("a camera");
    let settings = RenderSettings::default().with_bounces(bounces).expect("a few bounces");
    Scene::new(camera, ImageSize::new(SIDE, SIDE).expect("a size"), settings, spheres)
}
