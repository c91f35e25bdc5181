//! The log of a render's error: a CSV file that grows while the picture is made.

use super::{FileError, check_writable, replace};
use crate::estimate::Summary;
use std::fs::File;
use std::io::{BufRead, BufReader, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

/// The first line, by which a log is known.
const HEADER: &str = "samples,seconds,relative_error,error_bound,luminance,unproven_pixels";

/// No log is longer than so many bytes, at a row of some 80 a second.
const LONGEST: u64 = 1 << 28;

/// A log under way. Columns: samples per pixel, seconds since the start, relative RMS error,
/// the upper bound on it (only at the counts that its confidence is spread over), mean
/// luminance, pixels without a hit. What is not known is empty.
#[derive(Debug)]
pub struct ErrorLog {
    path: PathBuf,
    file: File,
    last: u64,
}

impl ErrorLog {
    /// Begins a log, or goes on with that of a render of `begun` samples per pixel: its rows up
    /// to there stay. Of the files that are there, only an older log or an empty file is replaced.
    ///
    /// # Errors
    /// If another file is there, or none can be written.
    pub fn create(path: &Path, begun: u64) -> Result<Self, FileError> {
        if !may_replace(path)? {
            return Err(FileError::new(path, &"is no error log of candor, and stays as it is"));
        }
        let fail = |error| failed(path, &error);
        let rows = rows(path, begun).map_err(fail)?;
        if let Some(last) = rows.last().and_then(|row| samples(row)) {
            let text = format!("{HEADER}\n{}", rows.concat());
            replace(path, |file| file.write_all(text.as_bytes()).map_err(|e| e.to_string()))?;
            let file = File::options().append(true).open(path).map_err(fail)?;
            return Ok(Self { path: path.to_owned(), file, last });
        }
        let mut file = File::create(path).map_err(fail)?;
        writeln!(file, "{HEADER}").map_err(fail)?;
        Ok(Self { path: path.to_owned(), file, last: 0 })
    }

    /// Adds a row, unless the last one has as many samples.
    ///
    /// # Errors
    /// If it cannot be written.
    pub fn add(&mut self, summary: &Summary, elapsed: Duration) -> Result<(), FileError> {
        if summary.samples == self.last {
            return Ok(());
        }
        self.last = summary.samples;
        let known = |value: Option<f64>| value.map_or(String::new(), |value| value.to_string());
        let row = format!(
            "{},{:.3},{},{},{},{}\n",
            summary.samples,
            elapsed.as_secs_f64(),
            known(summary.relative_error),
            known(summary.error_bound),
            summary.luminance,
            summary.unproven_pixels
        );
        // In one piece, so that whoever reads along never sees half a row.
        self.file.write_all(row.as_bytes()).map_err(|error| failed(&self.path, &error))
    }
}

/// The rows of a log, each with its line end, that are of at most `begun` samples per pixel. The
/// last may have been cut short, and is left out then.
fn rows(path: &Path, begun: u64) -> std::io::Result<Vec<String>> {
    if begun == 0 || !path.is_file() {
        return Ok(Vec::new());
    }
    let text = std::fs::read_to_string(path)?;
    let rows = text.split_inclusive('\n').skip(1).filter(|row| row.ends_with('\n'));
    let earlier = rows.filter(|row| samples(row).is_some_and(|count| count <= begun));
    Ok(earlier.map(str::to_owned).collect())
}

/// The first column of a row.
fn samples(row: &str) -> Option<u64> {
    row.split(',').next()?.parse().ok()
}

fn may_replace(path: &Path) -> Result<bool, FileError> {
    match path.metadata() {
        Err(error) if error.kind() == ErrorKind::NotFound => {
            return check_writable(path).map(|()| true);
        }
        Err(error) => return Err(failed(path, &error)),
        Ok(there) if there.is_dir() => return check_writable(path).map(|()| false),
        // A pipe or a terminal has nothing to lose.
        Ok(there) if !there.is_file() => return Ok(true),
        Ok(_) => {}
    }
    let file = File::open(path).map_err(|error| failed(path, &error))?;
    if file.metadata().map_err(|error| failed(path, &error))?.len() > LONGEST {
        return Ok(false);
    }
    for (number, line) in BufReader::new(file).split(b'\n').enumerate() {
        let line = line.map_err(|error| failed(path, &error))?;
        if !(if number == 0 { line.trim_ascii_end() == HEADER.as_bytes() } else { is_row(&line) }) {
            return Ok(false);
        }
    }
    Ok(true)
}

/// Whether a line holds nothing but the numbers of a row.
fn is_row(line: &[u8]) -> bool {
    line.iter().all(|byte| byte.is_ascii_digit() || b".,-einf\r".contains(byte))
}

fn failed(path: &Path, error: &std::io::Error) -> FileError {
    FileError::new(path, &format!("cannot be written: {error}"))
}
