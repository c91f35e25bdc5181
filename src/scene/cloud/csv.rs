//! Tables of spheres: a header with the names of columns, and a sphere in each row.

use glam::DVec3;

use super::fields::{Commas, Field};
use super::lines::{Line, Lines};
use super::{Diagnostic, Mistakes, Recipe, Row, Sphere};
use crate::scene::Albedo;
use crate::scene::error::quoted;
use crate::scene::spelling::nearest;

/// The columns that are read; others are passed over.
const COLUMNS: [&str; 7] = ["x", "y", "z", "radius", "r", "g", "b"];
const RADIUS: usize = 3;
const RED: usize = 4;

/// Names by which other programs call columns that would be missed without a word.
const OTHER_NAMES: [(&str, &str); 3] = [("red", "r"), ("green", "g"), ("blue", "b")];

const HEADER: &str = "the first line names the columns: `x,y,z`, `x,y,z,radius` or \
                      `x,y,z,radius,r,g,b`, in any order";
const COMMENTS: &str = "lines that start with `#` are comments";

/// A table whose header was read.
pub(crate) struct Table<'a> {
    /// For each field of a row, which of [`COLUMNS`] it is.
    fields: Vec<Option<usize>>,
    /// What is under the header.
    body: Lines<'a>,
}

impl<'a> Table<'a> {
    pub(super) fn new(text: &'a str) -> Result<Self, Mistakes> {
        let mut body = Lines::new(text);
        let Some(header) = body.find(is_data) else {
            return Err(Diagnostic::new(0..0, "this file has no rows").note(HEADER).into());
        };
        let names: Vec<Field<'_>> = Commas::new(header.start, header.text)
            .collect::<Result<_, _>>()
            .map_err(Mistakes::from)?;
        let fields = columns(&header, &names)?;
        if !body.clone().any(|line| is_data(&line)) {
            let at = body.start()..body.start();
            return Err(Diagnostic::new(at, "there are no rows under the header").into());
        }
        Ok(Self { fields, body })
    }

    pub(super) fn has_radius(&self) -> bool {
        self.fields.contains(&Some(RADIUS))
    }

    pub(super) fn has_colours(&self) -> bool {
        self.fields.contains(&Some(RED))
    }

    /// Appends the sphere of each row.
    pub(super) fn append(
        &self,
        recipe: &Recipe,
        spheres: &mut Vec<Sphere>,
    ) -> Result<(), Mistakes> {
        self.body.read(spheres, |line, mistakes| {
            let row = is_data(line).then(|| self.row(line, mistakes)).flatten()?;
            recipe.sphere(line, &row, mistakes)
        })
    }

    fn row<'l>(&self, line: &Line<'l>, mistakes: &mut Mistakes) -> Option<Row<'l>> {
        let before = mistakes.count;
        let places = self.places(line, mistakes)?;
        let mut numbers = [f64::NAN; COLUMNS.len()];
        for column in self.fields.iter().copied().flatten() {
            match places[column].number() {
                Some(number) => numbers[column] = number,
                None => mistakes.push(|| places[column].not_a_number(COLUMNS[column])),
            }
        }
        if mistakes.count > before {
            return None;
        }
        let [x, y, z, radius, rgb @ ..] = numbers;
        let [x_place, y_place, z_place, radius_place, colour_places @ ..] = places;
        let colour =
            if self.has_colours() { Some(colour(rgb, colour_places, mistakes)?) } else { None };
        Some(Row {
            position: DVec3::new(x, y, z),
            place: [x_place, y_place, z_place],
            radius: self.has_radius().then_some(radius),
            radius_place,
            colour,
        })
    }

    /// The field of each of [`COLUMNS`] that the table has.
    fn places<'l>(
        &self,
        line: &Line<'l>,
        mistakes: &mut Mistakes,
    ) -> Option<[Field<'l>; COLUMNS.len()]> {
        let end = Field::new(line.span().end, "");
        let mut places = [end; COLUMNS.len()];
        let mut count = 0;
        let mut first_beyond = end;
        for field in Commas::new(line.start, line.text) {
            let field = match field {
                Ok(field) => field,
                Err(wrong) => {
                    mistakes.push(|| wrong);
                    return None;
                }
            };
            match self.fields.get(count) {
                Some(&Some(column)) => places[column] = field,
                None if count == self.fields.len() => first_beyond = field,
                _ => (),
            }
            count += 1;
        }
        if count != self.fields.len() {
            mistakes.push(|| wrong_count(count, self.fields.len(), &first_beyond));
            return None;
        }
        Some(places)
    }
}

/// Row number `index`, from 0.
pub(super) fn row(text: &str, index: usize) -> Option<Line<'_>> {
    Lines::new(text).filter(is_data).nth(index + 1)
}

