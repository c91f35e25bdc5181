//! The fields of a line, with their places.
//!
//! The `csv` crate reads fields but does not say where they stand, and a message must.

use std::ops::Range;

use crate::scene::error::Diagnostic;

/// One field, without spaces and quotes around it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Field<'a> {
    /// Bytes of the file before it.
    start: usize,
    text: &'a str,
}

impl<'a> Field<'a> {
    /// `text`, which stands at `start`, without the spaces around it.
    pub(super) fn new(start: usize, text: &'a str) -> Self {
        let trimmed = text.trim_start();
        Self { start: start + (text.len() - trimmed.len()), text: trimmed.trim_end() }
    }

    pub(super) fn text(&self) -> &'a str {
        self.text
    }

    /// Its place in the file, in bytes.
    pub(super) fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }

    /// A number, which may be infinite or NaN; `None` if it is not one.
    pub(super) fn number(&self) -> Option<f64> {
        self.text.parse().ok()
    }

    /// A message that the field must be something else.
    pub(super) fn wrong(&self, name: &str, allowed: &str) -> Diagnostic {
        Diagnostic::new(self.span(), format!("`{name}` must be {allowed}"))
    }

    /// The same for what is not a number at all.
    pub(super) fn not_a_number(&self, name: &str) -> Diagnostic {
        self.wrong(name, "a number").label(if self.text.is_empty() {
            "there is nothing here"
        } else {
            "this is not a number"
        })
    }
}

/// The comma-separated fields of a line (RFC 4180, without line breaks in quotes).
pub(super) struct Commas<'a> {
    /// `None` after the last field.
    rest: Option<&'a str>,
    /// Bytes of the file before the rest.
    start: usize,
}

impl<'a> Commas<'a> {
    /// The fields of `text`, which stands at `start`.
    pub(super) fn new(start: usize, text: &'a str) -> Self {
        Self { rest: Some(text), start }
    }

    /// Cuts off a field of `length` bytes and the comma behind it.
    fn cut(&mut self, rest: &'a str, length: usize) -> Field<'a> {
        let field = Field::new(self.start, &rest[..length]);
        self.rest = rest.get(length + 1..);
        self.start += length + 1;
        field
    }

    /// A field whose first character that is not a space is a quote, at `open`.
    fn quoted(&mut self, rest: &'a str, open: usize) -> Result<Field<'a>, Diagnostic> {
        let inside = &rest[open + 1..];
        let Some(length) = closing_quote(inside) else {
            self.rest = None;
            let at = self.start + open;
            return Err(Diagnostic::new(at..at + 1, "this quote is not closed on its line")
                .note("a field in quotes may hold commas, but no line break"));
        };
        let field = Field::new(self.start + open + 1, &inside[..length]);
        let close = open + 1 + length;
        let behind = &rest[close + 1..];
        let end = behind.find(',').map_or(rest.len(), |comma| close + 1 + comma);
        let stray = Field::new(self.start + close + 1, &rest[close + 1..end]);
        if !stray.text().is_empty() {
            self.rest = None;
            return Err(Diagnostic::new(stray.span(), "after the closing quote comes a comma")
                .note("a quote inside of a field in quotes is written twice"));
        }
        self.cut(rest, end);
        Ok(field)
    }
}

/// Where the quote is that closes a field; two in a row stand for one inside of it.
fn closing_quote(inside: &str) -> Option<usize> {
    let bytes = inside.as_bytes();
    let mut at = 0;
    loop {
        at += bytes.get(at..)?.iter().position(|&byte| byte == b'"')?;
        if bytes.get(at + 1) != Some(&b'"') {
            return Some(at);
        }
        at += 2;
    }
}

impl<'a> Iterator for Commas<'a> {
    type Item = Result<Field<'a>, Diagnostic>;

    fn next(&mut self) -> Option<Self::Item> {
        let rest = self.rest?;
        let open = rest.len() - rest.trim_start().len();
        if rest[open..].starts_with('"') {
            return Some(self.quoted(rest, open));
        }
        let length = rest.as_bytes().iter().position(|&byte| byte == b',').unwrap_or(rest.len());
        Some(Ok(self.cut(rest, length)))
    }
}

/// The fields of a line between spaces and tabs.
pub(super) fn words(start: usize, text: &str) -> impl Iterator<Item = Field<'_>> {
    let mut rest = text;
    std::iter::from_fn(move || {
        rest = rest.trim_start();
        let length = rest.find(char::is_whitespace).unwrap_or(rest.len());
        let field = Field { start: start + (text.len() - rest.len()), text: &rest[..length] };
        rest = &rest[length..];
        (length > 0).then_some(field)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn commas(text: &str) -> Vec<(usize, &str)> {
        let fields = Commas::new(100, text).map(|field| field.expect("a field"));
        fields.map(|field| (field.start, field.text)).collect()
    }

    #[test]
    fn fields_know_their_place() {
        assert_eq!(commas("a,b"), [(100, "a"), (102, "b")]);
        assert_eq!(commas(" a ,, b,"), [(101, "a"), (104, ""), (106, "b"), (108, "")]);
        assert_eq!(commas(r#""a,""b", "c" ,d"#), [(101, r#"a,""b"#), (110, "c"), (114, "d")]);
        assert_eq!(commas(r#"a"b,"""#), [(100, "a\"b"), (105, "")]);
        let found: Vec<_> = words(7, " C  1\t2 ").map(|word| (word.start, word.text)).collect();
        assert_eq!(found, [(8, "C"), (11, "1"), (13, "2")]);
    }

    #[test]
    fn quotes_that_go_wrong_end_the_line() {
        for text in [r#"a,"b"#, r#"a,"b"c,d"#, r#"a,"b""#.trim_end_matches('"')] {
            let mut fields = Commas::new(0, text);
            assert!(fields.next().is_some_and(|field| field.is_ok()), "{text}");
            assert!(fields.next().is_some_and(|field| field.is_err()), "{text}");
            assert!(fields.next().is_none(), "{text}");
        }
    }
}
