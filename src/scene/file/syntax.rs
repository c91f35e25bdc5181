//! Mistakes that keep a file from being read as TOML at all.

use std::str::Utf8Error;

use crate::scene::error::{Diagnostic, quoted};

/// Says in the words of a scene file what the TOML parser found wrong.
pub(super) fn explain(text: &str, error: &toml::de::Error) -> Diagnostic {
    let span = error.span().unwrap_or(0..0);
    let marked = text.get(span.clone()).unwrap_or_default();
    let wrong = |message: &str| Diagnostic::new(span.clone(), message);
    // The parser's words, of which those that scene files often meet are replaced.
    let (what, expected) =
        error.message().split_once(", expected ").unwrap_or((error.message(), ""));
    match (what, expected) {
        ("duplicate key", _) => wrong(&format!("{} is given twice", quoted(marked)))
            .label("the second one")
            .note("only `[[spheres]]` and `[[clouds]]` may be repeated"),
        // The one message for which the parser gives no place.
        ("recursion limit", _) => wrong("a key of this file has too many parts")
            .label("somewhere from here on")
            .note("no key of a scene has more parts than `materials.red.diffuse`"),
        ("cannot recurse further; max recursion depth met", _) => {
            wrong("this is nested too deeply")
                .note("nothing in a scene is nested deeper than a list of numbers in a table")
        }
        ("string values must be quoted", _) if marked.is_empty() => {
            wrong("a value is missing here")
        }
        ("string values must be quoted", _) => wrong("this is not a value")
            .note("text is written in quotes, a number as `1`, `-0.5` or `1e-3`"),
        ("invalid mantissa" | "invalid fraction", "digits") => {
            wrong("a digit is missing here").note("a decimal point has a digit on either side")
        }
        ("key with no value", _) => {
            wrong("`=` is missing here").note("write `key = value`, or `#` before a comment")
        }
        ("missing comma between array elements", _) => {
            wrong("the list before this has no closing `]`, or a comma is missing")
        }
        ("unexpected key or value", _) => wrong("the line should end here")
            .note("a decimal point is `.`; the numbers of a list stand in `[` and `]`"),
        (_, "`\"`" | "`'`") => wrong("the closing quote is missing here"),
        (_, "" | "nothing") => wrong(&format!("not valid TOML: {what}")),
        _ => wrong(&format!("not valid TOML: {what}")).label(format!("expected {expected}")),
    }
}

/// Points at the first byte of `bytes` that is not UTF-8, in the text that has U+FFFD
/// in place of what could not be decoded.
pub(super) fn not_utf8(error: &Utf8Error, bytes: &[u8]) -> Diagnostic {
    let start = error.valid_up_to();
    let span = start..start + char::REPLACEMENT_CHARACTER.len_utf8();
    Diagnostic::new(span, "this file is not UTF-8 text")
        .label(format!("the byte here is 0x{:02X}", bytes[start]))
        .note("save it as plain text with the encoding UTF-8")
}
