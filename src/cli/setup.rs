//! From the scene file and the command line to the scene that is rendered.

use super::args::{CommonArgs, EstimatorChoice, SamplingArgs};
use super::{Refusal, in_colour, refuse};
use crate::bound;
use crate::range::{self, Arithmetic};
use crate::scene::{self, Scene, SceneFileError, Source};
use crate::viewpoint::Viewpoint;
use std::path::Path;

/// Loads the scene and applies what the command line says otherwise; where it leaves the
/// choice of an estimator to a pilot, the scene's stays for now.
pub(super) fn load(
    file: &Path,
    args: &CommonArgs,
    sampling: &SamplingArgs,
) -> Result<(Scene, Source), Refusal> {
    let (mut scene, source) = scene::load_with_source(file).map_err(in_words)?;
    if let Some(size) = args.size {
        scene = scene.with_size(size);
    }
    let mut settings = scene.settings();
    if let Some(spp) = sampling.spp {
        settings = settings.with_spp(spp)?;
    }
    if let Some(bounces) = args.bounces {
        settings = match settings.with_bounces(bounces) {
            Ok(settings) => settings,
            Err(allowed) => return refuse(format_args!("--bounces takes {allowed}")),
        };
    }
    settings = settings.with_seed(args.seed.unwrap_or(settings.seed()));
    if let Some(EstimatorChoice::Named(estimator)) = sampling.estimator {
        settings = settings.with_estimator(estimator);
    }
    let scene = scene.with_settings(settings);
    if sampling.estimator != Some(EstimatorChoice::Auto) {
        bound::check(&scene)?;
    }
    Ok((scene, source))
}

/// Refuses a scene that is outside of the range of what is to trace it.
pub(super) fn check_range(
    scene: &Scene,
    source: &Source,
    arithmetics: &[Arithmetic],
) -> Result<(), Refusal> {
    let viewpoint = Viewpoint::of(scene);
    for &arithmetic in arithmetics {
        range::check(scene, &viewpoint, arithmetic)
            .map_err(|out| in_words(source.complain(out.sphere, &out.what, &out.allowed)))?;
    }
    Ok(())
}

#[expect(clippy::needless_pass_by_value, reason = "for map_err")]
fn in_words(error: SceneFileError) -> Refusal {
    Refusal(error.render(in_colour()))
}
