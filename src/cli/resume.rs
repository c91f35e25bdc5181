//! `--resume`: the film that a render goes on from.

use super::args::{EstimatorChoice, RenderArgs};
use super::place::left_beside;
use super::{Refusal, refuse};
use crate::bound::{self, sample_scale};
use crate::film::Identity;
use crate::report::{StoredFilm, There, look_at};
use crate::scene::Scene;
use std::path::Path;

/// The film in `path`, known by its header, and the scene with the film's estimator if the choice
/// was left to candor. Nothing there: the render starts.
pub(super) fn open(
    path: &Path,
    mut scene: Scene,
    args: &RenderArgs,
) -> Result<(Scene, Option<StoredFilm>), Refusal> {
    if look_at(path)? == There::Nothing {
        return Ok((scene, None));
    }
    let film = StoredFilm::open(path)?;
    let theirs = &film.provenance.origin.identity;
    if args.sampling.estimator == Some(EstimatorChoice::Auto) {
        scene = scene.clone().with_settings(scene.settings().with_estimator(theirs.estimator));
        bound::check(&scene)?;
    }
    let ours = Identity::of(&scene, sample_scale(&scene));
    if let Err(difference) = ours.check(theirs) {
        let hint = left_beside(path, &ours).map_or_else(
            || "-o names another file".to_owned(),
            |other| format!("-o {} goes on from another film, of this render", other.display()),
        );
        return refuse(format_args!(
            "{}: cannot be resumed: the {}; it stays as it is, and {hint}",
            path.display(),
            difference.between("in this render", "in the film")
        ));
    }
    Ok((scene, Some(film)))
}
