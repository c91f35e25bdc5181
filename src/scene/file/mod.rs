//! Reads scene files: TOML text to a validated [`Scene`], with every mistake found.

mod clouds;
mod folder;
mod sections;
mod source;
mod spheres;
mod stray;
mod syntax;
mod table;

use std::panic::resume_unwind;
use std::path::Path;
use std::thread;

use toml::de::DeTable;

use folder::{Folder, read};
pub use source::Source;

use super::cloud::{Data, Mistakes};
use super::error::{Diagnostic, SceneFileError};
use super::{Invalid, Scene};

/// Most bytes of a scene file, enough for a hundred thousand spheres. While it is parsed, a
/// file takes 30 to 120 times its size in memory, by what is in it (BENCHMARKS.md, "What
/// hostile input costs").
const MAX_FILE_BYTES: u64 = 16 << 20;

/// Stack of the thread that reads a file. The TOML parser allows 80 parts in a dotted
/// key and 80 open brackets, so that tables may nest 6,500 deep, and builds and drops
/// them recursively: unoptimised, that takes between 2 and 8 MiB.
const STACK_BYTES: usize = 32 << 20;

/// Reads the scene file at `path`, which may also be a pipe, and the data files that it names.
///
/// # Errors
/// If the file cannot be read, is larger than 16 MiB, is not UTF-8 text, or is not a
/// valid scene; then with every mistake that it has. If it has none itself, of the first data
/// file that has some.
pub fn load(path: &Path) -> Result<Scene, SceneFileError> {
    load_with_source(path).map(|(scene, _)| scene)
}

/// Reads the scene file at `path`, and keeps its text and those of its data files.
///
/// # Errors
/// As [`load`].
pub fn load_with_source(path: &Path) -> Result<(Scene, Source), SceneFileError> {
    let bytes = read(path, MAX_FILE_BYTES)
        .map_err(|error| SceneFileError::Read { path: path.to_owned(), error })?
        .ok_or_else(|| SceneFileError::TooLarge { path: path.to_owned(), limit: MAX_FILE_BYTES })?;
    let name = path.display().to_string();
    match String::from_utf8(bytes) {
        Ok(text) => parse_with_source(&name, &text, Folder::new(path.parent())),
        Err(error) => {
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            let diagnostics = vec![syntax::not_utf8(&error.utf8_error(), error.as_bytes())];
            Err(SceneFileError::Invalid { name, text, diagnostics, others: 0 })
        }
    }
}

/// Reads the text of a scene file; `name` stands for the file in messages. No file is read, so
/// that a scene with `[[clouds]]` is refused.
///
/// # Errors
/// If the text is not a valid scene. A mistake in the TOML syntax is the only one
/// reported; otherwise every mistake is.
pub fn parse(name: &str, text: &str) -> Result<Scene, SceneFileError> {
    parse_with_source(name, text, Folder::new(None)).map(|(scene, _)| scene)
}

fn parse_with_source(
    name: &str,
    text: &str,
    folder: Folder<'_>,
) -> Result<(Scene, Source), SceneFileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    with_deep_stack(|| read_text(name, text, folder)).map_err(|log| log.refuse(name, text))
}

/// Runs `read` on a stack that no file can overflow.
fn with_deep_stack<T: Send>(read: impl FnOnce() -> T + Send) -> T {
    // A fuzzer reads a thousand small files while a thread starts, and has that stack.
    if cfg!(fuzzing) {
        return read();
    }
    thread::scope(|scope| {
        thread::Builder::new()
            .stack_size(STACK_BYTES)
            .spawn_scoped(scope, read)
            .expect("the system starts a thread")
            .join()
            .unwrap_or_else(|panic| resume_unwind(panic))
    })
}

fn read_text(name: &str, text: &str, folder: Folder<'_>) -> Result<(Scene, Source), Log> {
    let mut log = Log::default();
    let root = match DeTable::parse(text) {
        Ok(root) => root,
        Err(error) => {
            log.push(syntax::explain(text, &error));
            return Err(log);
        }
    };
    match sections::scene(root.get_ref(), folder, &mut log) {
        Some((scene, clouds)) if log.is_empty() => {
            Ok((scene, Source::new(name, text, root.get_ref(), clouds)))
        }
        _ => Err(log),
    }
}

/// The mistakes found so far.
///
/// A function that takes a log and returns `None` has put at least one mistake into
/// it, unless it says otherwise.
#[derive(Default)]
struct Log {
    /// Of the scene file.
    scene: Vec<Diagnostic>,
    /// Of the first data file that has some.
    data: Option<SceneFileError>,
}

impl Log {
    fn push(&mut self, diagnostic: Diagnostic) {
        self.scene.push(diagnostic);
    }

    /// Takes the mistakes of a data file, if they are the first.
    fn blame(&mut self, data: &Data, mistakes: Mistakes) {
        self.data.get_or_insert_with(|| data.clone().refuse(mistakes));
    }

    fn is_empty(&self) -> bool {
        self.scene.is_empty() && self.data.is_none()
    }

    /// The message: about the scene file, or, where nothing is wrong with that, a data file.
    fn refuse(mut self, name: &str, text: &str) -> SceneFileError {
        match self.data {
            Some(data) if self.scene.is_empty() => data,
            _ => {
                self.scene.sort_by_key(|diagnostic| diagnostic.span().start);
                SceneFileError::Invalid {
                    name: name.to_owned(),
                    text: text.to_owned(),
                    diagnostics: self.scene,
                    others: 0,
                }
            }
        }
    }
}
