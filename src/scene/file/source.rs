//! The text that a scene was read from, for what turns out to be wrong with it later.

use std::ops::Range;

use toml::de::{DeTable, DeValue};

use crate::scene::cloud::Data;
use crate::scene::error::{Diagnostic, SceneFileError};

/// A scene file that was read, with the places of its spheres and its camera, and its data files.
#[derive(Debug, Clone)]
pub struct Source {
    name: String,
    text: String,
    /// Each sphere's `radius`, or its header where there is none.
    spheres: Vec<Range<usize>>,
    /// The camera's field of view.
    field_of_view: Range<usize>,
    /// The data files, each with its number of rows; their spheres follow those above.
    clouds: Vec<(Data, usize)>,
}

impl Source {
    pub(super) fn new(
        name: &str,
        text: &str,
        root: &DeTable<'_>,
        clouds: Vec<(Data, usize)>,
    ) -> Self {
        let spheres = root.get("spheres").and_then(|value| value.get_ref().as_array());
        let radius = |item: &toml::Spanned<DeValue<'_>>| place_in(item, "radius");
        Self {
            name: name.to_owned(),
            text: text.to_owned(),
            spheres: spheres.into_iter().flatten().map(radius).collect(),
            field_of_view: root.get("camera").map_or(0..0, |c| place_in(c, "vertical_fov")),
            clouds,
        }
    }

    /// A message about a sphere, by its number counted from 1, or about the field of view.
    #[must_use]
    pub fn complain(&self, sphere: Option<usize>, what: &str, allowed: &str) -> SceneFileError {
        let wrong = |span| Diagnostic::new(span, what).note(allowed);
        let index = sphere.map(|ordinal| ordinal.wrapping_sub(1));
        if let Some((data, row)) = index.and_then(|index| self.row(index)) {
            return data.clone().refuse(wrong(data.row(row)).into());
        }
        let span = match index {
            Some(index) => self.spheres.get(index).cloned().unwrap_or(0..0),
            None => self.field_of_view.clone(),
        };
        SceneFileError::Invalid {
            name: self.name.clone(),
            text: self.text.clone(),
            diagnostics: vec![wrong(span)],
            others: 0,
        }
    }

    /// The data file that sphere number `index`, from 0, is from, and which of its rows it is.
    fn row(&self, index: usize) -> Option<(&Data, usize)> {
        let mut row = index.checked_sub(self.spheres.len())?;
        for (data, rows) in &self.clouds {
            if row < *rows {
                return Some((data, row));
            }
            row -= rows;
        }
        None
    }
}

/// The place of a key's value in a table, or of the table.
fn place_in(table: &toml::Spanned<DeValue<'_>>, key: &str) -> Range<usize> {
    let value = table.get_ref().as_table().and_then(|entries| entries.get(key));
    value.map_or_else(|| table.span(), toml::Spanned::span)
}
