//! A proven bound on one sample, from which the film takes its scale.

use crate::film::SampleScale;
use crate::scene::{Invalid, Scene, Surface};

/// Room for the rounding of the kernel's `f32` products: 16 roundings per scattering
/// (the norms of mirror and frame, the cosine, albedo and throughput).
const ROUNDING: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// The film's step must not exceed this fraction of the brightest light.
const COARSEST: f64 = 1e-6;

/// The finest film scale that holds every sample of the scene.
///
/// A path's sample is the product of its weights and the radiance of the one light it
/// ends on, so it is at most L·max(1, w)^bounces with w the largest weight: 2ρ for a
/// uniformly sampled diffuse surface (2ρcosθ), ρ for a Phong lobe (ρcosθ).
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
    let light = brightest(scene);
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

fn scale_at(scene: &Scene, bounces: u32) -> SampleScale {
    let brightest = brightest(scene);
    if brightest == 0.0 {
        return SampleScale::from_bound(1.0);
    }
    let weights = (largest_weight(scene) * ROUNDING).powi(bounces.cast_signed());
    SampleScale::from_bound(brightest * weights * ROUNDING)
}

fn brightest(scene: &Scene) -> f64 {
    let radiance = scene.spheres().iter().filter_map(|sphere| match sphere.surface() {
        Surface::Emitter(radiance) => Some(radiance.rgb().max_element()),
        _ => None,
    });
    radiance.fold(0.0, f64::max)
}

fn largest_weight(scene: &Scene) -> f64 {
    let weights = scene.spheres().iter().filter_map(|sphere| match sphere.surface() {
        Surface::Diffuse(albedo) => Some(2.0 * albedo.rgb().max_element()),
        _ => None,
    });
    weights.fold(1.0, f64::max)
}
