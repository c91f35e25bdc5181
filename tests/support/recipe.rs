//! Random scenes as a user would write them: recipes that proptest draws and shrinks, and
//! the scene files that they make.

use glam::DVec3;
use proptest::prelude::*;
use std::f64::consts::TAU;
use std::fmt::Write as _;

/// Where a sphere is. `of` counts the spheres before it, round and round.
#[derive(Debug, Clone)]
pub enum Place {
    /// So far from the origin.
    Free { way: DVec3, distance: f64 },
    /// Against another sphere, from outside or from inside, off by some units in the last
    /// place of the distance.
    Touching { of: usize, way: DVec3, inside: bool, ulps: i8 },
    /// Around the same centre.
    Concentric { of: usize },
    /// The same sphere once more, of another surface.
    Coincident { of: usize },
    /// Near another, so many of its radii from its surface and so many times as large.
    Beside { of: usize, way: DVec3, gap: f64, size: f64 },
    /// Anywhere inside another.
    Nested { of: usize, way: DVec3, share: f64 },
}

#[derive(Debug, Clone)]
pub enum Surface {
    Emission(f64),
    Diffuse(f64),
    Glossy(f64, f64),
}

#[derive(Debug, Clone)]
pub struct Ball {
    pub place: Place,
    pub radius: f64,
    pub surface: Surface,
}

/// Where the camera is, relative to a sphere: so many radii from its centre. 1 is on it.
#[derive(Debug, Clone)]
pub struct Eye {
    pub of: usize,
    pub way: DVec3,
    pub radii: f64,
    /// Looks to the sphere's centre, or past it.
    pub target: DVec3,
    pub fov: f64,
}

#[derive(Debug, Clone)]
pub struct Recipe {
    pub balls: Vec<Ball>,
    pub eye: Eye,
    pub bounces: u32,
    pub estimator: &'static str,
    pub seed: u32,
}

/// Along an axis, where sums of lengths are exact, or anywhere.
fn way() -> impl Strategy<Value = DVec3> {
    let axis = prop::sample::select(vec![
        DVec3::X,
        DVec3::Y,
        DVec3::Z,
        DVec3::NEG_X,
        DVec3::NEG_Y,
        DVec3::NEG_Z,
    ]);
    let free = (-1.0..1.0, 0.0..TAU).prop_map(|(z, angle): (f64, f64)| {
        let flat = (1.0 - z * z).sqrt();
        DVec3::new(flat * angle.cos(), flat * angle.sin(), z)
    });
    prop_oneof![axis, free]
}

/// A length, uniform in its logarithm: 10^-`decades` to 10^`decades`, or in the sixth of it.
fn length(decades: f64) -> impl Strategy<Value = f64> {
    let log = |decades: f64| (-decades..decades).prop_map(|log| 10_f64.powf(log));
    prop_oneof![Just(1.0), log(decades / 6.0), log(decades)]
}

fn place(decades: f64) -> impl Strategy<Value = Place> {
    let of = || 0..12_usize;
    prop_oneof![
        3 => (way(), length(decades)).prop_map(|(way, distance)| Place::Free { way, distance }),
        3 => (of(), way(), any::<bool>(), prop_oneof![Just(0), -3..4_i8])
            .prop_map(|(of, way, inside, ulps)| Place::Touching { of, way, inside, ulps }),
        4 => (of(), way(), length(2.0), length(2.0))
            .prop_map(|(of, way, gap, size)| Place::Beside { of, way, gap, size }),
        1 => of().prop_map(|of| Place::Concentric { of }),
        1 => of().prop_map(|of| Place::Coincident { of }),
        2 => (of(), way(), 0.0..1.0)
            .prop_map(|(of, way, share)| Place::Nested { of, way, share }),
    ]
}

fn surface() -> impl Strategy<Value = Surface> {
    let albedo = || prop_oneof![Just(1.0), 0.0..1.0];
    let exponent = prop_oneof![
        Just(0.0),
        Just(1.0),
        Just(1e10),
        (0.0..10.0_f64).prop_map(|log| 10_f64.powf(log))
    ];
    prop_oneof![
        (-3.0..3.0_f64).prop_map(|log| Surface::Emission(10_f64.powf(log))),
        albedo().prop_map(Surface::Diffuse),
        (albedo(), exponent).prop_map(|(rho, n)| Surface::Glossy(rho, n)),
    ]
}

fn ball(decades: f64) -> impl Strategy<Value = Ball> {
    (place(decades), length(decades), surface()).prop_map(|(place, radius, surface)| Ball {
        place,
        radius,
        surface,
    })
}

fn eye() -> impl Strategy<Value = Eye> {
    let radii = prop_oneof![Just(1.0), Just(0.0), 0.0..1.0, 1.0..20.0];
    let target = prop_oneof![Just(DVec3::ZERO), way(), way().prop_map(|way| 30.0 * way)];
    (0..12_usize, way(), radii, target, 1.0..170.0_f64)
        .prop_map(|(of, way, radii, target, fov)| Eye { of, way, radii, target, fov })
}

