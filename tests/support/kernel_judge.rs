//! Judges of kernels that may be wrong: each traces one scene and says whether the kernel
//! passes.

use super::judge::is_exactly;
use super::light_scenes;
use super::scenes::{classic, diffuse, emitter, glossy, seen, size, sphere, with_seed};
use super::tracers::{film, kernel, trace, twin, with_effects, with_kernel};
use candor::effects::{Effect, Effects};
use candor::estimate::pair;
use candor::film::Film;
use candor::scene::{Estimator, Scene};
use candor::tracer::Tracer;
use candor::verify::{ALPHA, MAX_BIAS};
use std::ops::Range;
use std::sync::OnceLock;

/// What tells a wrong kernel from the right one.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Judge {
    /// The twin's picture of the same samples: the classic scene.
    Classic,
    /// The same inside a hollow sphere.
    Hollow,
    /// The same under glossy spheres and on a glossy floor.
    Gloss,
    /// The same with a glossy ball in a shell of light.
    Furnace,
    /// The same inside a light.
    Inside,
    /// The same under a huge light.
    Sun,
    /// The same among lamps that touch and overlap.
    Lamps,
    /// The same among more lamps than get straight-line code.
    Crowd,
    /// The same with glossy surfaces alone, of all exponents.
    Lobes,
    /// The same under so many lamps that a tree of them is walked.
    Layer,
    /// The device's own picture by loops over all spheres, to the bit: among hundreds of them,
    /// some in the same place.
    Swarm,
    /// Every sample is one radiance: a shell of dim light, in a scene with a lamp so
    /// bright that the film's words carry.
    Shell,
    /// Every sample is one radiance: a lamp and a wall in the same place.
    Coincident,
    /// One range of samples in one call and in parts, across index 2^32.
    Divisions,
    /// Pictures of two seeds.
    Seeds,
}

const SHELL: [f32; 3] = [0.3, 0.7, 0.011];

fn shell() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 2.0, emitter(SHELL.map(f64::from))),
        sphere([0.0, 9.0, 0.0], 1.0, emitter([1e8; 3])),
    ];
    seen([0.5, 0.0, 0.0], [0.0, 1.0, 0.0], size(5, 3), 2, spheres)
}

fn coincident() -> Scene {
    // The lamp is in front by less than the device's coordinates tell.
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 1.0 + 1e-12, emitter([3.0; 3])),
        sphere([0.0, 0.0, 0.0], 1.0, diffuse(0.5)),
    ];
    seen([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], size(5, 3), 2, spheres)
}

fn hollow() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 5.0, diffuse(0.7)),
        sphere([0.0, 2.5, 0.0], 1.5, emitter([6.0, 5.0, 4.0])),
        sphere([-1.5, -1.0, -2.0], 1.2, glossy(0.9, 20.0)),
    ];
    seen([0.0, 0.0, 4.0], [0.0, 0.0, 0.0], size(32, 32), 3, spheres)
}

fn furnace() -> Scene {
    let spheres = vec![
        sphere([0.0, 0.0, 0.0], 1.0, glossy(0.9, 2.0)),
        sphere([0.0, 0.0, 0.0], 9.0, emitter([2.0, 1.0, 0.5])),
    ];
    seen([0.0, 0.0, 3.0], [0.0, 0.0, 0.0], size(32, 32), 1, spheres)
}

fn gloss() -> Scene {
    let mut spheres = vec![
        sphere([0.0, 5.0, 0.0], 2.5, emitter([5.0, 5.0, 5.0])),
        sphere([0.0, -101.0, 0.0], 100.0, glossy(0.8, 2.0)),
    ];
    for (x, n) in [(-3.0, 1.0), (-1.0, 5.0), (1.0, 20.0), (3.0, 1e4)] {
        spheres.push(sphere([x, 0.0, 0.0], 1.0, glossy(0.95, n)));
    }
    seen([0.0, 2.0, 9.0], [0.0, 0.5, 0.0], size(32, 32), 3, spheres)
}

impl Judge {
    fn scene(self) -> Scene {
        match self {
            Self::Classic | Self::Seeds => classic(size(32, 32)),
            Self::Hollow => hollow(),
            Self::Gloss => gloss(),
            Self::Furnace => furnace(),
            Self::Inside => light_scenes::in_light(),
            Self::Sun => light_scenes::under_sun(1e2),
            Self::Lamps => light_scenes::joined_lights(),
            Self::Crowd => light_scenes::thirty_lights(),
            Self::Lobes => light_scenes::gloss(),
            Self::Layer => light_scenes::lamp_layer(300, 4.0),
            Self::Swarm => light_scenes::swarm(),
            Self::Shell => shell(),
            Self::Coincident => coincident(),
            Self::Divisions => classic(size(3, 2)),
        }
    }

    /// The scene under an estimator.
    fn scene_under(self, estimator: Estimator) -> Scene {
        let scene = self.scene();
        let settings = scene.settings().with_estimator(estimator);
        scene.with_settings(settings)
    }

    /// Whether the kernel passes.
    pub fn accepts(self, estimator: Estimator, change: &dyn Fn(&str) -> String) -> bool {
        let scene = self.scene_under(estimator);
        let mut tracer = with_kernel(&scene, &change(&kernel(&scene)));
        let again = |scene: &Scene| with_kernel(scene, &change(&kernel(scene)));
        match self {
            Self::Shell => {
                valid(&mut tracer, &[0..300]).is_some_and(|f| is_exactly(&f, SHELL, 300))
            }
            Self::Coincident => valid(&mut tracer, &[0..64])
                .is_some_and(|centre| is_exactly(&only(&centre, 7), [3.0; 3], 64)),
            Self::Divisions => {
                let edge = 1_u64 << 32;
                let whole = valid(&mut tracer, &[edge - 9..edge + 32]);
                let parts = valid(&mut again(&scene), &[edge..edge + 32, edge - 9..edge]);
                whole.is_some() && whole == parts
            }
            Self::Seeds => {
                let ours = valid(&mut tracer, &[0..16]);
                let other = valid(&mut again(&with_seed(&scene, 1)), &[0..16]);
                let pixels = |film: Option<Film>| film.map(|film| film.pixels().to_vec());
                ours.is_some() && pixels(ours) != pixels(other)
            }
            Self::Swarm => {
                let effects = Effects::general(&scene).without(Effect::Hierarchy);
                let loops = film(&mut with_effects(&scene, effects), &[0..16]);
                valid(&mut tracer, &[0..16]) == Some(loops)
            }
            _ => {
                let (found, ledger) = trace(&mut tracer, &[0..256]);
                let paired = pair(&found, self.twin(estimator));
                ledger.count == 0 && paired.is_within(MAX_BIAS, ALPHA)
            }
        }
    }

    /// The twin's film of this scene, traced once.
    fn twin(self, estimator: Estimator) -> &'static Film {
        static FILMS: [[OnceLock<Film>; 4]; 15] = [const { [const { OnceLock::new() }; 4] }; 15];
        let scene = self.scene_under(estimator);
        FILMS[self as usize][estimator as usize].get_or_init(|| film(&mut twin(&scene), &[0..256]))
    }
}

/// The film of samples that are all valid.
fn valid(tracer: &mut dyn Tracer, ranges: &[Range<u64>]) -> Option<Film> {
    let (film, ledger) = trace(tracer, ranges);
    (ledger.count == 0).then_some(film)
}

/// One pixel of a film as a film.
fn only(film: &Film, pixel: usize) -> Film {
    let mut one = Film::awaiting(size(1, 1), film.scale(), film.samples().clone());
    one.pixels_mut()[0] = film.pixels()[pixel];
    one
}
