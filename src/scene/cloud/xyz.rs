//! The chemists' .xyz files: a number of atoms, a comment, and an atom in each line.
//!
//! The format is that of the program `XMol` (Minnesota Supercomputer Center, 1990s): `C 0.0 0.0
//! 0.0`, an element by symbol or atomic number and its position in ångström; what stands
//! behind the position (charges, forces) is passed over.

use glam::DVec3;

use super::elements;
use super::fields::{Field, words};
use super::lines::{Line, Lines};
use super::{Diagnostic, Mistakes, Recipe, Row, Sphere};
use crate::scene::error::quoted;

/// Lines before the first atom.
const HEAD: usize = 2;

const FORMAT: &str = "line 1 is the number of atoms, line 2 a comment, and each line from 3 on an \
                      element and its x, y, z";

/// The atoms of a file whose head was read.
pub(crate) struct Atoms<'a>(Lines<'a>);

impl<'a> Atoms<'a> {
    pub(super) fn new(text: &'a str) -> Result<Self, Mistakes> {
        let mut body = Lines::new(text);
        let Some(first) = body.next() else {
            return Err(Diagnostic::new(0..0, "this file has no atoms").note(FORMAT).into());
        };
        let number = Field::new(first.start, first.text);
        let Some(count) = number.text().parse().ok().filter(|&count: &usize| count > 0) else {
            let wrong =
                Diagnostic::new(number.span(), "the first line must be the number of atoms");
            return Err(wrong.label("not a whole number from 1 on").note(FORMAT).into());
        };
        body.next();
        let (atoms, found, mut rest) = body.first(count);
        if found < count {
            let ends = format!("this file ends after {found} of {count} atoms");
            let at = text.len()..text.len();
            let mend = "its first line says how many there should be";
            return Err(Diagnostic::new(at, ends).note(mend).into());
        }
        if let Some(more) = rest.find(|line| !line.text.trim().is_empty()) {
            let wrong =
                Diagnostic::new(more.span(), format!("this file goes on after atom {count}"));
            let mend = "that many its first line says; of several frames, keep one";
            return Err(wrong.note(mend).into());
        }
        Ok(Self(atoms))
    }

    /// Appends the sphere of each atom.
    pub(super) fn append(
        &self,
        recipe: &Recipe,
        spheres: &mut Vec<Sphere>,
    ) -> Result<(), Mistakes> {
        self.0.read(spheres, |line, mistakes| {
            let atom = atom(line, mistakes)?;
            recipe.sphere(line, &atom, mistakes)
        })
    }
}

/// Atom number `index`, from 0.
pub(super) fn row(text: &str, index: usize) -> Option<Line<'_>> {
    Lines::new(text).nth(HEAD + index)
}

fn atom<'a>(line: &Line<'a>, mistakes: &mut Mistakes) -> Option<Row<'a>> {
    let before = mistakes.count;
    let mut words = words(line.start, line.text);
    let end = Field::new(line.span().end, "");
    let name = words.next().unwrap_or(end);
    let element = elements::named(name.text());
    if element.is_none() {
        mistakes.push(|| unknown(&name));
    }
    let mut position = DVec3::ZERO;
    let place = ["x", "y", "z"].map(|_| words.next().unwrap_or(end));
    for (axis, axis_name) in ["x", "y", "z"].into_iter().enumerate() {
        match place[axis].number() {
            Some(number) => position[axis] = number,
            None if name == end => (),
            None => mistakes.push(|| place[axis].not_a_number(axis_name)),
        }
    }
    if mistakes.count > before {
        return None;
    }
    let element = element?;
    Some(Row {
        position,
        place,
        radius: Some(element.radius),
        radius_place: name,
        colour: Some(element.albedo()),
    })
}

fn unknown(name: &Field<'_>) -> Diagnostic {
    if name.text().is_empty() {
        return Diagnostic::new(name.span(), "there is no atom in this line").note(FORMAT);
    }
    let wrong = Diagnostic::new(name.span(), format!("unknown element {}", quoted(name.text())));
    wrong.note(elements::KNOWN)
}
