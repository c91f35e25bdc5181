//! Spheres from data files: a text in one of two formats, and what the scene says of its rows.

mod csv;
mod elements;
mod fields;
mod lines;
mod xyz;

use std::ops::Range;
use std::path::Path;
use std::sync::Arc;

use glam::DVec3;

use super::error::{Diagnostic, MAX_SHOWN, SceneFileError};
use super::{Albedo, MAX_LENGTH, Sphere, Surface, check_radius};
use fields::Field;
use lines::Line;

/// How the rows of a data file are written, by the end of its name.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Format {
    /// Columns with a header.
    Csv,
    /// The chemists' list of atoms.
    Xyz,
}

impl Format {
    /// The format that a name ends in, in capitals or not.
    pub(super) fn of(file: &str) -> Option<Self> {
        let ending = Path::new(file).extension()?;
        if ending.eq_ignore_ascii_case("csv") {
            Some(Self::Csv)
        } else if ending.eq_ignore_ascii_case("xyz") {
            Some(Self::Xyz)
        } else {
            None
        }
    }
}

/// A data file that was read into memory.
#[derive(Debug, Clone)]
pub(super) struct Data {
    name: String,
    text: String,
    format: Format,
}

impl Data {
    /// `name` stands for the file in messages; `text` has no byte order mark.
    pub(super) fn new(name: String, text: String, format: Format) -> Self {
        Self { name, text, format }
    }

    /// Number of lines, of which no more than this many can be rows.
    pub(super) fn lines(&self) -> usize {
        lines::count(&self.text)
    }

    /// Reads what stands above the rows.
    pub(super) fn open(&self) -> Result<Rows<'_>, Mistakes> {
        match self.format {
            Format::Csv => csv::Table::new(&self.text).map(Rows::Csv),
            Format::Xyz => xyz::Atoms::new(&self.text).map(Rows::Xyz),
        }
    }

    /// The place of row number `index`, from 0, in a file whose rows were read.
    pub(super) fn row(&self, index: usize) -> Range<usize> {
        let line = match self.format {
            Format::Csv => csv::row(&self.text, index),
            Format::Xyz => xyz::row(&self.text, index),
        };
        line.map_or(0..0, |line| line.span())
    }

    /// The message for what is wrong with the file.
    pub(super) fn refuse(self, mistakes: Mistakes) -> SceneFileError {
        let others = mistakes.count - mistakes.first.len();
        SceneFileError::Invalid {
            name: self.name,
            text: self.text,
            diagnostics: mistakes.first,
            others,
        }
    }
}

/// The rows of a data file whose head was read.
pub(super) enum Rows<'a> {
    Csv(csv::Table<'a>),
    Xyz(xyz::Atoms<'a>),
}

impl Rows<'_> {
    /// Whether the file says how large its spheres are.
    pub(super) fn radii(&self) -> Radii {
        match self {
            Self::Csv(table) if table.has_radius() => Radii::Column,
            Self::Csv(_) => Radii::Missing,
            Self::Xyz(_) => Radii::ByElement,
        }
    }

    /// Whether every row has a colour.
    pub(super) fn have_colours(&self) -> bool {
        match self {
            Self::Csv(table) => table.has_colours(),
            Self::Xyz(_) => true,
        }
    }

    /// Appends a sphere for each row to `spheres`, in order, on all cores.
    pub(super) fn append(
        &self,
        recipe: &Recipe,
        spheres: &mut Vec<Sphere>,
    ) -> Result<(), Mistakes> {
        match self {
            Self::Csv(table) => table.append(recipe, spheres),
            Self::Xyz(atoms) => atoms.append(recipe, spheres),
        }
    }
}

/// Where a data file's radii come from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Radii {
    /// It has none.
    Missing,
    /// A column of its own.
    Column,
    /// The elements of its atoms; a scene may give another one.
    ByElement,
}

/// What the scene says about all rows of a data file.
pub(super) struct Recipe {
    /// The file as it is named in the scene.
    pub(super) file: Arc<str>,
    /// Where the file's origin is, in scene units.
    pub(super) offset: DVec3,
    /// Length of the file's unit, in scene units.
    pub(super) scale: f64,
    /// The radius of every sphere, in scene units; without it, rows have their own.
    pub(super) radius: Option<f64>,
    /// The surface, of which the albedo gives way to a row's colour.
    pub(super) surface: Option<Surface>,
}

