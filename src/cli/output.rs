//! Where a render's files go, and what is already there.

use super::args::RenderArgs;
use super::{Refusal, refuse};
use crate::report::{self, Picture, Provenance};
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
}

impl Outputs {
    /// The files that the user asked for, checked before work starts.
    pub fn new(args: &RenderArgs) -> Result<Self, Refusal> {
        let mut paths = args.output.clone();
        if paths.is_empty() {
            let stem = args.common.scene.file_stem().unwrap_or_default();
            paths = ["exr", "png"].map(|ending| Path::new(stem).with_extension(ending)).to_vec();
        }
        let mut files = Vec::new();
        for path in paths {
            let Some(format) = format_of(&path) else {
                return refuse(format_args!(
                    "{}: the ending says the format; it must be .exr or .png",
                    path.display()
                ));
            };
            report::check_writable(&path)?;
            files.push((path, format));
        }
        Ok(Self { files, force: args.force })
    }

    /// Refuses to replace a film that holds more than `samples` samples per pixel.
    pub fn check_films(&self, samples: u64) -> Result<(), Refusal> {
        for (path, format) in &self.files {
            if *format == Format::Exr && !self.force {
                let there = report::film_samples(path)?;
                if there > samples {
                    return refuse(format_args!(
                        "{} holds {there} samples per pixel, more than the {samples} of this \
                         render; --force replaces it",
                        path.display()
                    ));
                }
            }
        }
        Ok(())
    }

    /// Writes all files and returns where they are. A film with more samples than this
    /// render came to (it was interrupted, or its time was up) is left alone, and the
    /// new one goes beside it.
    pub fn write(
        &self,
        picture: &Picture,
        provenance: &Provenance,
        exposure: f64,
    ) -> Result<Vec<PathBuf>, Refusal> {
        let mut written = Vec::new();
        for (path, format) in &self.files {
            match format {
                Format::Png => {
                    report::write_png(path, picture, exposure)?;
                    written.push(path.clone());
                }
                Format::Exr => {
                    let path = self.beside_a_better_film(path, provenance.samples.count())?;
                    report::write_exr(&path, picture, provenance)?;
                    written.push(path);
                }
            }
        }
        Ok(written)
    }

    fn beside_a_better_film(&self, path: &Path, samples: u64) -> Result<PathBuf, Refusal> {
        if self.force || report::film_samples(path)? <= samples {
            return Ok(path.to_owned());
        }
        let stem = path.file_stem().unwrap_or_default().to_string_lossy();
        let mut beside = (1..=u32::MAX).map(|i| path.with_file_name(format!("{stem}.{i}.exr")));
        match beside.find(|beside| !beside.exists()) {
            Some(free) => Ok(free),
            None => refuse(format_args!("{}: every name beside it is taken", path.display())),
        }
    }
}

fn format_of(path: &Path) -> Option<Format> {
    match path.extension()?.to_str()?.to_lowercase().as_str() {
        "exr" => Some(Format::Exr),
        "png" => Some(Format::Png),
        _ => None,
    }
}
