//! The line of a file that a message shows.

use std::ops::Range;

use codespan_reporting::files::{Error, Files};

/// Lines longer than this many characters are shown in part.
const MAX_LINE: usize = 200;
/// Characters shown before the mark of a line that is cut.
const MAX_BEFORE: usize = 80;
/// Characters shown from the mark on of a line that is cut.
const MAX_AFTER: usize = 120;
/// Stands where a line was cut.
const CUT: &str = "...";

/// One line of a file, cut to a readable length and freed of control characters,
/// that still knows its true place in the file.
#[derive(Debug, Default, PartialEq, Eq)]
pub(super) struct Excerpt<'a> {
    name: &'a str,
    line: usize,
    column: usize,
    text: String,
    mark: Range<usize>,
}

impl<'a> Excerpt<'a> {
    /// The line of `source` in which `span` starts. What `span` marks beyond the end
    /// of that line is left out, as are places beyond the end of `source`.
    pub(super) fn new(name: &'a str, source: &str, span: Range<usize>) -> Self {
        let start = source.floor_char_boundary(span.start);
        let line_start = source[..start].rfind('\n').map_or(0, |newline| newline + 1);
        let line_end = source[start..].find('\n').map_or(source.len(), |newline| start + newline);
        let line_end =
            start.max(line_start + source[line_start..line_end].trim_end_matches('\r').len());
        let end = source.ceil_char_boundary(span.end).clamp(start, line_end);

        let (before, after) = (&source[line_start..start], &source[start..line_end]);
        let long = before.chars().count() + after.chars().count() > MAX_LINE;
        let from = if long { nth_last_char(before, MAX_BEFORE) } else { 0 };
        let to = if long { nth_char(after, MAX_AFTER) } else { after.len() };

        let mut text = String::new();
        text.push_str(if from > 0 { CUT } else { "" });
        push_printable(&mut text, &before[from..]);
        let mark_start = text.len();
        let marked = to.min(end - start);
        push_printable(&mut text, &after[..marked]);
        let mark = mark_start..text.len();
        push_printable(&mut text, &after[marked..to]);
        text.push_str(if to < after.len() { CUT } else { "" });

        Self {
            name,
            line: source[..line_start].matches('\n').count() + 1,
            column: before.chars().count() + 1,
            text,
            mark,
        }
    }

    /// The marked bytes of the excerpt's own text.
    pub(super) fn mark(&self) -> Range<usize> {
        self.mark.clone()
    }
}

/// Where the character number `n` starts, from 0; the end if there are fewer.
fn nth_char(text: &str, n: usize) -> usize {
    text.char_indices().nth(n).map_or(text.len(), |(at, _)| at)
}

/// Where the last `n` characters start.
fn nth_last_char(text: &str, n: usize) -> usize {
    text.char_indices().rev().take(n).last().map_or(text.len(), |(at, _)| at)
}

/// Appends `part` with U+FFFD for control characters, which could drive a terminal.
fn push_printable(text: &mut String, part: &str) {
    let printable =
        |c: char| if c.is_control() && c != '\t' { char::REPLACEMENT_CHARACTER } else { c };
    text.extend(part.chars().map(printable));
}

/// A file of one line, which reports the number and column that the line has in the
/// whole file.
impl<'a> Files<'a> for Excerpt<'_> {
    type FileId = ();
    type Name = &'a str;
    type Source = &'a str;

    fn name(&'a self, (): ()) -> Result<&'a str, Error> {
        Ok(self.name)
    }

    fn source(&'a self, (): ()) -> Result<&'a str, Error> {
        Ok(&self.text)
    }

    fn line_index(&'a self, (): (), _byte: usize) -> Result<usize, Error> {
        Ok(0)
    }

    fn line_number(&'a self, (): (), _line: usize) -> Result<usize, Error> {
        Ok(self.line)
    }

    /// Only ever asked for the start of the mark.
    fn column_number(&'a self, (): (), _line: usize, _byte: usize) -> Result<usize, Error> {
        Ok(self.column)
    }

    fn line_range(&'a self, (): (), _line: usize) -> Result<Range<usize>, Error> {
        Ok(0..self.text.len())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Line, column, shown text and marked text.
    fn shown(source: &str, span: Range<usize>) -> (usize, usize, String, String) {
        let excerpt = Excerpt::new("a.toml", source, span);
        let marked = excerpt.text[excerpt.mark()].to_owned();
        (excerpt.line, excerpt.column, excerpt.text, marked)
    }

    #[test]
    fn columns_count_characters() {
        assert_eq!(shown("a\n\té = x\n", 8..9), (2, 6, "\té = x".into(), "x".into()));
        assert_eq!(shown("ab\r\ncd\r\n", 0..9), (1, 1, "ab".into(), "ab".into()));
        assert_eq!(shown("ab\r\ncd", 2..3), (1, 3, "ab".into(), String::new()));
    }

    #[test]
    fn places_at_and_beyond_the_end() {
        assert_eq!(shown("", 0..0), (1, 1, String::new(), String::new()));
        assert_eq!(shown("ab", 2..2), (1, 3, "ab".into(), String::new()));
        assert_eq!(shown("ab\n", 3..3), (2, 1, String::new(), String::new()));
        assert_eq!(shown("ab", 7..9), (1, 3, "ab".into(), String::new()));
    }

    #[test]
    fn spans_inside_a_character_grow_to_hold_it() {
        assert_eq!(shown("aé!", 2..2), (1, 2, "aé!".into(), "é".into()));
    }

    #[test]
    fn long_lines_are_cut_around_the_mark() {
        let source = format!("{}key{}", "é".repeat(1000), "y".repeat(1000));
        let (line, column, text, marked) = shown(&source, 2000..2003);
        assert_eq!((line, column, marked.as_str()), (1, 1001, "key"));
        assert_eq!(text, format!("...{}key{}...", "é".repeat(80), "y".repeat(117)));
        let (.., marked) = shown(&source, 2003..3003);
        assert_eq!(marked.len(), 120);
    }

    #[test]
    fn control_characters_are_not_shown() {
        assert_eq!(shown("\u{1b}[2Jx", 4..5), (1, 5, "\u{fffd}[2Jx".into(), "x".into()));
    }
}