impl Recipe {
    /// The sphere of a row, or a message for each field that does not allow one. The scene's
    /// reader sees to it that each row has a radius and a surface from the one or the other.
    fn sphere(&self, line: &Line<'_>, row: &Row<'_>, mistakes: &mut Mistakes) -> Option<Sphere> {
        let before = mistakes.count;
        let center = self.center(row, mistakes);
        let radius = self.radius(row, mistakes);
        if mistakes.count > before {
            return None;
        }
        let surface = self.surface(row.colour)?;
        let sphere = Sphere::new(center, radius?, surface).expect("each part was judged above");
        Some(sphere.at_row(&self.file, line.number))
    }

    /// offset + scale·(x, y, z)
    fn center(&self, row: &Row<'_>, mistakes: &mut Mistakes) -> DVec3 {
        let center = self.offset + self.scale * row.position;
        for (axis, name) in ["x", "y", "z"].into_iter().enumerate() {
            if center[axis].abs() <= MAX_LENGTH {
                continue;
            }
            mistakes.push(|| {
                let allowed = format!("a number from -{MAX_LENGTH:e} to {MAX_LENGTH:e}");
                let wrong = row.place[axis].wrong(name, &allowed);
                where_placed(wrong, row.position[axis], center[axis], "`scale` and `offset`")
            });
        }
        center
    }

    /// The scene's radius, or the row's in scene units.
    fn radius(&self, row: &Row<'_>, mistakes: &mut Mistakes) -> Option<f64> {
        if self.radius.is_some() {
            return self.radius;
        }
        let own = row.radius?;
        let radius = self.scale * own;
        if let Err(super::Invalid(allowed)) = check_radius(radius) {
            mistakes.push(|| {
                let wrong = row.radius_place.wrong("radius", &allowed);
                where_placed(wrong, own, radius, "`scale`")
            });
        }
        Some(radius)
    }

    /// The scene's, with the colour of the row if it has one.
    fn surface(&self, colour: Option<Albedo>) -> Option<Surface> {
        match (colour, self.surface) {
            (Some(albedo), Some(Surface::Glossy(_, exponent))) => {
                Some(Surface::Glossy(albedo, exponent))
            }
            (Some(albedo), _) => Some(Surface::Diffuse(albedo)),
            (None, surface) => surface,
        }
    }
}

/// Says what a number became in the scene, by `keys` of its cloud, where it is not the same there.
fn where_placed(wrong: Diagnostic, own: f64, placed: f64, keys: &str) -> Diagnostic {
    // Infinities and NaN speak for themselves.
    if own.is_finite() && own.to_bits() != placed.to_bits() {
        wrong.label(format!("{placed:.3e} in the scene, by {keys}"))
    } else {
        wrong
    }
}

/// What a row says, and where.
struct Row<'a> {
    /// In the file's unit.
    position: DVec3,
    place: [Field<'a>; 3],
    /// In the file's unit; `None` if the file has no radii.
    radius: Option<f64>,
    radius_place: Field<'a>,
    colour: Option<Albedo>,
}

/// What is wrong with a data file: the first mistakes, and how many there are.
#[derive(Debug, Default)]
pub(super) struct Mistakes {
    first: Vec<Diagnostic>,
    count: usize,
}

impl Mistakes {
    /// Counts a mistake, and keeps it if it is one of the first: a million bad rows are told
    /// in the memory of a few.
    fn push(&mut self, make: impl FnOnce() -> Diagnostic) {
        self.count += 1;
        if self.first.len() < MAX_SHOWN {
            self.first.push(make());
        }
    }

    /// Takes over the mistakes of a later part of the file.
    fn append(&mut self, later: Self) {
        self.count += later.count;
        self.first.extend(later.first);
        self.first.truncate(MAX_SHOWN);
    }

    fn none(self) -> Result<(), Self> {
        if self.count == 0 { Ok(()) } else { Err(self) }
    }
}

impl From<Diagnostic> for Mistakes {
    fn from(only: Diagnostic) -> Self {
        Self { first: vec![only], count: 1 }
    }
}
