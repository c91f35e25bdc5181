//! Composes the kernel's WGSL from the fragments in `shaders/`, by concatenation alone.

use super::pack::Packed;
use super::search;
use super::text::{Text, fragment};
use super::tile::Tile;
use crate::effects::{Effect, Effects};
use crate::light_tree::SCANNED_LIGHTS;
use crate::scene::{Estimator, ImageSize, Scene};
use crate::viewpoint::Form;

/// Scenes of up to this many spheres get straight-line code instead of a loop over
/// the spheres, which is faster (BENCHMARKS.md, "Speed of the classic scene").
pub const UNROLLED_SPHERES: usize = 16;

/// Paths of up to this many bounces are written out, one statement a segment: a driver's
/// compiler does so by itself for short loops, but not for the longer body of `mis`
/// (BENCHMARKS.md, "Speed of the classic scene").
pub const UNROLLED_BOUNCES: u32 = 4;

/// The statements that take a path from segment to segment, one by one.
fn written_out(bounces: u32) -> String {
    let step = |bounce| {
        format!("    if goes_on {{\n        goes_on = advance(&path, key, {bounce}u);\n    }}\n")
    };
    (0..=bounces).map(step).collect()
}

/// The same as a loop, with any function that advances a path.
fn looped(advance: &str) -> String {
    format!(
        "    for (var bounce = 0u; bounce <= BOUNCES && goes_on; bounce++) {{\n        \
         goes_on = {advance}(&path, key, bounce);\n    }}\n"
    )
}

/// The function that follows a path, taking these steps.
fn follow(steps: &str, loads: &str) -> String {
    format!(
        "// One path: from the camera to a light, to nowhere, or to its last bounce.\n\
         fn trace(pixel: vec2<u32>, key: SampleKey) -> Sample {{\n{loads}    \
         var path = start(camera_ray(pixel, unit_floats(random_bits(key, 0u))));\n    \
         var goes_on = true;\n{steps}    \
         return Sample(path.radiance, path.finished);\n}}\n"
    )
}

/// What one kernel is composed for. It does not depend on which samples are traced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kernel {
    /// Size of the picture.
    pub size: ImageSize,
    /// Most scatterings of one path.
    pub bounces: u32,
    /// How paths are built.
    pub estimator: Estimator,
    /// The effects that it simulates.
    pub effects: Effects,
    /// The forms of a few spheres, in the order of the scene file, where the searches among
    /// them are written out; none where they are loops.
    pub written: Option<Vec<Form>>,
    /// Whether spheres and lights are in storage buffers, not in uniform ones.
    pub stored: bool,
    /// Place of the only light there is to sample.
    pub light: u32,
    /// Most items that wait while a ray goes through the hierarchy.
    pub stack: u32,
}

impl Kernel {
    /// The kernel with these effects for a packed scene: those that the scene calls for
    /// ([`Effects::of`]), or more.
    #[must_use]
    pub fn of(scene: &Scene, effects: Effects, packed: &Packed) -> Self {
        let few = !packed.is_stored() && packed.forms.len() <= UNROLLED_SPHERES;
        Self {
            size: scene.size(),
            bounces: scene.settings().bounces(),
            estimator: scene.settings().estimator(),
            effects,
            written: few.then(|| packed.forms.clone()),
            stored: packed.is_stored(),
            light: packed.lights.first().copied().unwrap_or(0),
            stack: packed.stack,
        }
    }

    /// The same with loops over the spheres, however few there are.
    #[must_use]
    pub fn looped(self) -> Self {
        Self { written: None, ..self }
    }

    /// The WGSL of the entry point `render`.
    #[must_use]
    pub fn wgsl(&self) -> String {
        let Tile { width, height, samples } = Tile::of(self.size);
        let tile = format!(
            "const TILE_WIDTH: u32 = {width}u;\nconst TILE_HEIGHT: u32 = {height}u;\n\
             const TILE_SAMPLES: u32 = {samples}u;\n"
        );
        let mut text = self.path();
        text.push(follow(&self.steps(), self.loads()));
        text.add(fragment!("multiply")).add(fragment!("film")).add(fragment!("ledger"));
        text.push(tile);
        text.add(fragment!("render"));
        text.into_wgsl()
    }