/// Whether a line is neither blank nor a comment. Spreadsheets write rows without entries as
/// commas.
fn is_data(line: &Line<'_>) -> bool {
    let text = line.text.trim_start_matches([' ', '\t', ',']);
    !text.is_empty() && !line.text.trim_start().starts_with('#')
}

/// Which of [`COLUMNS`] each name of the header is.
fn columns(header: &Line<'_>, names: &[Field<'_>]) -> Result<Vec<Option<usize>>, Mistakes> {
    if names.iter().all(|name| name.number().is_some()) {
        let wrong = Diagnostic::new(header.span(), "the header is missing");
        return Err(wrong.label("this is a row of numbers").note(HEADER).note(COMMENTS).into());
    }
    if header.text.to_ascii_lowercase().starts_with("sep=") {
        let wrong = Diagnostic::new(header.span(), "this line is no header");
        return Err(wrong.label("Excel reads it, others do not: take it out").note(HEADER).into());
    }
    if let ([only], Some(found)) = (names, header.text.chars().find(|c| ";\t ".contains(*c)))
        && only.span() == Field::new(header.start, header.text).span()
    {
        let separator = match found {
            ';' => "semicolons",
            '\t' => "tabs",
            _ => "spaces",
        };
        let wrong = Diagnostic::new(header.span(), "the columns must be separated by commas");
        let mend = "save it with `,` between the columns and `.` in the numbers";
        return Err(wrong.label(format!("here they are by {separator}")).note(mend).into());
    }
    let mut mistakes = Mistakes::default();
    let mut columns: Vec<Option<usize>> = Vec::new();
    for name in names {
        let lower = name.text().to_lowercase();
        let column = COLUMNS.iter().position(|&column| column == lower);
        if column.is_some() && columns.contains(&column) {
            mistakes.push(|| {
                let twice = format!("column {} is there twice", quoted(&lower));
                Diagnostic::new(name.span(), twice).label("the second one")
            });
        } else if let Some(meant) = column.is_none().then(|| meant(&lower)).flatten() {
            mistakes.push(|| {
                Diagnostic::new(name.span(), format!("unknown column {}", quoted(name.text())))
                    .label(format!("did you mean `{meant}`?"))
                    .note("columns of other names are allowed, but not ones so easily mistaken")
            });
        }
        columns.push(column);
    }
    if mistakes.count == 0 {
        missing(header, &columns, &mut mistakes);
    }
    mistakes.none().map(|()| columns)
}

/// The column that an unknown name stands for.
fn meant(name: &str) -> Option<&'static str> {
    let other = OTHER_NAMES.iter().find(|(other, _)| *other == name).map(|(_, meant)| *meant);
    other.or_else(|| nearest(name, COLUMNS.into_iter()))
}

/// Complains of columns that must be there.
fn missing(header: &Line<'_>, columns: &[Option<usize>], mistakes: &mut Mistakes) {
    let has_colour = (RED..COLUMNS.len()).any(|column| columns.contains(&Some(column)));
    for (column, name) in COLUMNS.iter().enumerate() {
        let needed = column < RADIUS || column >= RED && has_colour;
        if needed && !columns.contains(&Some(column)) {
            mistakes.push(|| {
                let wrong = Diagnostic::new(header.span(), format!("there is no column `{name}`"));
                if column < RADIUS {
                    wrong.note(HEADER)
                } else {
                    wrong.note("a colour takes all three of r, g and b")
                }
            });
        }
    }
}

fn wrong_count(count: usize, expected: usize, first_beyond: &Field<'_>) -> Diagnostic {
    let fields = if count == 1 { "field" } else { "fields" };
    let wrong = Diagnostic::new(
        first_beyond.span(),
        format!("this row has {count} {fields}, and the header {expected}"),
    );
    if count > expected {
        wrong.label("the first beyond").note("a decimal point is `.`")
    } else {
        wrong.label("the row ends here")
    }
}

fn colour(rgb: [f64; 3], places: [Field<'_>; 3], mistakes: &mut Mistakes) -> Option<Albedo> {
    let albedo = Albedo::new(rgb.into()).ok();
    if albedo.is_none() {
        for (column, (value, place)) in (RED..).zip(rgb.into_iter().zip(places)) {
            if (0.0..=1.0).contains(&value) {
                continue;
            }
            mistakes.push(|| {
                let wrong = place.wrong(COLUMNS[column], "an albedo from 0 to 1");
                if value > 1.0 && value <= 255.0 {
                    wrong.note("divide colours of 0 to 255 by 255; those of pictures, sRGB, are not linear")
                } else {
                    wrong
                }
            });
        }
    }
    albedo
}
