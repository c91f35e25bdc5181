//! What a render does unless the command line says otherwise.

use super::{Invalid, MAX_BOUNCES, MAX_SPP, refuse};

/// How paths are built; each estimator has the same mean.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Estimator {
    /// The source's: uniform hemisphere at diffuse surfaces, Phong lobe at glossy
    /// ones, light counted only where a path hits it by itself.
    #[default]
    Implicit,
    /// As `Implicit`, with cosine-weighted directions at diffuse surfaces.
    Cosine,
    /// Next-event estimation: lights are sampled by solid angle at diffuse surfaces; light
    /// that a path hits counts straight from the camera and from glossy surfaces.
    Explicit,
    /// Lights and the BRDF are sampled at every surface and combined with the power
    /// heuristic (Veach & Guibas, SIGGRAPH 1995, section 3.2).
    Mis,
}

impl Estimator {
    /// All of them, the source's first.
    pub const ALL: [Self; 4] = [Self::Implicit, Self::Cosine, Self::Explicit, Self::Mis];

    /// The name used in scene files, on the command line and in film headers.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Implicit => "implicit",
            Self::Cosine => "cosine",
            Self::Explicit => "explicit",
            Self::Mis => "mis",
        }
    }

    /// Whether lights are sampled where a path scatters.
    #[must_use]
    pub fn samples_lights(self) -> bool {
        matches!(self, Self::Explicit | Self::Mis)
    }
}

impl std::str::FromStr for Estimator {
    type Err = Invalid;

    fn from_str(name: &str) -> Result<Self, Invalid> {
        let found = Self::ALL.into_iter().find(|estimator| estimator.name() == name);
        found.map_or_else(|| refuse("\"implicit\", \"cosine\", \"explicit\" or \"mis\""), Ok)
    }
}

/// The `[render]` table: what a render does unless the command line says otherwise.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct RenderSettings {
    spp: u64,
    bounces: u32,
    estimator: Estimator,
    seed: u32,
}

impl Default for RenderSettings {
    fn default() -> Self {
        Self { spp: 256, bounces: 2, estimator: Estimator::Implicit, seed: 0 }
    }
}

impl RenderSettings {
    /// Replaces the samples per pixel.
    ///
    /// # Errors
    /// If `spp` is outside 1..=[`MAX_SPP`].
    pub fn with_spp(mut self, spp: u64) -> Result<Self, Invalid> {
        if !(1..=MAX_SPP).contains(&spp) {
            return refuse(format!("a whole number from 1 to {MAX_SPP}"));
        }
        self.spp = spp;
        Ok(self)
    }

    /// Replaces the most scatterings of one path.
    ///
    /// # Errors
    /// If `bounces` is above [`MAX_BOUNCES`].
    pub fn with_bounces(mut self, bounces: u32) -> Result<Self, Invalid> {
        if bounces > MAX_BOUNCES {
            return refuse(format!("a whole number from 0 to {MAX_BOUNCES}"));
        }
        self.bounces = bounces;
        Ok(self)
    }

    /// Replaces the estimator.
    #[must_use]
    pub fn with_estimator(mut self, estimator: Estimator) -> Self {
        self.estimator = estimator;
        self
    }

    /// Replaces the seed of the random numbers.
    #[must_use]
    pub fn with_seed(mut self, seed: u32) -> Self {
        self.seed = seed;
        self
    }

    /// Samples per pixel.
    #[must_use]
    pub fn spp(self) -> u64 {
        self.spp
    }

    /// Most scatterings of one path.
    #[must_use]
    pub fn bounces(self) -> u32 {
        self.bounces
    }

    /// The estimator.
    #[must_use]
    pub fn estimator(self) -> Estimator {
        self.estimator
    }

    /// Seed of the random numbers.
    #[must_use]
    pub fn seed(self) -> u32 {
        self.seed
    }
}
