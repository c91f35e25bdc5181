//! The lines of a text, with their numbers and places, read on all cores.

use std::ops::Range;

use rayon::prelude::*;

use super::{Mistakes, Sphere};

/// Bytes that one core reads at a time.
const PIECE_BYTES: usize = 1 << 18;
/// Pieces that are read at a time, before their spheres move to where all are: their memory
/// serves the next ones.
const WAVE: usize = 64;

/// A line without its end, `\n` or `\r\n`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Line<'a> {
    /// Counted from 1.
    pub(super) number: usize,
    /// Bytes before it.
    pub(super) start: usize,
    pub(super) text: &'a str,
}

impl Line<'_> {
    /// Its place in the text, in bytes.
    pub(super) fn span(&self) -> Range<usize> {
        self.start..self.start + self.text.len()
    }
}

/// The lines of a text from one place on.
#[derive(Debug, Clone)]
pub(super) struct Lines<'a> {
    rest: &'a str,
    /// Number of the first line of the rest.
    number: usize,
    /// Bytes before the rest.
    start: usize,
}

impl<'a> Lines<'a> {
    pub(super) fn new(text: &'a str) -> Self {
        Self { rest: text, number: 1, start: 0 }
    }

    /// Bytes before the next line.
    pub(super) fn start(&self) -> usize {
        self.start
    }

    /// The first `length` bytes, which end with a line, and the rest.
    fn split_at(&self, length: usize) -> (Self, Self) {
        let (first, rest) = self.rest.split_at(length);
        let number = self.number + newlines(first);
        (Self { rest: first, ..*self }, Self { rest, number, start: self.start + length })
    }

    /// The first `count` lines or as many as there are, their number, and the rest.
    pub(super) fn first(&self, count: usize) -> (Self, usize, Self) {
        let mut behind = self.clone();
        let found = behind.by_ref().take(count).count();
        let (first, rest) = self.split_at(behind.start - self.start);
        (first, found, rest)
    }

    /// Pieces of some [`PIECE_BYTES`] each.
    fn pieces(&self) -> Vec<Self> {
        let mut pieces = Vec::new();
        let (mut rest, mut start) = (self.rest, self.start);
        while !rest.is_empty() {
            let beyond = rest.as_bytes().get(PIECE_BYTES..);
            let newline = beyond.and_then(|beyond| beyond.iter().position(|&b| b == b'\n'));
            let length = newline.map_or(rest.len(), |at| PIECE_BYTES + at + 1);
            pieces.push(Self { rest: &rest[..length], number: 0, start });
            rest = &rest[length..];
            start += length;
        }
        let counts: Vec<usize> = pieces.par_iter().map(|piece| newlines(piece.rest)).collect();
        let mut number = self.number;
        for (piece, count) in pieces.iter_mut().zip(counts) {
            piece.number = number;
            number += count;
        }
        pieces
    }

    /// Appends what `read` makes of each line to `spheres`, in order; it may pass over a line.
    pub(super) fn read(
        &self,
        spheres: &mut Vec<Sphere>,
        read: impl Fn(&Line<'a>, &mut Mistakes) -> Option<Sphere> + Sync,
    ) -> Result<(), Mistakes> {
        let read = |piece: &Self| {
            let mut mistakes = Mistakes::default();
            let found = piece.clone().filter_map(|line| read(&line, &mut mistakes)).collect();
            (found, mistakes)
        };
        let pieces = self.pieces();
        let lines = pieces.last().map_or(0, |last| last.number + newlines(last.rest) + 1);
        spheres.reserve(lines.saturating_sub(self.number));
        let mut all = Mistakes::default();
        for wave in pieces.chunks(WAVE) {
            let read: Vec<(Vec<Sphere>, Mistakes)> = wave.par_iter().map(read).collect();
            for (found, mistakes) in read {
                spheres.extend(found);
                all.append(mistakes);
            }
        }
        all.none()
    }
}

impl<'a> Iterator for Lines<'a> {
    type Item = Line<'a>;

    fn next(&mut self) -> Option<Line<'a>> {
        if self.rest.is_empty() {
            return None;
        }
        let (text, rest) = match self.rest.split_once('\n') {
            Some((text, rest)) => (text, rest),
            None => (self.rest, ""),
        };
        let line =
            Line { number: self.number, start: self.start, text: text.trim_end_matches('\r') };
        self.start += self.rest.len() - rest.len();
        self.number += 1;
        self.rest = rest;
        Some(line)
    }
}

/// Number of lines of a text.
pub(super) fn count(text: &str) -> usize {
    newlines(text) + usize::from(!text.is_empty() && !text.ends_with('\n'))
}

fn newlines(text: &str) -> usize {
    text.matches('\n').count()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_know_their_place() {
        let lines: Vec<(usize, usize, &str)> = Lines::new("ab\r\n\n\u{e9}\nc")
            .map(|line| (line.number, line.start, line.text))
            .collect();
        assert_eq!(lines, [(1, 0, "ab"), (2, 4, ""), (3, 5, "\u{e9}"), (4, 8, "c")]);
        assert_eq!(Lines::new("").next(), None);
        assert_eq!(["", "a", "a\n", "a\n\n", "a\nb"].map(count), [0, 1, 1, 2, 2]);
    }

    /// Pieces put together again are the lines of the whole.
    #[test]
    fn pieces_hold_every_line_once() {
        let text = "1\n23\n\n".repeat(200_000);
        let whole = Lines::new(&text);
        let pieces = whole.pieces();
        assert!(pieces.len() > 2, "{} pieces", pieces.len());
        assert!(pieces.into_iter().flatten().eq(whole), "lines differ");
    }
}
