//! The files that a scene may read: which, and how much of them.

use std::fs::File;
use std::io::{self, ErrorKind, Read as _};
use std::path::Path;

use super::syntax::not_utf8;
use super::table::Field;
use super::{Diagnostic, Log};
use crate::scene::cloud::{Data, Format, Mistakes};
use crate::scene::error::quoted;

/// Most bytes of the data files of one scene together: some six million rows.
const MAX_BYTES: u64 = 512 << 20;
/// Most lines of the data files of one scene together; as spheres they take 1 GB.
const MAX_LINES: usize = 10_000_000;

/// What some programs write before a text in UTF-8.
const BYTE_ORDER_MARK: &[u8] = "\u{feff}".as_bytes();

/// The folder of a scene file, and how much may still be read from it.
pub(super) struct Folder<'a> {
    /// `None` if the scene comes from no file.
    path: Option<&'a Path>,
    bytes_left: u64,
    lines_left: usize,
}

impl<'a> Folder<'a> {
    pub(super) fn new(path: Option<&'a Path>) -> Self {
        Self { path, bytes_left: MAX_BYTES, lines_left: MAX_LINES }
    }

    /// The data file that `file` names, which may also be a pipe.
    pub(super) fn read(&mut self, file: &Field<'_>, format: Format, log: &mut Log) -> Option<Data> {
        let name = file.text(log)?;
        let wrong = |what: String| Diagnostic::new(file.value().span(), what);
        let Some(folder) = self.path else {
            log.push(
                wrong(format!("there is no folder in which to look for {}", quoted(name)))
                    .note("data files are read for a scene that is itself a file"),
            );
            return None;
        };
        let path = folder.join(name);
        let shown = path.display().to_string();
        let bytes =
            match read(&path, self.bytes_left) {
                Ok(Some(bytes)) => bytes,
                Ok(None) => {
                    let most = MAX_BYTES >> 20;
                    log.push(wrong(format!("{} is too large", quoted(name))).note(format!(
                        "the data files of a scene have at most {most} MiB together"
                    )));
                    return None;
                }
                Err(error) if error.kind() == ErrorKind::NotFound => {
                    log.push(
                        wrong(format!("there is no file {}", quoted(name)))
                            .label(format!("looked for as {shown}"))
                            .note("names of data files start in the folder of the scene file"),
                    );
                    return None;
                }
                Err(error) => {
                    log.push(wrong(format!("cannot read {}: {error}", quoted(name))));
                    return None;
                }
            };
        self.bytes_left -= bytes.len() as u64;
        self.counted(decoded(shown, bytes, format, log)?, file, name, log)
    }

    /// `data`, if no more lines were read than are allowed.
    fn counted(&mut self, data: Data, file: &Field<'_>, name: &str, log: &mut Log) -> Option<Data> {
        let Some(left) = self.lines_left.checked_sub(data.lines()) else {
            let wrong = format!("{} has too many lines, {}", quoted(name), data.lines());
            let most = format!("the data files of a scene have at most {MAX_LINES} lines together");
            log.push(Diagnostic::new(file.value().span(), wrong).note(most));
            return None;
        };
        self.lines_left = left;
        Some(data)
    }
}

/// The text of a data file.
fn decoded(shown: String, mut bytes: Vec<u8>, format: Format, log: &mut Log) -> Option<Data> {
    if bytes.starts_with(BYTE_ORDER_MARK) {
        bytes.drain(..BYTE_ORDER_MARK.len());
    }
    match String::from_utf8(bytes) {
        Ok(text) => Some(Data::new(shown, text, format)),
        Err(error) => {
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            let wrong = not_utf8(&error.utf8_error(), error.as_bytes());
            log.blame(&Data::new(shown, text, format), Mistakes::from(wrong));
            None
        }
    }
}

/// The bytes of a file; `None` if there are more than `limit`.
pub(super) fn read(path: &Path, limit: u64) -> io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    let length = file.metadata()?.len();
    if length > limit {
        return Ok(None);
    }
    // A pipe or device has no length to go by, and a file may be growing.
    let mut bytes = Vec::with_capacity(usize::try_from(length).unwrap_or(0) + 1);
    file.take(limit + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= limit).then_some(bytes))
}