/// Scenes of up to 12 spheres and a sky, whose radii and distances lie in 10^±`decades`.
pub fn recipes(decades: f64) -> impl Strategy<Value = Recipe> {
    let estimator = prop::sample::select(vec!["implicit", "cosine", "explicit", "mis"]);
    let lights = (any::<bool>(), any::<bool>());
    let balls = prop::collection::vec(ball(decades), 1..=12);
    (balls, lights, eye(), 0..5_u32, estimator, any::<u32>()).prop_map(
        move |(mut balls, (lamp, sky), eye, bounces, estimator, seed)| {
            if lamp {
                balls[0].surface = Surface::Emission(10.0);
            }
            if sky {
                let place = Place::Concentric { of: eye.of };
                let surface = Surface::Emission(1.0);
                balls.push(Ball { place, radius: 10_f64.powf(decades + 1.0), surface });
            }
            Recipe { balls, eye, bounces, estimator, seed }
        },
    )
}

/// Centres and radii in the order of the recipe.
fn spheres(balls: &[Ball]) -> Vec<(DVec3, f64)> {
    let mut made: Vec<(DVec3, f64)> = Vec::new();
    for ball in balls {
        let earlier = |of: usize| made.get(of % made.len().max(1)).copied();
        let origin = (DVec3::ZERO, 1.0);
        made.push(match ball.place {
            Place::Free { way, distance } => (distance * way, ball.radius),
            Place::Touching { of, way, inside, ulps } => {
                let (center, radius) = earlier(of).unwrap_or(origin);
                let away = if inside { (radius - ball.radius).abs() } else { radius + ball.radius };
                (center + away * (1.0 + f64::from(ulps) * f64::EPSILON) * way, ball.radius)
            }
            Place::Concentric { of } => (earlier(of).unwrap_or(origin).0, ball.radius),
            Place::Coincident { of } => earlier(of).unwrap_or(origin),
            Place::Beside { of, way, gap, size } => {
                let (center, radius) = earlier(of).unwrap_or(origin);
                let own = size * radius;
                (center + (radius + own + gap * radius) * way, own)
            }
            Place::Nested { of, way, share } => {
                let (center, radius) = earlier(of).unwrap_or(origin);
                let own = ball.radius.min(radius / 2.0);
                (center + share * (radius - own) * way, own)
            }
        });
    }
    made
}

impl Recipe {
    /// The scene file. Whether it is a valid scene is for the parser to say.
    pub fn toml(&self, size: u32) -> String {
        let spheres = spheres(&self.balls);
        let (center, radius) = spheres[self.eye.of % spheres.len().min(12)];
        let position = center + self.eye.radii * radius * self.eye.way;
        let mut target = center + radius * self.eye.target;
        if target == position {
            target = position + radius * DVec3::X;
        }
        let sight = (target - position).normalize();
        let up = if sight.y.abs() > 0.9 { DVec3::X } else { DVec3::Y };
        let mut text = format!(
            "[camera]\nposition = {}\nlook_at = {}\nup = {}\nvertical_fov = {:?}\n\n\
             [image]\nwidth = {size}\nheight = {size}\n\n\
             [render]\nbounces = {}\nestimator = \"{}\"\nseed = {}\n",
            list(position),
            list(target),
            list(up),
            self.eye.fov,
            self.bounces,
            self.estimator,
            self.seed
        );
        let mut put = |line: String| writeln!(text, "{line}").expect("text takes every write");
        for (i, (ball, &(center, radius))) in self.balls.iter().zip(&spheres).enumerate() {
            let surface = match ball.surface {
                Surface::Emission(l) => {
                    format!("emission = {}", list(DVec3::new(l, l / 2.0, l / 3.0)))
                }
                Surface::Diffuse(rho) => {
                    put(format!("\n[materials.m{i}]\ndiffuse = {}", list(shades(rho))));
                    format!("material = \"m{i}\"")
                }
                Surface::Glossy(rho, n) => {
                    let glossy = list(shades(rho));
                    put(format!("\n[materials.m{i}]\nglossy = {glossy}\nexponent = {n:?}"));
                    format!("material = \"m{i}\"")
                }
            };
            put(format!(
                "\n[[spheres]]\ncenter = {}\nradius = {radius:?}\n{surface}",
                list(center)
            ));
        }
        text
    }
}

/// Albedos that tell the channels apart.
fn shades(rho: f64) -> DVec3 {
    rho * DVec3::new(1.0, 0.75, 0.5)
}

fn list(v: DVec3) -> String {
    format!("[{:?}, {:?}, {:?}]", v.x, v.y, v.z)
}
