//! Composes the kernel's WGSL from the fragments in `shaders/`, by concatenation alone.

use super::pack::Form;
use crate::effects::Effects;
use crate::scene::ImageSize;

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
            Self::Unrolled(forms) => unrolled(forms),
        }
    }
}

/// What one kernel is composed for. It does not depend on which samples are traced.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Kernel {
    /// Size of the picture.
    pub size: ImageSize,
    /// Most scatterings of one path.
    pub bounces: u32,
    /// The effects that it simulates.
    pub effects: Effects,
    /// How it searches for the nearest hit.
    pub nearest: Nearest,
}

impl Kernel {
    /// The WGSL of the entry point `render`.
    #[must_use]
    pub fn wgsl(&self) -> String {
        let Tile { width, height, samples } = Tile::of(self.size);
        let tile = format!(
            "const TILE_WIDTH: u32 = {width}u;\nconst TILE_HEIGHT: u32 = {height}u;\n\
             const TILE_SAMPLES: u32 = {samples}u;\n"
        );
        let parts = [fragment!("film"), fragment!("ledger"), &tile, fragment!("render")];
        self.tracing() + &parts.join("\n")
    }

    /// Everything up to `trace`: what the renderer and the probe share.
    fn tracing(&self) -> String {
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
            scatter,
            fragment!("trace"),
            "",
        ]
        .join("\n")
    }
}

/// Straight-line search. The shapes are loaded once a path and not once a segment, which
/// matters where a driver fetches uniforms lane by lane.
/// Factored spheres come first in the uniform buffer, each group in the order of the
/// file, and so each sphere's place follows from the forms.
fn unrolled(forms: &[Form]) -> String {
    let mut factored = 0..;
    let mut anchored = forms.iter().filter(|&&form| form == Form::Factored).count()..;
    let places: Vec<(&str, usize)> = forms
        .iter()
        .filter_map(|form| match form {
            Form::Factored => Some(("factored", factored.next()?)),
            Form::Anchored => Some(("anchored", anchored.next()?)),
        })
        .collect();
    let lines = |line: &dyn Fn(&str, usize) -> String| -> String {
        places.iter().map(|&(form, i)| line(form, i)).collect()
    };
    let variables = lines(&|_, i| format!("var<private> shape_{i}: Shape;\n"));
    let loads = lines(&|_, i| format!("    shape_{i} = shape_of({i}u);\n"));
    let steps = lines(&|form, i| {
        format!("    best = closer_{form}(best, ray, shape_{i}, {i}u, leaving);\n")
    });
    format!(
        "// A few spheres: one statement each, in the order of the scene file, so that a\n\
         // strict comparison leaves the lowest index.\n\n\
         {variables}\n\
         fn load_shapes() {{\n{loads}}}\n\n\
         // `leaving` is the sphere that the ray starts on.\n\
         fn nearest(ray: Ray, leaving: u32) -> Hit {{\n    \
         var best = Hit(MISS, NO_SPHERE);\n{steps}    return best;\n}}\n"
    )
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
        effects: Effects::ALL,
        nearest: Nearest::Loop,
    };
    kernel.tracing() + &[fragment!("film"), fragment!("probe")].join("\n")
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
