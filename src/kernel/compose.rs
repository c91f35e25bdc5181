//! Composes the kernel's WGSL from the fragments in `shaders/`, by concatenation alone.

use super::pack::Packed;
use crate::effects::Effects;
use crate::scene::ImageSize;
use std::fmt::Write;

/// Scenes of up to this many spheres get straight-line code instead of a loop over
/// the spheres: lavapipe fetches a loop's operands lane by lane (BENCHMARKS.md, "Nearest hit").
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Nearest {
    /// A loop over the spheres, any number of them.
    Loop,
    /// One statement per sphere.
    Unrolled {
        /// Spheres in factored form.
        factored: usize,
        /// Spheres in anchored form.
        anchored: usize,
    },
}

impl Nearest {
    /// The search that suits a packed scene.
    #[must_use]
    pub fn of(packed: &Packed) -> Self {
        let (factored, anchored) = (packed.factored, packed.anchored);
        if factored + anchored <= UNROLLED_SPHERES {
            Self::Unrolled { factored, anchored }
        } else {
            Self::Loop
        }
    }

    fn wgsl(self) -> String {
        match self {
            Self::Loop => fragment!("nearest_loop").to_owned(),
            Self::Unrolled { factored, anchored } => unrolled(factored, anchored),
        }
    }
}

/// What one kernel is composed for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Kernel {
    /// The effects that it simulates.
    pub effects: Effects,
    /// How it searches for the nearest hit.
    pub nearest: Nearest,
    /// Shape of its workgroups.
    pub tile: Tile,
}

impl Kernel {
    /// The WGSL of the entry point `render`.
    #[must_use]
    pub fn wgsl(&self) -> String {
        let Tile { width, height, samples } = self.tile;
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
        [
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

    /// Loop iterations that one sample may take, over all loops together.
    #[must_use]
    pub fn loop_iterations(&self, bounces: u32, spheres: u32) -> u64 {
        let segments = u64::from(bounces) + 1;
        match self.nearest {
            Nearest::Loop => segments * (u64::from(spheres) + 1),
            Nearest::Unrolled { .. } => segments,
        }
    }
}

fn unrolled(factored: usize, anchored: usize) -> String {
    let mut text = String::from(
        "// `leaving` is the sphere that the ray starts on.\n\
         fn nearest(ray: Ray, leaving: u32) -> Hit {\n\
         \x20   var small = Hit(MISS, NO_SPHERE);\n\
         \x20   var large = Hit(MISS, NO_SPHERE);\n",
    );
    let mut line = |best: &str, form: &str, i: usize| {
        writeln!(text, "    {best} = closer_{form}({best}, ray, {i}u, leaving);")
            .expect("a String takes any text");
    };
    (0..factored).for_each(|i| line("small", "factored", i));
    (factored..factored + anchored).for_each(|i| line("large", "anchored", i));
    text + "    return first_of(small, large);\n}\n"
}

/// The WGSL of the probe: entry points that run single functions of the kernel over a
/// table of inputs, for the tests.
#[must_use]
pub fn probe_source() -> String {
    let tile = Tile { width: 8, height: 8, samples: 1 };
    let kernel = Kernel { effects: Effects::ALL, nearest: Nearest::Loop, tile };
    kernel.tracing() + &[fragment!("film"), fragment!("probe")].join("\n")
}

/// Parses and validates WGSL as wgpu would, with the features that candor asks for.
///
/// # Errors
/// naga's message, with the place in the source.
pub fn validate(source: &str) -> Result<naga::Module, String> {
    let module =
        naga::front::wgsl::parse_str(source).map_err(|error| error.emit_to_string(source))?;
    naga::valid::Validator::new(
        naga::valid::ValidationFlags::all(),
        naga::valid::Capabilities::empty(),
    )
    .validate(&module)
    .map_err(|error| error.emit_to_string(source))?;
    Ok(module)
}
