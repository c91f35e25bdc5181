//! Where the files of a render or a merge go, and what is already there.

use super::args::WriteArgs;
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
    /// Where checkpoints go, if not to the film that keeps the state.
    aside: Option<PathBuf>,
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
        let outputs = Self { files, wishes, aside: None };
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
        match self.in_the_way(identity, samples)? {
            None => Ok(()),
            Some((path, why)) => {
                refuse(format_args!("{} holds {why}; --force replaces it", path.display()))
            }
        }
    }

    /// Where checkpoints go: to the film that keeps the state, unless another one is there that
    /// is not gone on from, and is replaced by a finished render only.
    pub fn checkpoint(&mut self, resumed: bool) -> Result<Option<PathBuf>, Refusal> {
        let Some(path) = self.state() else { return Ok(None) };
        if resumed || look_at(path)? == There::Nothing {
            return Ok(Some(path.to_owned()));
        }
        self.aside = Some(beside(path)?);
        Ok(self.aside.clone())
    }

    /// Writes all files that can be written and returns where they are, and what is wrong with the
    /// first of the others. Where a film that holds more or other samples than this render came
    /// to is in the way (it was interrupted, or its time was up), that one is left alone and all
    /// files go beside, under the next free number.
    pub fn write(
        &self,
        picture: &Picture,
        film: &Film,
        provenance: &Provenance,
    ) -> Result<(Vec<PathBuf>, Option<Refusal>), Refusal> {
        let better = self.in_the_way(Some(&provenance.origin.identity), film.samples())?;
        if let (Some((path, why)), false) = (&better, self.wishes.quiet) {
            streams::message(&format!("{} holds {why}, and stays as it is", path.display()));
        }
        let sums = if self.wishes.no_state { Sums::LeftOut } else { Sums::Compact(film) };
        let (mut written, mut failed) = (Vec::new(), None);
        for (path, format) in &self.files {
            let path = match (&better, &self.aside) {
                (None, _) => path.clone(),
                (Some(_), Some(aside)) if Some(path.as_path()) == self.state() => aside.clone(),
                (Some(_), _) => beside(path)?,
            };
            let result = match format {
                Format::Png => {
                    report::write_png(&path, picture, self.wishes.exposure).map_err(Refusal::from)
                }
                Format::Exr => report::write_exr(&path, picture, sums, provenance)
                    .map_err(|error| rescued(error, &path, picture, film, provenance)),
            };
            match result {
                Ok(()) => written.push(path),
                Err(refusal) => failed = failed.or(Some(refusal)),
            }
        }
        let aside = self.aside.as_ref().filter(|aside| !written.contains(aside));
        if let Some(aside) = aside.filter(|_| failed.is_none()) {
            // Nothing is there where the render was too short for a checkpoint.
            let _ = std::fs::remove_file(aside);
        }
        Ok((written, failed))
    }

    /// A film in the way, and what it holds: more samples than these, or others of the same
    /// picture.
    fn in_the_way(
        &self,
        identity: Option<&Identity>,
        samples: &SampleRanges,
    ) -> Result<Option<(&Path, String)>, Refusal> {
        if self.wishes.force {
            return Ok(None);
        }
        for path in self.films() {
            let There::Film { samples: there, provenance } = look_at(path)? else { continue };
            let ours = samples.count();
            if there > ours {
                let why = format!("{there} samples per pixel, more than the {ours} of this render");
                return Ok(Some((path, why)));
            }
            let same = provenance.filter(|there| Some(&there.origin.identity) == identity);
            if let Some(others) = same.filter(|there| !samples.contains(&there.samples)) {
                let why = format!("samples {} of the same picture", others.samples);
                return Ok(Some((path, why)));
            }
        }
        Ok(None)
    }
}

/// What is said of a film that cannot be written where it should be: it goes to the system's
/// folder for temporary files, so that its samples are not lost.
fn rescued(
    error: FileError,
    path: &Path,
    picture: &Picture,
    film: &Film,
    provenance: &Provenance,
) -> Refusal {
    let name = path.file_name().unwrap_or_default();
    let Ok(elsewhere) = beside(&std::env::temp_dir().join(name)) else { return error.into() };
    match report::write_exr(&elsewhere, picture, Sums::Compact(film), provenance) {
        Ok(()) => Refusal(format!("error: {error}\nthe film is in {}", elsewhere.display())),
        Err(_) => error.into(),
    }
}

/// The first of `box.1.exr`, `box.2.exr`, … that is not there yet.
fn beside(path: &Path) -> Result<PathBuf, Refusal> {
    let stem = path.file_stem().unwrap_or_default();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    let mut names =
        (1..=u32::MAX).map(|i| path.with_file_name(named(stem, &format!("{i}.{ending}"))));
    match names.find(|name| !name.exists()) {
        Some(free) => Ok(free),
        None => refuse(format_args!("{}: every name beside it is taken", path.display())),
    }
}

/// The ending is added, not exchanged: `box.1.toml` makes `box.1.exr`, not `box.exr`.
fn named(stem: &OsStr, ending: &str) -> PathBuf {
    let mut name = stem.to_owned();
    name.push(".");
    name.push(ending);
    PathBuf::from(name)
}

fn format_of(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_lowercase().as_str() {
        "exr" => Some(Format::Exr),
        "png" => Some(Format::Png),
        _ => None,
    }
}
