//! Files that appear whole or not at all, and stay: a temporary file beside the target, flushed
//! to the disk, then renamed over it; then the folder is flushed, which holds the name.

use super::FileError;
use std::fs::{File, TryLockError};
use std::io::{BufWriter, Write};
use std::path::Path;
use tempfile::NamedTempFile;

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
    flush_folder(folder_of(path)).map_err(|error| fail(error.to_string()))
}

/// A locked file, whose name tells what it is to become. Those that killed processes have left
/// for the same target are taken away.
fn temporary(path: &Path) -> Result<NamedTempFile, FileError> {
    let prefix = prefix(path);
    sweep(folder_of(path), &prefix);
    let named = tempfile::Builder::new().prefix(&prefix).tempfile_in(folder_of(path));
    let file = named.map_err(|error| {
        // The whole error names the temporary file, which says nothing to the user.
        FileError::new(path, &format!("cannot be written: {}", error.kind()))
    })?;
    match file.as_file().try_lock() {
        // Another process took it for one that was left, and is about to take it away.
        Err(TryLockError::WouldBlock) => temporary(path),
        Ok(()) if !file.path().exists() => temporary(path),
        // Without locks (some network file systems), nothing is ever taken for left.
        Ok(()) | Err(TryLockError::Error(_)) => Ok(file),
    }
}

/// The beginning of the names of temporary files for a target. It holds the checksum of the
/// target's name in place of the name, which may be as long as names can be.
fn prefix(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default().as_encoded_bytes();
    format!(".candor-{:08x}-", crc32fast::hash(name))
}

/// Takes away temporary files that nobody holds a lock on. What cannot be taken away stays, which
/// is no reason not to write.
fn sweep(folder: &Path, prefix: &str) {
    let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_string_lossy().starts_with(prefix)) {
        if let Ok(left) = File::open(entry.path())
            && left.try_lock().is_ok()
        {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Makes the renaming last. Windows neither needs nor allows it.
#[cfg(unix)]
fn flush_folder(folder: &Path) -> std::io::Result<()> {
    File::open(folder)?.sync_all()
}

#[cfg(not(unix))]
fn flush_folder(_: &Path) -> std::io::Result<()> {
    Ok(())
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
