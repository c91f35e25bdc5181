//! What a render leaves behind, in files: EXR, written and read, and PNG, each written whole or
//! not at all, and a log of the error.

mod atomic;
pub mod cost;
mod difference;
mod exr;
mod log;
mod picture;
mod png;

pub use atomic::{check_writable, replace};
pub use difference::{FULL_COLOUR, write as write_difference};
pub use exr::{
    NextLook, Origin, PictureHeader, Provenance, Spent, StoredFilm, StoredPicture, Sums, There,
    look_at, write as write_exr,
};
pub use log::ErrorLog;
pub use picture::Picture;
pub use png::write as write_png;

use std::path::{Path, PathBuf};

/// Why a file could not be read or written.
#[derive(Debug, thiserror::Error)]
#[error("{}: {reason}", path.display())]
pub struct FileError {
    /// The file.
    pub path: PathBuf,
    /// What the system or the file format says.
    pub reason: String,
}

impl FileError {
    pub(crate) fn new(path: &Path, reason: &impl ToString) -> Self {
        Self { path: path.to_owned(), reason: printable(&reason.to_string()) }
    }
}

/// Text that may come from a file, with U+FFFD for control characters, which could drive a
/// terminal.
fn printable(text: &str) -> String {
    text.replace(char::is_control, "\u{fffd}")
}
