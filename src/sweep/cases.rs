//! The hard cases of the sweep: the classic scene with one thing driven to the edge of
//! the range that candor declares safe.

use crate::scene::{Camera, Exponent, Invalid, Scene, SceneFileError, Sphere, Surface, parse};
use glam::{DQuat, DVec3, EulerRot};

/// The classic scene, as it stands in the repository.
const CLASSIC: &str = include_str!("../../scenes/two-spheres.toml");

/// A wall of this radius is a plane to the device: over the room its surface strays by
/// 4e-13 from one.
const PLANE: f64 = 1e14;

/// The wall that the twin has in its place. It strays by 4e-8 from a plane, and `f64` loses
/// 5e-7 of it (DESIGN.md, "How data flows").
const NEARLY_PLANE: f64 = 1e9;

/// One scene of the sweep.
#[derive(Debug, Clone)]
pub struct Case {
    /// What is driven to the edge.
    pub group: &'static str,
    /// How far.
    pub value: String,
    /// What the device traces.
    pub scene: Scene,
    /// What the twin traces: the same picture.
    pub reference: Scene,
}

impl Case {
    fn new(group: &'static str, value: impl Into<String>, scene: Scene) -> Self {
        Self { group, value: value.into(), reference: scene.clone(), scene }
    }

    /// Whether paths that know nothing of the light cannot be expected to find it.
    #[must_use]
    pub fn needs_light_sampling(&self) -> bool {
        self.group == LIGHT
    }
}

const LIGHT: &str = "light radius";

/// All cases, in the order of the table.
///
/// # Errors
/// If the classic scene of this build is none.
pub fn cases() -> Result<Vec<Case>, SceneFileError> {
    let classic = parse("two-spheres.toml", CLASSIC)?;
    let mut all = walls(&classic);
    all.extend(transformed(&classic));
    all.extend(far_cameras(&classic));
    all.extend(lights(&classic));
    all.extend(exponents(&classic));
    Ok(all)
}

/// The classic scene with other spheres.
fn with_spheres(scene: &Scene, change: impl Fn(&Sphere) -> Result<Sphere, Invalid>) -> Scene {
    let spheres = scene.spheres().iter().map(|s| change(s).expect("within what a scene may hold"));
    Scene::new(scene.camera().clone(), scene.size(), scene.settings(), spheres.collect())
}

/// Walls of another radius, their surfaces where they were.
fn with_walls(classic: &Scene, radius: f64) -> Scene {
    with_spheres(classic, |sphere| {
        if sphere.radius() < 1e4 {
            return Ok(sphere.clone());
        }
        let away = sphere.center().normalize();
        let gap = sphere.center().length() - sphere.radius();
        Sphere::new((radius + gap) * away, radius, sphere.surface())
    })
}

fn walls(classic: &Scene) -> Vec<Case> {
    let mut rows: Vec<Case> = (2..=9)
        .map(|power| {
            Case::new("wall radius", format!("1e{power}"), with_walls(classic, exp10(power)))
        })
        .collect();
    let mut planes = Case::new("wall radius", "planes", with_walls(classic, PLANE));
    planes.reference = with_walls(classic, NEARLY_PLANE);
    rows.push(planes);
    rows
}

/// The whole scene, camera included, turned, scaled and moved.
fn mapped(scene: &Scene, turn: DQuat, scale: f64, shift: DVec3) -> Scene {
    let place = |p: DVec3| turn * (scale * p) + shift;
    let spheres =
        with_spheres(scene, |s| Sphere::new(place(s.center()), scale * s.radius(), s.surface()));
    let camera = scene.camera();
    let ahead = camera.position() + 9.0 * camera.forward();
    let fov = camera.vertical_fov().to_degrees();
    let turned = Camera::new(place(camera.position()), place(ahead), turn * camera.up(), fov);
    seen_by(&spheres, turned)
}

fn seen_by(scene: &Scene, camera: Result<Camera, Invalid>) -> Scene {
    let camera = camera.expect("within what a scene may hold");
    Scene::new(camera, scene.size(), scene.settings(), scene.spheres().to_vec())
}

fn transformed(classic: &Scene) -> Vec<Case> {
    let scaled = [-6, -4, -2, 2, 4, 6].map(|power| {
        Case::new(
            "scaled by",
            format!("1e{power}"),
            mapped(classic, DQuat::IDENTITY, exp10(power), DVec3::ZERO),
        )
    });
    let axes = [("x", DVec3::X), ("y", DVec3::Y), ("z", DVec3::Z)];
    let moved = axes.into_iter().flat_map(|(name, axis)| {
        [1e3, 1e6, -1e6].map(|way| {
            Case::new(
                "moved by",
                format!("{way:e} {name}"),
                mapped(classic, DQuat::IDENTITY, 1.0, way * axis),
            )
        })
    });
    scaled.into_iter().chain(moved).collect()
}

/// The camera far away, with a field that shows the room as before.
fn far_cameras(classic: &Scene) -> Vec<Case> {
    (1..=6)
        .map(|power| {
            let camera = classic.camera();
            let near = camera.position();
            let far = near.normalize() * exp10(power);
            // The opening of the room, seven units nearer than the middle.
            let half = (near.length() - 7.0) * (camera.vertical_fov() / 2.0).tan();
            let half = half.max(3.0);
            let fov = 2.0 * (half / (exp10(power) - 3.0)).atan().to_degrees();
            let moved = Camera::new(far, DVec3::ZERO, camera.up(), fov);
            let turn = DQuat::from_euler(EulerRot::XYZ, 0.7, 0.5, 0.3);
            Case::new(
                "camera away",
                format!("1e{power}"),
                mapped(&seen_by(classic, moved), turn, 1.0, DVec3::ZERO),
            )
        })
        .collect()
}

fn lights(classic: &Scene) -> Vec<Case> {
    (-4..=-1)
        .map(|power| {
            let scene = with_spheres(classic, |s| match s.surface() {
                Surface::Emitter(_) => Sphere::new(s.center(), exp10(power), s.surface()),
                _ => Ok(s.clone()),
            });
            Case::new(LIGHT, format!("1e{power}"), scene)
        })
        .collect()
}

fn exponents(classic: &Scene) -> Vec<Case> {
    [0.0, 1.0, 1e2, 1e4, 1e6, 1e8, 1e10]
        .map(|n| {
            let scene = with_spheres(classic, |s| match s.surface() {
                Surface::Glossy(albedo, _) => {
                    Sphere::new(s.center(), s.radius(), Surface::Glossy(albedo, Exponent::new(n)?))
                }
                _ => Ok(s.clone()),
            });
            Case::new("exponent", format!("{n:e}"), scene)
        })
        .into()
}

/// 10 to a power, as scene files write it.
fn exp10(power: i32) -> f64 {
    format!("1e{power}").parse().expect("a number")
}
