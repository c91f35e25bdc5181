//! Where a render's files go, and what is already there.

use super::args::RenderArgs;
use super::{Refusal, refuse, streams};
use crate::report::{self, Picture, Provenance};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// A format, told by the file name's ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Format {
    Exr,
    Png,
}

/// The files of one render.
#[derive(Debug)]
pub(super) struct Outputs {
    files: Vec<(PathBuf, Format)>,
    force: bool,
    quiet: bool,
}

impl Outputs {
    /// The files that the user asked for, checked before work starts.
    pub fn new(args: &RenderArgs) -> Result<Self, Refusal> {
        let mut paths = args.output.clone();
        if paths.is_empty() {
            let stem = args.scene.file_stem().unwrap_or_default();
            paths = ["exr", "png"].map(|ending| named(stem, ending)).to_vec();
        }
        let mut files = Vec::new();
        for path in paths {
            let Some(format) = format_of(&path) else {
                return refuse(format_args!(
                    "{}: the ending says the format; it must be .exr or .png",
                    path.display()
                ));
            };
            if files.iter().any(|(other, _)| *other == path) {
                return refuse(format_args!("{}: named twice", path.display()));
            }
            report::check_writable(&path)?;
            let is_foreign = format == Format::Exr && report::film_samples(&path)?.is_none();
            if is_foreign && !args.force {
                return refuse(format_args!(
                    "{}: was not written by candor and stays as it is; --force replaces it, \
                     -o names another file",
                    path.display()
                ));
            }
            files.push((path, format));
        }
        Ok(Self { files, force: args.force, quiet: args.common.quiet })
    }

    /// Whether a file is one of them.
    pub fn contains(&self, file: &Path) -> bool {
        self.files.iter().any(|(path, _)| path == file)
    }

    /// Refuses to replace a film that holds more than `samples` samples per pixel.
    pub fn check_films(&self, samples: u64) -> Result<(), Refusal> {
        match self.better_film(samples)? {
            None => Ok(()),
            Some((path, there)) => refuse(format_args!(
                "{} holds {there} samples per pixel, more than the {samples} of this render; \
                 --force replaces it",
                path.display()
            )),
        }
    }

    /// Writes all files and returns where they are. Where a film with more samples than
    /// this render came to is in the way (it was interrupted, or its time was up), that
    /// one is left alone and all files go beside, under the next free number.
    pub fn write(
        &self,
        picture: &Picture,
        provenance: &Provenance,
        exposure: f64,
    ) -> Result<Vec<PathBuf>, Refusal> {
        let better = self.better_film(provenance.samples.count())?;
        if let (Some((path, there)), false) = (&better, self.quiet) {
            streams::message(&format!(
                "{} holds {there} samples per pixel, more than this render, and stays as it is",
                path.display()
            ));
        }
        let mut written = Vec::new();
        for (path, format) in &self.files {
            let path = if better.is_some() { beside(path)? } else { path.clone() };
            match format {
                Format::Png => report::write_png(&path, picture, exposure)?,
                Format::Exr => report::write_exr(&path, picture, provenance)?,
            }
            written.push(path);
        }
        Ok(written)
    }

    /// A film in the way that holds more than `samples` samples per pixel, and how many.
    fn better_film(&self, samples: u64) -> Result<Option<(&Path, u64)>, Refusal> {
        if self.force {
            return Ok(None);
        }
        for (path, _) in self.files.iter().filter(|(_, format)| *format == Format::Exr) {
            let there = report::film_samples(path)?.unwrap_or(0);
            if there > samples {
                return Ok(Some((path, there)));
            }
        }
        Ok(None)
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
