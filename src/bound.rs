//! A proven bound on one sample, from which the film takes its scale.

use crate::film::SampleScale;
use crate::light_tree::SCANNED_LIGHTS;
use crate::scene::{Estimator, Invalid, Scene, Surface};

/// Room for the rounding of the kernel's `f32` products: 16 roundings per scattering
/// (the norms of mirror and frame, the cosine, albedo and throughput).
const ROUNDING: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// Room for the rounding of a sampled light's share: 256 roundings, where the cone, the
/// cosine and the chance of the light take about 40.
const CONNECTION_ROUNDING: f64 = 1.0 + 1.0 / (1 << 16) as f64;

/// The film's step must not exceed this fraction of the brightest light.
const COARSEST: f64 = 1e-6;

/// The finest film scale that holds every sample of the scene.
///
/// With L the brightest radiance, ρ the largest albedo, β that of diffuse surfaces, and K
/// bounces, a sample is at most
///
/// - `implicit`: L·max(1, w)^K, w the largest weight, 2β or ρ: it is the product of
///   its weights and the radiance of the one light that the path ends on.
/// - `cosine`: L, as no weight exceeds 1.
/// - `explicit`: max(L, S + ρL) with S = Σ_{k=1..K} ρ^{k−1}·C the connections and then a light
///   seen from a glossy surface. A connection is 2βh·cosθ·L/chance with h ≤ 1, so
///   C = 2βL for one light. Of several that are scanned, each has at least half the chance
///   that is proportional to h·cosθ·L, so C = 4β·ΣL. Of n under a tree, each is only known to
///   have half of an even chance, so C = 4βnL.
/// - `mis`: max(L, Σ_{k=1..K} ½ρ^k·L + ρL): the power heuristic keeps a connection below ½ρL
///   at its vertex, and a light that is hit below ρL.
///
/// (DESIGN.md, "The bound on one sample".)
#[must_use]
pub fn sample_scale(scene: &Scene) -> SampleScale {
    scale_at(scene, scene.settings().bounces())
}

/// Checks that the film resolves the scene's picture: the bound grows with every bounce,
/// and the film holds 64 bits of it.
///
/// # Errors
/// If a film step would exceed 1e-6 of the brightest light; how many bounces would do.
pub fn check(scene: &Scene) -> Result<(), Invalid> {
    let light = Bounds::of(scene).brightest;
    let resolves = |&bounces: &u32| scale_at(scene, bounces).step() <= COARSEST * light;
    let bounces = scene.settings().bounces();
    if light == 0.0 || resolves(&bounces) {
        return Ok(());
    }
    let most = (0..bounces).rev().find(resolves).unwrap_or(0);
    Err(Invalid(format!(
        "{bounces} bounces among surfaces this bright could make one sample so large that the \
         film had no digits left for the others; with the {} estimator this scene takes at most \
         {most}",
        scene.settings().estimator().name()
    )))
}

/// What bounds a scene's samples.
struct Bounds {
    /// Brightest channel of a light.
    brightest: f64,
    /// Sum of the lights' brightest channels, and how many lights there are.
    lights: (f64, usize),
    /// Largest albedo of a diffuse surface.
    diffuse: f64,
    /// Largest albedo.
    albedo: f64,
}

impl Bounds {
    fn of(scene: &Scene) -> Self {
        let mut bounds = Self { brightest: 0.0, lights: (0.0, 0), diffuse: 0.0, albedo: 0.0 };
        for sphere in scene.spheres() {
            match sphere.surface() {
                Surface::Emitter(radiance) => {
                    let radiance = radiance.rgb().max_element();
                    bounds.brightest = bounds.brightest.max(radiance);
                    bounds.lights = (bounds.lights.0 + radiance, bounds.lights.1 + 1);
                }
                Surface::Diffuse(albedo) => {
                    bounds.diffuse = bounds.diffuse.max(albedo.rgb().max_element());
                }
                Surface::Glossy(albedo, _) => {
                    bounds.albedo = bounds.albedo.max(albedo.rgb().max_element());
                }
            }
        }
        bounds.albedo = bounds.albedo.max(bounds.diffuse);
        bounds
    }

    /// The bound on one connection to a light, over the throughput before it.
    fn connection(&self, estimator: Estimator) -> f64 {
        match (estimator, self.lights) {
            (Estimator::Mis, _) => 0.5 * self.albedo * self.brightest,
            (_, (_, 1)) => 2.0 * self.diffuse * self.brightest,
            (_, (sum, 0..=SCANNED_LIGHTS)) => 4.0 * self.diffuse * sum,
            #[expect(clippy::cast_precision_loss, reason = "a count of spheres")]
            (_, (_, count)) => 4.0 * self.diffuse * count as f64 * self.brightest,
        }
    }
}

fn scale_at(scene: &Scene, bounces: u32) -> SampleScale {
    let bounds = Bounds::of(scene);
    if bounds.brightest == 0.0 {
        return SampleScale::from_bound(1.0);
    }
    let estimator = scene.settings().estimator();
    let largest = match estimator {
        Estimator::Implicit => {
            let weight = bounds.albedo.max(2.0 * bounds.diffuse).max(1.0);
            bounds.brightest * weight.powi(bounces.cast_signed())
        }
        Estimator::Cosine => bounds.brightest,
        Estimator::Explicit | Estimator::Mis => {
            let throughputs = (0..bounces.cast_signed()).map(|k| bounds.albedo.powi(k));
            let connections = throughputs.sum::<f64>() * bounds.connection(estimator);
            let connected = connections * CONNECTION_ROUNDING + bounds.albedo * bounds.brightest;
            connected.max(bounds.brightest)
        }
    };
    SampleScale::from_bound(largest * ROUNDING.powi(bounces.cast_signed() + 1))
}
