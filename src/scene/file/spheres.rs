//! `[materials.*]` and `[[spheres]]`.

use std::collections::BTreeMap;

use toml::Spanned;
use toml::de::DeValue;

use super::sections::point;
use super::stray::list;
use super::table::{Field, Table, found};
use super::{Diagnostic, Log};
use crate::scene::error::quoted;
use crate::scene::spelling::nearest;
use crate::scene::sphere::title;
use crate::scene::{Albedo, Exponent, Radiance, Sphere, Surface, check_radius};

const MATERIAL_KEYS: &[&str] = &["diffuse", "glossy", "exponent"];
const SPHERE_KEYS: &[&str] = &["name", "center", "radius", "material", "emission"];

/// How to mend a material that is not a table.
const MATERIAL_HEADER: &str =
    "write a material under a header with its name, such as `[materials.red]`";

/// The surfaces by name; `None` for a material that has a mistake, so that it still
/// counts as defined.
pub(super) type Materials<'a> = BTreeMap<&'a str, Option<Surface>>;

/// All materials, of which a scene may have none; `None` if there is no telling which
/// are defined.
pub(super) fn materials<'a>(root: &Table<'a>, log: &mut Log) -> Option<Materials<'a>> {
    let Some(field) = root.optional("materials") else {
        return (!root.mistyped("materials")).then(Materials::new);
    };
    let DeValue::Table(entries) = field.value().get_ref() else {
        log.push(field.wrong_type("a table of materials").note(MATERIAL_HEADER));
        return None;
    };
    let mut materials = Materials::new();
    for (name, value) in entries {
        materials.insert(name.get_ref(), material(name.get_ref(), value, log));
    }
    Some(materials)
}

fn material<'a>(name: &str, value: &'a Spanned<DeValue<'a>>, log: &mut Log) -> Option<Surface> {
    let DeValue::Table(entries) = value.get_ref() else {
        log.push(
            Diagnostic::new(value.span(), format!("material {} must be a table", quoted(name)))
                .label(found(value.get_ref()))
                .note(MATERIAL_HEADER),
        );
        return None;
    };
    let place = format!("material {}", quoted(name));
    let table = Table::new(place, value.span(), entries, MATERIAL_KEYS, log);
    let exponent = table.optional("exponent");
    match one_of(&table, ["diffuse", "glossy"], log) {
        One::First(diffuse) => {
            if let Some(exponent) = exponent {
                log.push(
                    Diagnostic::new(exponent.key_span(), "a `diffuse` material has no `exponent`")
                        .note("take it out, or write `glossy` for `diffuse`"),
                );
            }
            Some(Surface::Diffuse(albedo(&diffuse, log)?))
        }
        One::Second(glossy) => {
            let what = "how sharp the reflections are, a number such as 100.0";
            let exponent = table.required("exponent", what, log).and_then(|field| {
                let n = field.number(log)?;
                field.accept(Exponent::new(n), log)
            });
            Some(Surface::Glossy(albedo(&glossy, log)?, exponent?))
        }
        One::Unclear => None,
    }
}

fn albedo(field: &Field<'_>, log: &mut Log) -> Option<Albedo> {
    let rho = field.vector(log)?;
    field.accept(Albedo::new(rho), log)
}

/// Which of two keys a table has.
enum One<'a> {
    First(Field<'a>),
    Second(Field<'a>),
    /// Both or neither.
    Unclear,
}

/// The one key of the two that the table has, with a message if it has both or
/// neither.
fn one_of<'a>(table: &Table<'a>, keys: [&str; 2], log: &mut Log) -> One<'a> {
    let place = table.place();
    let [first, second] = keys;
    match keys.map(|key| table.optional(key)) {
        [Some(a), Some(b)] => {
            let later = if a.key_span().start > b.key_span().start { &a } else { &b };
            log.push(
                Diagnostic::new(
                    later.key_span(),
                    format!("{place} has both `{first}` and `{second}`"),
                )
                .note("only one of them is allowed"),
            );
            One::Unclear
        }
        [Some(a), None] => One::First(a),
        [None, Some(b)] => One::Second(b),
        [None, None] => {
            // What was written in their place has a message already.
            if !table.asks_for_effect() && !keys.iter().any(|key| table.mistyped(key)) {
                log.push(
                    Diagnostic::new(
                        table.span(),
                        format!("{place} has neither `{first}` nor `{second}`"),
                    )
                    .note("exactly one of them is needed"),
                );
            }
            One::Unclear
        }
    }
}

