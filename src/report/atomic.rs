//! Files that appear whole or not at all: a temporary file beside the target, flushed
//! to the disk, then renamed over it.

use super::FileError;
use std::fs::File;
use std::io::{BufWriter, Write};
use std::path::Path;

/// Checks that files can be made in the folder of `path`, before work starts.
///
/// # Errors
/// If the folder is missing or not writable, or `path` is a folder itself.
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    if path.is_dir() {
        return Err(FileError::new(path, &"is a folder, not a file"));
    }
    if !folder_of(path).is_dir() {
        let folder = folder_of(path).display();
        return Err(FileError::new(path, &format!("the folder {folder} does not exist")));
    }
    temporary(path).map(drop)
}

/// Writes a file by way of a temporary one in the same folder.
///
/// # Errors
/// If writing fails; a file that was there is then untouched.
pub fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), String>,
) -> Result<(), FileError> {
    let file = temporary(path)?;
    let fail = |reason: String| FileError::new(path, &format!("cannot be written: {reason}"));
    let mut buffer = BufWriter::new(file.as_file());
    write(&mut buffer).map_err(fail)?;
    buffer.flush().map_err(|error| fail(error.to_string()))?;
    drop(buffer);
    file.as_file().sync_all().map_err(|error| fail(error.to_string()))?;
    allow_reading(file.as_file());
    file.persist(path).map_err(|error| fail(error.error.to_string()))?;
    Ok(())
}

fn temporary(path: &Path) -> Result<tempfile::NamedTempFile, FileError> {
    tempfile::Builder::new().prefix(".candor-").tempfile_in(folder_of(path)).map_err(|error| {
        // The whole error names the temporary file, which says nothing to the user.
        FileError::new(path, &format!("cannot be written: {}", error.kind()))
    })
}

fn folder_of(path: &Path) -> &Path {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent,
        _ => Path::new("."),
    }
}

/// A temporary file is private; a picture is not. Where this is refused (some network
/// file systems), the picture stays private, which is no reason to lose it.
#[cfg(unix)]
fn allow_reading(file: &File) {
    use std::os::unix::fs::PermissionsExt;
    let _ = file.set_permissions(std::fs::Permissions::from_mode(0o644));
}

#[cfg(not(unix))]
fn allow_reading(_: &File) {}
