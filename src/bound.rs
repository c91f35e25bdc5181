//! A proven bound on one sample, from which the film takes its scale.

use crate::film::SampleScale;
use crate::scene::{Estimator, Scene, Surface};

/// Room for the rounding of the kernel's `f32` products: at most eight roundings per
/// scattering, two scatterings in 2⁻²⁰.
const ROUNDING: f64 = 1.0 + 1.0 / (1 << 20) as f64;

/// The finest film scale that holds every sample of the scene.
///
/// A path's sample is the product of its weights and the radiance of the one light it
/// ends on, so it is at most L·max(1, w)^bounces with w the largest weight: 2ρ for a
/// uniformly sampled diffuse surface (2ρcosθ), ρ for a Phong lobe (ρcosθ).
#[must_use]
pub fn sample_scale(scene: &Scene) -> SampleScale {
    let settings = scene.settings();
    let mut brightest = 0.0_f64;
    let mut weight = 1.0_f64;
    for sphere in scene.spheres() {
        match sphere.surface() {
            Surface::Emitter(radiance) => {
                brightest = brightest.max(radiance.rgb().max_element());
            }
            Surface::Diffuse(albedo) => match settings.estimator() {
                Estimator::Implicit => weight = weight.max(2.0 * albedo.rgb().max_element()),
            },
            Surface::Glossy(..) => {}
        }
    }
    let bounces = settings.bounces().cast_signed();
    if brightest == 0.0 {
        return SampleScale::from_bound(1.0);
    }
    SampleScale::from_bound(brightest * (weight * ROUNDING).powi(bounces) * ROUNDING)
}
