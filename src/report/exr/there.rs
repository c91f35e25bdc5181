//! What is at a path where a film is to be written.

use super::header::{Provenance, text};
use crate::report::FileError;
use exr::meta::MetaData;
use std::path::Path;

/// What is at a path.
#[derive(Debug, Clone, PartialEq)]
pub enum There {
    /// No file, or an empty one: nothing to lose.
    Nothing,
    /// Something that candor did not write, or a pipe or device.
    Foreign,
    /// A picture or film of candor's.
    Film {
        /// Samples per pixel.
        samples: u64,
        /// Where it comes from, as far as this version can tell.
        provenance: Option<Box<Provenance>>,
        /// Whether it holds the exact sums.
        sums: bool,
    },
}

/// Looks at the header of the file in `path`.
///
/// # Errors
/// If it is there, but cannot be opened.
pub fn look_at(path: &Path) -> Result<There, FileError> {
    match std::fs::metadata(path) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(There::Nothing),
        Err(error) => return Err(FileError::new(path, &error)),
        Ok(there) if !there.is_file() => return Ok(There::Foreign),
        Ok(there) if there.len() == 0 => return Ok(There::Nothing),
        Ok(_) => {}
    }
    std::fs::File::open(path).map_err(|error| FileError::new(path, &error))?;
    let Ok(meta) = MetaData::read_from_file(path, false) else { return Ok(There::Foreign) };
    let found = meta.headers.iter().find_map(|part| Some((part, text(part, "spp")?)));
    let Some((part, spp)) = found else { return Ok(There::Foreign) };
    let Ok(samples) = spp.parse() else { return Ok(There::Foreign) };
    let sums = text(part, "checksum").is_some();
    Ok(There::Film { samples, provenance: Provenance::read(part).ok().map(Box::new), sums })
}
