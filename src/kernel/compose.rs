//! Composes the kernel's WGSL from the fragments in `shaders/`, by concatenation alone.

use super::pack::{Form, Packed};
use super::unrolled;
use crate::effects::Effects;
use crate::scene::{Estimator, ImageSize, Scene};
use crate::viewpoint::Viewpoint;

/// Scenes of up to this many spheres get straight-line code instead of a loop over
/// the spheres, which is faster (BENCHMARKS.md, "Speed of the classic scene").
pub const UNROLLED_SPHERES: usize = 16;

macro_rules! fragment {
    ($name:literal) => {
        include_str!(concat!("../../shaders/", $name, ".wgsl"))
    };
}

/// The block of invocations of one workgroup: columns, rows and samples; 64 in all.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Tile {
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Samples of each pixel.
    pub samples: u32,
}

impl Tile {
    /// Invocations of a workgroup.
    pub const INVOCATIONS: u32 = 64;

    /// A tile of 8×8 pixels and one sample; where the picture is narrower or lower than
    /// that, samples take the place of the missing pixels.
    #[must_use]
    pub fn of(size: ImageSize) -> Self {
        let width = size.width().next_power_of_two().min(8);
        let height = size.height().next_power_of_two().min(8);
        Self { width, height, samples: Self::INVOCATIONS / (width * height) }
    }
}

/// How the nearest hit is searched.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Nearest {
    /// A loop over the spheres, any number of them.
    Loop,
    /// One statement per sphere, in the order of the scene file.
    Unrolled(Vec<Form>),
}

impl Nearest {
    /// The search that suits spheres of these forms.
    #[must_use]
    pub fn of(forms: &[Form]) -> Self {
        if forms.len() <= UNROLLED_SPHERES { Self::Unrolled(forms.to_vec()) } else { Self::Loop }
    }

    fn wgsl(&self) -> String {
        match self {
            Self::Loop => fragment!("nearest_loop").to_owned(),
            Self::Unrolled(forms) => unrolled::nearest(forms),
        }
    }
}

/// Paths of up to this many bounces are written out, one statement a segment: a driver's
/// compiler does so by itself for short loops, but not for the longer body of `mis`
/// (BENCHMARKS.md, "Speed of the classic scene").
const UNROLLED_BOUNCES: u32 = 4;

/// The statements that take a path from segment to segment.
fn steps(bounces: u32) -> String {
    if bounces > UNROLLED_BOUNCES {
        return looped("advance");
    }
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
fn follow(steps: &str) -> String {
    format!(
        "// One path: from the camera to a light, to nowhere, or to its last bounce.\n\
         fn trace(pixel: vec2<u32>, key: SampleKey) -> Sample {{\n    load_shapes();\n    \
         var path = start(camera_ray(pixel, unit_floats(random_bits(key, 0u))));\n    \
         var goes_on = true;\n{steps}    \
         return Sample(path.radiance, path.finished);\n}}\n"
    )
}

/// The lights of a scene, for the estimators that sample them.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Lights {
    /// There are none.
    None,
    /// There is one.
    One {
        /// Its place in the uniform buffer.
        place: u32,
        /// Whether it is in anchored form.
        huge: bool,
    },
    /// There are several.
    Many {
        /// Whether one of them is in anchored form.
        huge: bool,
    },
}

impl Lights {
    /// The lights of a packed scene.
    #[must_use]
    pub fn of(packed: &Packed) -> Self {
        let places = packed.light_places();
        let huge = places.iter().any(|&place| place >= packed.scene.factored_count);
        match *places {
            [] => Self::None,
            [place] => Self::One { place, huge },
            _ => Self::Many { huge },
        }
    }

    /// The place of the only light there is.
    fn only(self) -> Option<u32> {
        if let Self::One { place, .. } = self { Some(place) } else { None }
    }

    fn any_huge(self) -> bool {
        matches!(self, Self::One { huge: true, .. } | Self::Many { huge: true })
    }
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
    /// How it searches for the nearest hit.
    pub nearest: Nearest,
    /// The lights.
    pub lights: Lights,
}

impl Kernel {
    /// The kernel that a packed scene calls for.
    #[must_use]
    pub fn of(scene: &Scene, viewpoint: &Viewpoint, packed: &Packed) -> Self {
        Self {
            size: scene.size(),
            bounces: scene.settings().bounces(),
            estimator: scene.settings().estimator(),
            effects: Effects::of(scene, viewpoint),
            nearest: Nearest::of(&packed.forms),
            lights: Lights::of(packed),
        }
    }

    /// The WGSL of the entry point `render`.
    #[must_use]
    pub fn wgsl(&self) -> String {
        let Tile { width, height, samples } = Tile::of(self.size);
        let tile = format!(
            "const TILE_WIDTH: u32 = {width}u;\nconst TILE_HEIGHT: u32 = {height}u;\n\
             const TILE_SAMPLES: u32 = {samples}u;\n"
        );
        let mut parts = self.path();
        parts.push(follow(&steps(self.bounces)));
        let last = [fragment!("film"), fragment!("ledger"), &tile, fragment!("render")];
        parts.extend(last.map(str::to_owned));
        parts.join("\n")
    }