    /// The WGSL of the entry point `replay`, which traces one sample with the text that
    /// `render` traces it with, and records its path. Bounces are always a loop: written out,
    /// recording among several lights takes lavapipe's compiler minutes.
    #[must_use]
    pub fn replay_wgsl(&self) -> String {
        let mut text = self.path();
        if !self.scatters() {
            self.surface(&mut text);
        }
        if self.effects.has(Effect::LightTree) {
            text.add(fragment!("multiply"));
        }
        text.push(follow(&looped("observe"), self.loads()));
        text.add(if self.effects.has(Effect::Connections) {
            fragment!("replay_connected")
        } else {
            fragment!("replay_blind")
        });
        text.add(fragment!("replay"));
        text.into_wgsl()
    }

    /// Whether paths scatter.
    #[must_use]
    pub fn scatters(&self) -> bool {
        self.effects.has(Effect::Diffuse) || self.effects.has(Effect::Glossy)
    }

    /// The statements that take a path from segment to segment.
    fn steps(&self) -> String {
        if !self.scatters() {
            written_out(0)
        } else if self.writes_paths() {
            written_out(self.bounces)
        } else {
            looped("advance")
        }
    }

    /// Whether the segments of a path are written out one by one, not a loop.
    #[must_use]
    pub fn writes_paths(&self) -> bool {
        !self.effects.has(Effect::Hierarchy) && self.bounces <= UNROLLED_BOUNCES
    }

