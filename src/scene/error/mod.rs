//! What is wrong with a scene file or a data file, and where.

mod excerpt;

use std::fmt::Write as _;
use std::io;
use std::ops::Range;
use std::path::PathBuf;

use codespan_reporting::diagnostic as codespan;
use codespan_reporting::term::termcolor::Buffer;
use codespan_reporting::term::{Chars, Config, emit_to_write_style};

use excerpt::Excerpt;

/// Most mistakes that are shown; of the others, only their number.
pub(super) const MAX_SHOWN: usize = 20;
/// Most characters of a key or name that a message repeats.
const MAX_QUOTED: usize = 40;

/// One mistake in a file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Diagnostic {
    message: String,
    span: Range<usize>,
    label: String,
    notes: Vec<String>,
}

impl Diagnostic {
    /// A mistake at `span`, in bytes of the file's text.
    pub(super) fn new(span: Range<usize>, message: impl Into<String>) -> Self {
        Self { message: message.into(), span, label: String::new(), notes: Vec::new() }
    }

    /// Adds what is written beside the marked text.
    pub(super) fn label(mut self, label: impl Into<String>) -> Self {
        self.label = label.into();
        self
    }

    /// Adds what is allowed, or how to mend the mistake.
    pub(super) fn note(mut self, note: impl Into<String>) -> Self {
        self.notes.push(note.into());
        self
    }

    /// What is wrong, as one line.
    #[must_use]
    pub fn message(&self) -> &str {
        &self.message
    }

    /// Where, as bytes of the file's text after a byte order mark, if it has one.
    #[must_use]
    pub fn span(&self) -> Range<usize> {
        self.span.clone()
    }

    /// What is allowed, one remark per entry.
    #[must_use]
    pub fn notes(&self) -> &[String] {
        &self.notes
    }
}

/// Why a scene file gives no scene.
///
/// `Display` writes the whole message without colour, as [`render`](Self::render)
/// does; it starts with `error:`, ends without a newline, and includes the cause, so
/// there is no [`source`](std::error::Error::source) to print after it.
#[derive(Debug, thiserror::Error)]
#[error("{}", self.render(false))]
pub enum SceneFileError {
    /// The file could not be opened or read.
    Read {
        /// The file as it was named.
        path: PathBuf,
        /// What the system said.
        error: io::Error,
    },
    /// The file is longer than any scene that candor reads.
    TooLarge {
        /// The file as it was named.
        path: PathBuf,
        /// The most bytes that a scene file may have.
        limit: u64,
    },
    /// The file, or a data file that it names, was read, but its text is not right.
    Invalid {
        /// The file as it was named.
        name: String,
        /// The file's text, which the spans of the diagnostics point into.
        text: String,
        /// The mistakes found, at least one, in the order of the text.
        diagnostics: Vec<Diagnostic>,
        /// How many more there are: 0 in a scene file, of which every mistake is kept.
        others: usize,
    },
}

impl SceneFileError {
    /// The message for the user: every mistake with its line of the file, several
    /// lines of text without a newline at the end. `colour` adds ANSI escapes.
    #[must_use]
    pub fn render(&self, colour: bool) -> String {
        let mut out = if colour { Buffer::ansi() } else { Buffer::no_color() };
        match self {
            Self::Read { path, error } => {
                emit_plain(&mut out, format!("cannot read {}: {error}", path.display()));
            }
            Self::TooLarge { path, limit } => {
                let mebibytes = limit >> 20;
                emit_plain(
                    &mut out,
                    format!(
                        "{} is too large: a scene file has at most {mebibytes} MiB",
                        path.display()
                    ),
                );
            }
            Self::Invalid { name, text, diagnostics, .. } => {
                for diagnostic in diagnostics.iter().take(MAX_SHOWN) {
                    emit_excerpt(
                        &mut out,
                        &Excerpt::new(name, text, diagnostic.span()),
                        diagnostic,
                    );
                }
            }
        }
        let mut rendered = String::from_utf8_lossy(out.as_slice()).trim_end().to_owned();
        if let Self::Invalid { diagnostics, others, .. } = self {
            let more = diagnostics.len().saturating_sub(MAX_SHOWN) + others;
            if more > 0 {
                let _ = write!(rendered, "\n\n... and {more} more");
            }
        }
        rendered
    }
}

/// Writes a message that points at no text.
fn emit_plain(out: &mut Buffer, message: String) {
    emit(out, &Excerpt::default(), &codespan::Diagnostic::error().with_message(message));
}

fn emit_excerpt(out: &mut Buffer, excerpt: &Excerpt<'_>, diagnostic: &Diagnostic) {
    let mark = codespan::Label::primary((), excerpt.mark()).with_message(&diagnostic.label);
    let report = codespan::Diagnostic::error()
        .with_message(&diagnostic.message)
        .with_label(mark)
        .with_notes(diagnostic.notes.clone());
    emit(out, excerpt, &report);
}

fn emit(out: &mut Buffer, excerpt: &Excerpt<'_>, report: &codespan::Diagnostic<()>) {
    let config = Config { chars: Chars::ascii(), ..Config::default() };
    emit_to_write_style(out, &config, excerpt, report)
        .expect("a buffer in memory takes every write, and the excerpt holds its own mark");
}

/// A key or name from the file as a message shows it: in backticks, cut when long,
/// and with control characters escaped so that none reaches the terminal.
pub(super) fn quoted(name: &str) -> String {
    format!("`{}`", printable(name))
}

/// The same without the backticks.
pub(super) fn printable(name: &str) -> String {
    let mut shown = String::new();
    for c in name.chars().take(MAX_QUOTED) {
        if c.is_control() {
            shown.extend(c.escape_default());
        } else {
            shown.push(c);
        }
    }
    if name.chars().nth(MAX_QUOTED).is_some() {
        shown.push_str("...");
    }
    shown
}

#[cfg(test)]
mod tests {
    use super::*;

    fn invalid(text: &str, diagnostics: Vec<Diagnostic>) -> SceneFileError {
        SceneFileError::Invalid { name: "a.toml".into(), text: text.into(), diagnostics, others: 0 }
    }

    #[test]
    fn twenty_mistakes_are_shown_and_the_others_counted() {
        let mistakes = |n: usize| vec![Diagnostic::new(0..1, "wrong"); n];
        let twenty = invalid("x", mistakes(20)).to_string();
        assert_eq!(twenty.matches("error: wrong").count(), 20);
        assert!(!twenty.contains("more"));
        let many = invalid("x", mistakes(23)).to_string();
        assert_eq!(many.matches("error: wrong").count(), 20);
        assert!(many.ends_with("\n\n... and 3 more"));
    }

    #[test]
    fn colour_adds_escapes_and_changes_nothing_else() {
        let error = invalid("key = 1", vec![Diagnostic::new(0..3, "wrong").note("right")]);
        let coloured = error.render(true);
        assert_ne!(coloured, error.to_string());
        let mut plain = String::new();
        for (i, part) in coloured.split("\u{1b}[").enumerate() {
            let text = if i == 0 { part } else { part.split_once('m').expect("an escape").1 };
            plain.push_str(text);
        }
        assert_eq!(plain, error.to_string());
    }

    #[test]
    fn quoted_names_are_short_and_harmless() {
        assert_eq!(quoted("red"), "`red`");
        assert_eq!(quoted("\u{1b}[2J"), "`\\u{1b}[2J`");
        assert_eq!(quoted(&"é".repeat(41)), format!("`{}...`", "é".repeat(40)));
    }
}