    /// The WGSL of the entry point `replay`, which traces one sample with the text that
    /// `render` traces it with, and records its path. Bounces are always a loop: written out,
    /// recording among several lights takes lavapipe's compiler minutes.
    #[must_use]
    pub fn replay_wgsl(&self) -> String {
        let mut parts = self.path();
        parts.push(follow(&looped("observe")));
        let connection = if self.samples_lights() {
            fragment!("replay_connected")
        } else {
            fragment!("replay_blind")
        };
        parts.extend([connection, fragment!("replay")].map(str::to_owned));
        parts.join("\n")
    }

    /// What advances a path by one segment.
    fn path(&self) -> Vec<String> {
        let mut parts = self.tracing(self.diffuse());
        if self.samples_lights() {
            parts.extend(self.connecting());
            parts.push(
                match self.estimator {
                    Estimator::Mis => fragment!("strategy_mis"),
                    _ => fragment!("strategy_explicit"),
                }
                .to_owned(),
            );
            parts.push(fragment!("path_connected").to_owned());
        } else {
            parts.push(fragment!("path_blind").to_owned());
        }
        parts
    }

    /// Whether there is a light to sample and a surface to sample it from.
    fn samples_lights(&self) -> bool {
        let from_here = match self.estimator {
            Estimator::Implicit | Estimator::Cosine => false,
            Estimator::Explicit => self.effects.diffuse,
            Estimator::Mis => true,
        };
        from_here && self.lights != Lights::None
    }

    /// How diffuse surfaces are sampled.
    fn diffuse(&self) -> &'static str {
        match self.estimator {
            Estimator::Implicit => fragment!("diffuse_uniform"),
            _ => fragment!("diffuse_cosine"),
        }
    }

    /// What every path needs.
    fn tracing(&self, diffuse: &str) -> Vec<String> {
        let side =
            if self.effects.interior { fragment!("interior") } else { fragment!("exterior") };
        let scatter = match (self.effects.diffuse, self.effects.glossy) {
            (true, true) => fragment!("scatter_both"),
            (false, true) => fragment!("scatter_glossy"),
            (_, false) => fragment!("scatter_diffuse"),
        };
        let constants = format!(
            "const WIDTH: u32 = {}u;\nconst HEIGHT: u32 = {}u;\nconst BOUNCES: u32 = {}u;\n",
            self.size.width(),
            self.size.height(),
            self.bounces
        );
        [
            &constants,
            fragment!("scene"),
            fragment!("rng"),
            fragment!("math"),
            fragment!("sphere"),
            side,
            fragment!("nearest"),
            &self.nearest.wgsl(),
            fragment!("sampling"),
            fragment!("material"),
            diffuse,
            scatter,
            fragment!("trace"),
        ]
        .map(str::to_owned)
        .to_vec()
    }

    /// What a path needs besides where it samples lights.
    fn connecting(&self) -> Vec<String> {
        // Glossy surfaces are no place for `explicit` to sample lights.
        let glossy = self.effects.glossy && self.estimator == Estimator::Mis;
        let evaluate = match (self.effects.diffuse, glossy) {
            (true, true) => fragment!("evaluate_both"),
            (false, true) => fragment!("evaluate_glossy"),
            (_, false) => fragment!("evaluate_diffuse"),
        };
        let side = if self.effects.interior {
            fragment!("light_interior")
        } else {
            fragment!("light_exterior")
        };
        let form = if self.lights.any_huge() {
            fragment!("light_both")
        } else {
            fragment!("light_factored")
        };
        let pick = match self.lights.only() {
            Some(place) => format!("const LIGHT: u32 = {place}u;\n\n") + fragment!("pick_one"),
            None => fragment!("pick_many").to_owned(),
        };
        let occluded = match &self.nearest {
            Nearest::Loop => fragment!("occluded_loop").to_owned(),
            Nearest::Unrolled(forms) => unrolled::occluded(forms, self.lights.only()),
        };
        [fragment!("evaluate"), evaluate, fragment!("light"), form, side, &pick, &occluded]
            .map(str::to_owned)
            .to_vec()
    }
}

/// The WGSL of the probe: entry points that run single functions of the kernel over a
/// table of inputs, for the tests.
///
/// # Panics
/// Never: 512×512 is a picture.
#[must_use]
pub fn probe_source() -> String {
    let kernel = Kernel {
        size: ImageSize::new(512, 512).expect("a picture"),
        bounces: 2,
        estimator: Estimator::Mis,
        effects: Effects::ALL,
        nearest: Nearest::Loop,
        lights: Lights::Many { huge: true },
    };
    let mut parts = kernel.tracing(fragment!("diffuse_uniform"));
    parts.extend(kernel.connecting());
    let last = [
        fragment!("strategy_mis"),
        fragment!("path_connected"),
        fragment!("film"),
        fragment!("probe"),
    ];
    parts.extend(last.map(str::to_owned));
    parts.join("\n")
}

/// Parses and validates WGSL as wgpu would, with the features that candor asks for.
///
/// # Errors
/// naga's message, with the place in the source.
pub fn validate(source: &str) -> Result<(naga::Module, naga::valid::ModuleInfo), String> {
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    let info = naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .map_err(|error| error.emit_to_string(source))?;
    Ok((module, info))
}
