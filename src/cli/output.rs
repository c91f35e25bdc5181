//! Where the files of a render or a merge go, and what is already there.

use super::args::WriteArgs;
use super::place::{InTheWay, Ours, Stamp, beside, in_the_way, is_part, named};
use super::{Refusal, refuse, streams};
use crate::film::{Film, Identity, SampleRanges};
use crate::report::{self, FileError, Picture, Provenance, Sums, There, look_at};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A format, told by the file name's ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
}

/// The files of one picture.
#[derive(Debug)]
pub(super) struct Outputs {
    files: Vec<(PathBuf, Format)>,
    wishes: Wishes,
    /// Whether it is of a render, which keeps its state.
    is_render: bool,
    /// What was there at the start, in the order of the files.
    at_start: Vec<Option<Stamp>>,
}

/// What the user wants of them.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wishes {
    /// Replace films that hold other samples.
    pub force: bool,
    /// Leave the exact sums out.
    pub no_state: bool,
    /// Say nothing.
    pub quiet: bool,
    /// Stops by which the PNG is brightened.
    pub exposure: f64,
}

impl Wishes {
    pub fn of(args: &WriteArgs, quiet: bool) -> Self {
        let &WriteArgs { exposure, no_state, force } = args;
        Self { force, no_state, quiet, exposure }
    }
}

impl Outputs {
    /// The files that the user asked for, checked before work starts. With a `stem`, what is left
    /// to candor is named after it: both, if none was asked for, and the film that keeps the
    /// state of a render to a PNG alone.
    pub fn new(asked: &[PathBuf], stem: Option<&OsStr>, wishes: Wishes) -> Result<Self, Refusal> {
        let mut files = Vec::new();
        for path in asked {
            let Some(format) = format_of(path) else {
                return refuse(format_args!(
                    "{}: the ending says the format; it must be .exr or .png",
                    path.display()
                ));
            };
            if files.iter().any(|(other, _)| other == path) {
                return refuse(format_args!("{}: named twice", path.display()));
            }
            files.push((path.clone(), format));
        }
        let has_film = files.iter().any(|&(_, format)| format == Format::Exr);
        if let Some(stem) = stem.filter(|_| !has_film) {
            if asked.is_empty() {
                files.push((named(stem, "png"), Format::Png));
            }
            if asked.is_empty() || !wishes.no_state {
                files.push((named(stem, "exr"), Format::Exr));
            }
        }
        // Films first: what is lost with a picture can be made from its film.
        files.sort_by_key(|&(_, format)| format != Format::Exr);
        let at_start = files.iter().map(|(path, _)| Stamp::of(path)).collect();
        let outputs = Self { files, wishes, is_render: stem.is_some(), at_start };
        outputs.check()?;
        Ok(outputs)
    }

    fn check(&self) -> Result<(), Refusal> {
        for (path, format) in &self.files {
            report::check_writable(path)?;
            let is_foreign = *format == Format::Exr && look_at(path)? == There::Foreign;
            if is_foreign && !self.wishes.force {
                return refuse(format_args!(
                    "{}: was not written by candor and stays as it is; --force replaces it, \
                     -o names another file",
                    path.display()
                ));
            }
        }
        Ok(())
    }

    /// Whether a file is one of them.
    pub fn contains(&self, file: &Path) -> bool {
        self.files.iter().any(|(path, _)| path == file)
    }

    /// The film that keeps the state, if one does.
    pub fn state(&self) -> Option<&Path> {
        let mut films = self.films();
        films.next().filter(|_| !self.wishes.no_state)
    }

    fn films(&self) -> impl Iterator<Item = &Path> {
        let films = self.files.iter().filter(|&&(_, format)| format == Format::Exr);
        films.map(|(path, _)| path.as_path())
    }

    /// Refuses to replace a film of which these samples are not all.
    pub fn check_films(
        &self,
        identity: Option<&Identity>,
        samples: &SampleRanges,
    ) -> Result<(), Refusal> {
        let Some((path, InTheWay { what, same_picture })) = self.in_the_way(identity, samples)?
        else {
            return Ok(());
        };
        let resume = if same_picture && self.is_render { "--resume goes on from it, " } else { "" };
        refuse(format_args!(
            "{} holds {what}; {resume}-o names another file, --force replaces it",
            path.display()
        ))
    }