    /// What is loaded once a path.
    fn loads(&self) -> &'static str {
        if self.written.is_some() { search::LOAD } else { "" }
    }

    /// What advances a path by one segment.
    pub(super) fn path(&self) -> Text {
        let mut text = Text::default();
        self.scene(&mut text);
        self.hits(&mut text);
        if !self.scatters() {
            text.add(fragment!("path")).add(fragment!("path_direct"));
            return text;
        }
        self.surface(&mut text);
        self.scattering(&mut text);
        if self.effects.has(Effect::Connections) {
            self.connecting(&mut text);
            text.add(fragment!("path_connected"));
        } else {
            text.add(fragment!("path")).add(fragment!("path_blind"));
        }
        text
    }

    /// The scene's buffers, and random numbers, which are keyed by its seed.
    fn scene(&self, text: &mut Text) {
        text.push(format!(
            "const WIDTH: u32 = {}u;\nconst HEIGHT: u32 = {}u;\nconst BOUNCES: u32 = {}u;\n",
            self.size.width(),
            self.size.height(),
            self.bounces
        ));
        text.add(fragment!("scene"));
        text.add(if self.stored {
            fragment!("spheres_storage")
        } else {
            fragment!("spheres_uniform")
        });
        text.add(fragment!("rng")).add(fragment!("camera"));
    }

    /// What a ray meets.
    fn hits(&self, text: &mut Text) {
        let (factored, anchored) =
            (self.effects.has(Effect::Factored), self.effects.has(Effect::Anchored));
        text.add(fragment!("sphere")).add(fragment!("nearest"));
        if factored || anchored {
            text.add(fragment!("entry"));
        }
        if factored {
            text.add(fragment!("factored"));
        }
        if anchored {
            text.add(fragment!("anchored"));
        }
        if self.effects.has(Effect::Hierarchy) {
            text.push(format!("const STACK: u32 = {}u;\n", self.stack.max(1)));
            text.add(fragment!("hierarchy"));
        }
        search::nearest(text, self.effects, self.written.as_deref());
    }

    /// The place where a ray meets a surface.
    fn surface(&self, text: &mut Text) {
        text.add(fragment!("surface"));
        text.add(match (self.effects.has(Effect::Factored), self.effects.has(Effect::Anchored)) {
            (true, true) => fragment!("point_both"),
            (false, true) => fragment!("point_anchored"),
            (_, false) => fragment!("point_factored"),
        });
        text.add(if self.effects.has(Effect::Interior) {
            fragment!("facing_interior")
        } else {
            fragment!("facing_exterior")
        });
    }

    /// How a path goes on from there.
    fn scattering(&self, text: &mut Text) {
        let (diffuse, glossy) =
            (self.effects.has(Effect::Diffuse), self.effects.has(Effect::Glossy));
        text.add(fragment!("azimuth")).add(fragment!("sampling")).add(fragment!("material"));
        if diffuse && self.estimator == Estimator::Implicit {
            text.add(fragment!("hemisphere_uniform")).add(fragment!("diffuse_uniform"));
        } else if diffuse {
            text.add(fragment!("hemisphere_cosine")).add(fragment!("diffuse_cosine"));
        }
        if glossy {
            text.add(fragment!("exponential")).add(fragment!("lobe"));
        }
        text.add(match (diffuse, glossy) {
            (true, true) => fragment!("scatter_both"),
            (false, true) => fragment!("scatter_glossy"),
            (_, false) => fragment!("scatter_diffuse"),
        });
    }

    /// What a path needs besides where it samples lights.
    fn connecting(&self, text: &mut Text) {
        self.worth(text);
        text.add(fragment!("light"));
        let huge = self.effects.has(Effect::AnchoredLight);
        if self.effects.has(Effect::FactoredLight) || self.effects.has(Effect::LightTree) {
            text.add(fragment!("cone_factored"));
        }
        if self.effects.has(Effect::FactoredLight) {
            text.add(if huge { fragment!("light_both") } else { fragment!("light_factored") });
        } else {
            text.add(fragment!("light_anchored"));
        }
        if huge {
            text.add(fragment!("cone_anchored"));
        }
        text.add(if self.effects.has(Effect::Interior) {
            fragment!("light_interior")
        } else {
            fragment!("light_exterior")
        });
        self.pick(text);
        search::occluded(text, self.effects, self.written.as_deref(), self.only_light());
        if self.estimator == Estimator::Mis {
            self.chance(text);
            text.add(fragment!("strategy_mis"));
        } else {
            text.add(fragment!("strategy_explicit"));
        }
    }

    /// What the direction to a light is worth; glossy surfaces are no place for `explicit` to
    /// sample lights.
    fn worth(&self, text: &mut Text) {
        let glossy = self.effects.has(Effect::Glossy) && self.estimator == Estimator::Mis;
        let diffuse = self.effects.has(Effect::Diffuse);
        text.add(fragment!("evaluate"));
        if diffuse {
            text.add(fragment!("worth_diffuse"));
        }
        if glossy {
            text.add(fragment!("exp_minus")).add(fragment!("worth_glossy"));
        }
        text.add(match (diffuse, glossy) {
            (true, true) => fragment!("evaluate_both"),
            (false, true) => fragment!("evaluate_glossy"),
            (_, false) => fragment!("evaluate_diffuse"),
        });
    }

    /// Which light is sampled.
    fn pick(&self, text: &mut Text) {
        if let Some(place) = self.only_light() {
            text.push(format!("const LIGHT: u32 = {place}u;\n"));
            text.add(fragment!("pick_one"));
            return;
        }
        text.add(fragment!("pick"));
        let (scan, tree) = self.picks();
        if scan {
            text.add(if self.stored {
                fragment!("lights_storage")
            } else {
                fragment!("lights_uniform")
            });
            text.add(fragment!("pick_scan"));
        }
        if tree {
            text.add(fragment!("pick_tree"));
        }
        if scan && tree {
            text.push(format!("const SCANNED_LIGHTS: u32 = {SCANNED_LIGHTS}u;\n"));
        }
        text.add(match (scan, tree) {
            (true, true) => fragment!("pick_by_either"),
            (false, true) => fragment!("pick_by_walk"),
            (_, false) => fragment!("pick_by_scan"),
        });
    }

    /// The chance that a light would have been picked which the path hits by itself: `mis`
    /// weighs that light by it.
    fn chance(&self, text: &mut Text) {
        let (scan, tree) = self.picks();
        if scan {
            text.add(fragment!("chance_in_scan"));
        }
        if tree {
            text.add(fragment!("chance_in_tree"));
        }
        text.add(match (scan, tree) {
            (true, true) => fragment!("chance_by_either"),
            (false, true) => fragment!("chance_by_walk"),
            (true, false) => fragment!("chance_by_scan"),
            (false, false) => fragment!("chance_one"),
        });
    }

    /// Whether a light is picked by a scan, and whether by a walk.
    fn picks(&self) -> (bool, bool) {
        (self.effects.has(Effect::LightScan), self.effects.has(Effect::LightTree))
    }

    /// The place of the only light there is to sample.
    fn only_light(&self) -> Option<u32> {
        (self.picks() == (false, false)).then_some(self.light)
    }
}
