//! `[[clouds]]`: spheres from data files.

use glam::DVec3;
use toml::Spanned;
use toml::de::DeValue;

use super::folder::Folder;
use super::sections::point;
use super::spheres::{Materials, material_named};
use super::table::{Field, Table, found};
use super::{Diagnostic, Invalid, Log};
use crate::scene::cloud::{Data, Format, Radii, Recipe, Rows};
use crate::scene::error::quoted;
use crate::scene::{MAX_LENGTH, MIN_RADIUS, Sphere, check_radius};

const CLOUD_KEYS: &[&str] = &["file", "radius", "material", "scale", "offset"];

/// Appends the spheres of all clouds to `spheres`, cloud by cloud and row by row, and returns
/// the data with the number of rows of each. `materials` as for the spheres of the scene file.
pub(super) fn clouds(
    root: &Table<'_>,
    materials: Option<&Materials<'_>>,
    folder: Folder<'_>,
    spheres: &mut Vec<Sphere>,
    log: &mut Log,
) -> Vec<(Data, usize)> {
    let Some(field) = root.optional("clouds") else {
        return Vec::new();
    };
    let DeValue::Array(items) = field.value().get_ref() else {
        let mend = "write `[[clouds]]`, with two brackets, above the keys of each cloud";
        log.push(field.wrong_type("a list of tables").note(mend));
        return Vec::new();
    };
    let mut folder = folder;
    (1..)
        .zip(items)
        .filter_map(|(number, item)| {
            let cloud = cloud(number, item, materials, log)?;
            let data = folder.read(&cloud.file, cloud.format, log)?;
            let before = spheres.len();
            cloud.append(&data, spheres, log)?;
            Some((data, spheres.len() - before))
        })
        .collect()
}

/// One table of `[[clouds]]`.
struct Cloud<'a> {
    table: Table<'a>,
    file: Field<'a>,
    format: Format,
    radius: Option<Field<'a>>,
    recipe: Recipe,
}

/// Cloud number `number`, counted from 1.
fn cloud<'a>(
    number: usize,
    value: &'a Spanned<DeValue<'a>>,
    materials: Option<&Materials<'_>>,
    log: &mut Log,
) -> Option<Cloud<'a>> {
    let DeValue::Table(entries) = value.get_ref() else {
        log.push(
            Diagnostic::new(value.span(), format!("cloud {number} must be a table"))
                .label(found(value.get_ref()))
                .note("write `[[clouds]]` above the keys of each cloud"),
        );
        return None;
    };
    let place = match entries.get("file").and_then(|file| file.get_ref().as_str()) {
        Some(file) => format!("cloud {number} ({})", quoted(file)),
        None => format!("cloud {number}"),
    };
    let table = Table::new(place, value.span(), entries, CLOUD_KEYS, log);
    let file = table
        .required("file", "the name of a data file, such as \"points.csv\"", log)
        .and_then(|field| Some((named(&field, log)?, field)));
    let radius = optional(&table, "radius", log, |field, log| {
        let radius = field.number(log)?;
        field.accept(check_radius(radius), log).map(|()| radius)
    });
    let scale = optional(&table, "scale", log, |field, log| {
        let scale = field.number(log)?;
        field.accept(check_scale(scale), log).map(|()| scale)
    });
    let offset = optional(&table, "offset", log, point);
    let surface =
        optional(&table, "material", log, |field, log| material_named(field, materials, log));
    let ((name, format), file) = file?;
    let recipe = Recipe {
        file: name.into(),
        offset: offset.ok()?.unwrap_or(DVec3::ZERO),
        scale: scale.ok()?.unwrap_or(1.0),
        radius: radius.ok()?,
        surface: surface.ok()?,
    };
    let radius = table.optional("radius");
    Some(Cloud { table, file, format, radius, recipe })
}

/// Stands for a mistake that is in the log.
struct Told;

/// What `read` makes of a key; `None` if the table does not have it.
fn optional<'a, T>(
    table: &Table<'a>,
    key: &str,
    log: &mut Log,
    read: impl FnOnce(&Field<'a>, &mut Log) -> Option<T>,
) -> Result<Option<T>, Told> {
    table.optional(key).map(|field| read(&field, log).ok_or(Told)).transpose()
}

/// The name of a data file, and its format.
fn named<'a>(field: &Field<'a>, log: &mut Log) -> Option<(&'a str, Format)> {
    let name = field.text(log)?;
    // What is written to a terminal as part of a message must do nothing to it.
    let format = Format::of(name).filter(|_| !name.contains(char::is_control));
    if format.is_none() {
        let allowed = "the name of a file that ends in `.csv` or `.xyz`";
        let columns = "a .csv has a header with x, y, z, and perhaps radius, and r, g, b";
        log.push(field.wrong(allowed).note(columns).note("an .xyz is a list of atoms"));
    }
    Some((name, format?))
}

fn check_scale(scale: f64) -> Result<(), Invalid> {
    if (MIN_RADIUS..=MAX_LENGTH).contains(&scale) {
        Ok(())
    } else {
        Err(Invalid(format!("a number from {MIN_RADIUS:e} to {MAX_LENGTH:e}")))
    }
}

impl Cloud<'_> {
    /// Appends the sphere of each row of `data`.
    fn append(&self, data: &Data, spheres: &mut Vec<Sphere>, log: &mut Log) -> Option<()> {
        let read = data.open().map(|rows| {
            self.suits(&rows, log)?;
            Some(rows.append(&self.recipe, spheres))
        });
        match read {
            Ok(None) => None,
            Ok(Some(Ok(()))) => Some(()),
            Ok(Some(Err(mistakes))) | Err(mistakes) => {
                log.blame(data, mistakes);
                None
            }
        }
    }

    /// Whether the table and the file together say what every sphere is.
    fn suits(&self, rows: &Rows<'_>, log: &mut Log) -> Option<()> {
        let lacks = |key: &str| {
            Diagnostic::new(self.table.span(), format!("{} has no `{key}`", self.table.place()))
        };
        let mut suits = true;
        match (&self.radius, rows.radii()) {
            (None, Radii::Missing) => {
                suits = false;
                if !self.table.mistyped("radius") {
                    log.push(lacks("radius").note(
                        "`radius` is that of every sphere of a file without a column `radius`",
                    ));
                }
            }
            (Some(radius), Radii::Column) => {
                suits = false;
                let file = quoted(&self.recipe.file);
                let twice = format!("`radius` is given here and in a column of {file}");
                log.push(
                    Diagnostic::new(radius.key_span(), twice)
                        .note("take one of them out; `scale` resizes those of the column"),
                );
            }
            _ => (),
        }
        if self.recipe.surface.is_none() && !rows.have_colours() {
            suits = false;
            if !self.table.mistyped("material") {
                log.push(lacks("material").note(
                    "`material` is that of every sphere of a file without columns `r`, `g`, `b`",
                ));
            }
        }
        suits.then_some(())
    }
}