/// All spheres without a mistake, in order. `materials` as [`materials`] gave them.
pub(super) fn spheres(
    root: &Table<'_>,
    materials: Option<&Materials<'_>>,
    log: &mut Log,
) -> Vec<Sphere> {
    let Some(field) = root.optional("spheres") else {
        return Vec::new();
    };
    let DeValue::Array(items) = field.value().get_ref() else {
        log.push(
            field
                .wrong_type("a list of tables")
                .note("write `[[spheres]]`, with two brackets, above the keys of each sphere"),
        );
        return Vec::new();
    };
    items
        .iter()
        .enumerate()
        .filter_map(|(index, item)| sphere(index + 1, item, materials, log))
        .collect()
}

/// Sphere number `ordinal`, counted from 1.
fn sphere<'a>(
    ordinal: usize,
    value: &'a Spanned<DeValue<'a>>,
    materials: Option<&Materials<'_>>,
    log: &mut Log,
) -> Option<Sphere> {
    let DeValue::Table(entries) = value.get_ref() else {
        log.push(
            Diagnostic::new(value.span(), format!("sphere {ordinal} must be a table"))
                .label(found(value.get_ref()))
                .note("write `[[spheres]]` above the keys of each sphere"),
        );
        return None;
    };
    let name = entries.get("name").and_then(|name| name.get_ref().as_str());
    let table = Table::new(title(ordinal, name), value.span(), entries, SPHERE_KEYS, log);
    if let Some(field) = table.optional("name") {
        field.text(log);
    }
    let center = table
        .required("center", "the middle of the sphere, as `[x, y, z]`", log)
        .and_then(|field| point(&field, log));
    let radius = table.required("radius", "half the width of the sphere", log).and_then(|field| {
        let radius = field.number(log)?;
        field.accept(check_radius(radius), log).map(|()| radius)
    });
    let surface = surface(&table, materials, log);
    let sphere =
        Sphere::new(center?, radius?, surface?).expect("centre and radius were judged above");
    Some(match name {
        Some(name) => sphere.named(name),
        None => sphere,
    })
}

fn surface(table: &Table<'_>, materials: Option<&Materials<'_>>, log: &mut Log) -> Option<Surface> {
    match one_of(table, ["material", "emission"], log) {
        One::First(material) => material_named(&material, materials, log),
        One::Second(emission) => {
            let radiance = emission.vector(log)?;
            emission.accept(Radiance::new(radiance), log).map(Surface::Emitter)
        }
        One::Unclear => None,
    }
}

/// The surface of the material that a key names.
pub(super) fn material_named(
    field: &Field<'_>,
    materials: Option<&Materials<'_>>,
    log: &mut Log,
) -> Option<Surface> {
    let name = field.text(log)?;
    // Without a table of materials there is a message already.
    let materials = materials?;
    let surface = materials.get(name);
    if surface.is_none() {
        log.push(undefined(name, field, materials));
    }
    *surface?
}

fn undefined(name: &str, field: &Field<'_>, materials: &Materials<'_>) -> Diagnostic {
    let diagnostic =
        Diagnostic::new(field.value().span(), format!("material {} is not defined", quoted(name)));
    let diagnostic = match nearest(name, materials.keys().copied()) {
        Some(meant) => diagnostic.label(format!("did you mean {}?", quoted(meant))),
        None => diagnostic,
    };
    if materials.is_empty() {
        diagnostic.note("this file defines no materials").note(MATERIAL_HEADER)
    } else {
        diagnostic.note(format!("defined: {}", list(materials.keys().copied())))
    }
}
