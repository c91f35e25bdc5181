//! Files that appear whole or not at all, and stay: a temporary file beside the target, flushed
//! to the disk, then renamed over it; then the folder is flushed, which holds the name.

use super::FileError;
use std::fs::{File, TryLockError};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use tempfile::{Builder, NamedTempFile};

/// Checks that files can be made in the folder of `path`, before work starts.
///
/// # Errors
/// If the folder is missing or not writable, or `path` is a folder itself.
pub fn check_writable(path: &Path) -> Result<(), FileError> {
    if path.is_dir() {
        return Err(FileError::new(path, &"is a folder, not a file"));
    }
    if path.metadata().is_ok_and(|there| !there.is_file()) {
        return Err(FileError::new(path, &"is no regular file"));
    }
    if !folder_of(path).is_dir() {
        let folder = folder_of(path).display();
        return Err(FileError::new(path, &format!("the folder {folder} does not exist")));
    }
    temporary(&target(path)).map(drop)
}

/// Writes a file by way of a temporary one in the same folder. A link stays, and what it leads to
/// is replaced.
///
/// # Errors
/// If writing fails; a file that was there is then untouched.
pub fn replace(
    path: &Path,
    write: impl FnOnce(&mut BufWriter<&File>) -> Result<(), String>,
) -> Result<(), FileError> {
    let fail = |reason: String| FileError::new(path, &format!("cannot be written: {reason}"));
    let path = &target(path);
    let file = temporary(path)?;
    let mut buffer = BufWriter::new(file.as_file());
    write(&mut buffer).map_err(fail)?;
    buffer.flush().map_err(|error| fail(error.to_string()))?;
    drop(buffer);
    file.as_file().sync_all().map_err(|error| fail(error.to_string()))?;
    keep_permissions(path, file.as_file());
    file.persist(path).map_err(|error| fail(error.error.to_string()))?;
    flush_folder(folder_of(path)).map_err(|error| fail(error.to_string()))
}

/// A locked file, whose name tells what it is to become. Those that killed processes have left
/// for the same target are taken away.
fn temporary(path: &Path) -> Result<NamedTempFile, FileError> {
    let prefix = prefix(path);
    sweep(folder_of(path), &prefix);
    let named = as_new(Builder::new().prefix(&prefix)).tempfile_in(folder_of(path));
    let file = named.map_err(|error| {
        // The whole error names the temporary file, which says nothing to the user.
        let system = error.raw_os_error().map(std::io::Error::from_raw_os_error);
        FileError::new(path, &format!("cannot be written: {}", system.unwrap_or(error)))
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
        // Some network file systems lock only what may be written.
        if let Ok(left) = File::options().write(true).open(entry.path())
            && left.try_lock().is_ok()
        {
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// Makes the renaming last. Windows neither needs nor allows it, nor do some file systems, and a
/// folder that may be written need not be readable.
#[cfg(unix)]
fn flush_folder(folder: &Path) -> std::io::Result<()> {
    use std::io::ErrorKind::{InvalidInput, PermissionDenied, Unsupported};
    match File::open(folder).and_then(|folder| folder.sync_all()) {
        Err(error) if !matches!(error.kind(), InvalidInput | PermissionDenied | Unsupported) => {
            Err(error)
        }
        _ => Ok(()),
    }
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

/// Where a link leads, through other links too; any other path is its own target.
fn target(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    // More links than the system follows are a circle: writing says so.
    for _ in 0..40 {
        let Ok(next) = std::fs::read_link(&target) else { break };
        target = folder_of(&target).join(next);
    }
    target
}

/// A file that takes the place of another one is as open to others as that was. Where this is
/// refused (some network file systems), it is as any new file, which is no reason to lose it.
fn keep_permissions(path: &Path, file: &File) {
    if let Ok(there) = path.metadata() {
        let _ = file.set_permissions(there.permissions());
    }
}

/// What a new file is to others, less what the process's mask takes.
#[cfg(unix)]
fn as_new<'a, 'b>(builder: &'b mut Builder<'a, 'a>) -> &'b mut Builder<'a, 'a> {
    use std::os::unix::fs::PermissionsExt;
    builder.permissions(std::fs::Permissions::from_mode(0o666))
}

#[cfg(not(unix))]
fn as_new<'a, 'b>(builder: &'b mut Builder<'a, 'a>) -> &'b mut Builder<'a, 'a> {
    builder
}
