//! Reads scene files: TOML text to a validated [`Scene`], with every mistake found.

mod sections;
mod source;
mod spheres;
mod stray;
mod syntax;
mod table;

use std::fs::File;
use std::io::{self, Read as _};
use std::panic::resume_unwind;
use std::path::Path;
use std::thread;

use toml::de::DeTable;

pub use source::Source;

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

/// Reads the scene file at `path`, which may also be a pipe.
///
/// # Errors
/// If the file cannot be read, is larger than 16 MiB, is not UTF-8 text, or is not a
/// valid scene; then with every mistake that it has.
pub fn load(path: &Path) -> Result<Scene, SceneFileError> {
    load_with_source(path).map(|(scene, _)| scene)
}

/// Reads the scene file at `path`, and keeps its text.
///
/// # Errors
/// As [`load`].
pub fn load_with_source(path: &Path) -> Result<(Scene, Source), SceneFileError> {
    let bytes = read(path)
        .map_err(|error| SceneFileError::Read { path: path.to_owned(), error })?
        .ok_or_else(|| SceneFileError::TooLarge { path: path.to_owned(), limit: MAX_FILE_BYTES })?;
    let name = path.display().to_string();
    match String::from_utf8(bytes) {
        Ok(text) => parse_with_source(&name, &text),
        Err(error) => {
            let text = String::from_utf8_lossy(error.as_bytes()).into_owned();
            let diagnostics = vec![syntax::not_utf8(&error.utf8_error(), error.as_bytes())];
            Err(SceneFileError::Invalid { name, text, diagnostics })
        }
    }
}

/// Reads the text of a scene file; `name` stands for the file in messages.
///
/// # Errors
/// If the text is not a valid scene. A mistake in the TOML syntax is the only one
/// reported; otherwise every mistake is.
pub fn parse(name: &str, text: &str) -> Result<Scene, SceneFileError> {
    parse_with_source(name, text).map(|(scene, _)| scene)
}

fn parse_with_source(name: &str, text: &str) -> Result<(Scene, Source), SceneFileError> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    with_deep_stack(|| read_text(name, text)).map_err(|mut diagnostics| {
        diagnostics.sort_by_key(|diagnostic| diagnostic.span().start);
        SceneFileError::Invalid { name: name.to_owned(), text: text.to_owned(), diagnostics }
    })
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

fn read_text(name: &str, text: &str) -> Result<(Scene, Source), Vec<Diagnostic>> {
    let root = DeTable::parse(text).map_err(|error| vec![syntax::explain(text, &error)])?;
    let mut log = Log::default();
    match sections::scene(root.get_ref(), &mut log) {
        Some(scene) if log.0.is_empty() => Ok((scene, Source::new(name, text, root.get_ref()))),
        _ => Err(log.0),
    }
}

/// The bytes of a file; `None` if there are more than [`MAX_FILE_BYTES`].
fn read(path: &Path) -> io::Result<Option<Vec<u8>>> {
    let file = File::open(path)?;
    if file.metadata()?.len() > MAX_FILE_BYTES {
        return Ok(None);
    }
    // A pipe or device has no length to go by, and a file may be growing.
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES + 1).read_to_end(&mut bytes)?;
    Ok((bytes.len() as u64 <= MAX_FILE_BYTES).then_some(bytes))
}

/// The mistakes found so far.
///
/// A function that takes a log and returns `None` has put at least one mistake into
/// it, unless it says otherwise.
#[derive(Default)]
struct Log(Vec<Diagnostic>);

impl Log {
    fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }
}
