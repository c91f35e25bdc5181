//! The report of a study: `cost.csv`, `cost.svg`, `cost.png` and `cost.html`.

pub(crate) mod cells;
mod csv;
mod html;
mod plot;
mod reading;

pub use reading::Answer;

use super::{FileError, atomic, check_writable, png};
use crate::cost::Study;
use crate::tracer::Description;
use std::fs::File;
use std::io::{Read, Write};
use std::path::{Path, PathBuf};

/// What the files that candor may replace have in their first part.
const MARK: &str = "candor cost";

/// The mark is looked for in so many bytes.
const MARK_WITHIN: u64 = 4096;

/// Names of the files.
pub const FILES: [&str; 4] = ["cost.csv", "cost.html", "cost.svg", "cost.png"];

/// A study and where it comes from.
#[derive(Debug, Clone, Copy)]
pub struct CostReport<'a> {
    /// File name of the scene, without folders.
    pub scene: &'a str,
    /// The device.
    pub tracer: &'a Description,
    /// What was measured.
    pub study: &'a Study,
}

impl CostReport<'_> {
    /// The questions that a study is made for, and its answers.
    #[must_use]
    pub fn answers(&self) -> Vec<Answer> {
        reading::answers(self.study)
    }

    /// Writes [`FILES`] into a folder and returns their paths.
    ///
    /// # Errors
    /// If one cannot be written; one that was there is then untouched.
    pub fn write(&self, folder: &Path) -> Result<Vec<PathBuf>, FileError> {
        let paths = FILES.map(|name| folder.join(name));
        let [csv_path, html_path, svg_path, png_path] = &paths;
        let fail = |path: &Path, error: String| FileError::new(path, &error);
        let svg = plot::svg(self.study).map_err(|error| fail(svg_path, error))?;
        let pixels = plot::pixels(self.study).map_err(|error| fail(png_path, error))?;
        let table = csv::table(self).map_err(|error| fail(csv_path, error))?;
        let page = html::page(self, &svg).map_err(|error| fail(html_path, error))?;
        write_bytes(csv_path, &table)?;
        write_bytes(html_path, page.as_bytes())?;
        write_bytes(svg_path, svg.as_bytes())?;
        png::write_plot(png_path, &pixels, plot::SIZE_PNG, MARK)?;
        Ok(paths.to_vec())
    }
}

fn write_bytes(path: &Path, bytes: &[u8]) -> Result<(), FileError> {
    atomic::replace(path, |file| file.write_all(bytes).map_err(|error| error.to_string()))
}

/// Checks that the files can be written into a folder, before work starts.
///
/// # Errors
/// If the folder is missing or not writable, or a file is in the way that is not a report of
/// candor's.
pub fn check_folder(folder: &Path) -> Result<(), FileError> {
    if !folder.is_dir() {
        return Err(FileError::new(folder, &"is not a folder that exists"));
    }
    for path in FILES.map(|name| folder.join(name)) {
        check_writable(&path)?;
        let mut start = Vec::new();
        match File::open(&path) {
            Err(error) if error.kind() == std::io::ErrorKind::NotFound => continue,
            opened => opened
                .and_then(|file| file.take(MARK_WITHIN).read_to_end(&mut start))
                .map_err(|error| FileError::new(&path, &error))?,
        };
        if !start.windows(MARK.len()).any(|window| window == MARK.as_bytes()) {
            return Err(FileError::new(
                &path,
                &"is in the way, and not a report of candor's; move it, or name another folder \
                  with -o",
            ));
        }
    }
    Ok(())
}