    /// Writes all files that can be written and returns where they are, and what is wrong with the
    /// first of the others. Where something is in the way (a render was interrupted, or its time
    /// was up), that is left alone and all files go beside, under the next free number; the film
    /// that keeps the state to `aside`, if checkpoints went there.
    pub fn write(
        &self,
        picture: &Picture,
        film: &Film,
        provenance: &Provenance,
        aside: Option<&Path>,
    ) -> Result<(Vec<PathBuf>, Option<Refusal>), Refusal> {
        let better = self.in_the_way(Some(&provenance.origin.identity), film.samples());
        let better = match better {
            Ok(None) => None,
            Ok(Some((path, there))) => Some(format!("{} holds {}", path.display(), there.what)),
            // What cannot be looked at may be anything.
            Err(error) => Some(error.to_string()),
        };
        if let (Some(why), false) = (&better, self.wishes.quiet) {
            streams::message(&format!("{why}, and stays as it is"));
        }
        let sums = if self.wishes.no_state { Sums::LeftOut } else { Sums::Compact(film) };
        let (mut written, mut failed) = (Vec::new(), None);
        for (path, format) in &self.files {
            let path = match (&better, aside) {
                (None, _) => path.clone(),
                (Some(_), Some(aside)) if Some(path.as_path()) == self.state() => aside.to_owned(),
                (Some(_), _) => beside(path)?,
            };
            let result = match format {
                Format::Png => report::write_png(&path, picture, self.wishes.exposure),
                Format::Exr => report::write_exr(&path, picture, sums, provenance),
            };
            match result {
                Ok(()) => written.push(path),
                Err(error) => failed = failed.or(Some(error)),
            }
        }
        if let Some(aside) =
            aside.filter(|aside| failed.is_none() && !written.iter().any(|w| w == aside))
        {
            take_away(aside, &provenance.origin.identity, film.samples());
        }
        let has_film = written.iter().any(|path| format_of(path) == Some(Format::Exr));
        let failed = failed.map(|error| {
            if has_film || self.films().next().is_none() {
                error.into()
            } else {
                rescued(&error, picture, film, provenance)
            }
        });
        Ok((written, failed))
    }

    /// What is in the way, and where.
    fn in_the_way(
        &self,
        identity: Option<&Identity>,
        samples: &SampleRanges,
    ) -> Result<Option<(&Path, InTheWay)>, FileError> {
        if self.wishes.force {
            return Ok(None);
        }
        for ((path, format), at_start) in self.files.iter().zip(&self.at_start) {
            if *format != Format::Exr {
                continue;
            }
            let ours = Ours {
                identity,
                samples,
                has_sums: !self.wishes.no_state,
                came_later: Stamp::of(path) != *at_start,
            };
            if let Some(found) = in_the_way(path, &ours)? {
                return Ok(Some((path, found)));
            }
        }
        Ok(None)
    }
}

/// Takes the last checkpoint away, all of whose samples are in a film that is written. Nothing is
/// there where the render was too short for one, and another render's film may be: that stays.
fn take_away(checkpoint: &Path, identity: &Identity, samples: &SampleRanges) {
    if look_at(checkpoint).is_ok_and(|there| is_part(&there, identity, samples)) {
        let _ = std::fs::remove_file(checkpoint);
    }
}

/// What is said of a film that cannot be written where it should be: it goes to the system's folder
/// for temporary files or to the current one, so that its samples are not lost.
fn rescued(error: &FileError, picture: &Picture, film: &Film, provenance: &Provenance) -> Refusal {
    let name = error.path.file_name().unwrap_or_default();
    for folder in [std::env::temp_dir(), PathBuf::new()] {
        let Ok(elsewhere) = beside(&folder.join(name)) else { continue };
        if report::write_exr(&elsewhere, picture, Sums::Compact(film), provenance).is_ok() {
            return Refusal(format!("error: {error}\nthe film is in {}", elsewhere.display()));
        }
    }
    let tried = "nor in the folder for temporary files nor in the current one";
    Refusal(format!("error: {error}, {tried}: what was rendered since the last checkpoint is lost"))
}

fn format_of(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_lowercase().as_str() {
        "exr" => Some(Format::Exr),
        "png" => Some(Format::Png),
        _ => None,
    }
}
