//! The tables that a scene has once: `[camera]`, `[image]` and `[render]`.

use glam::DVec3;
use toml::de::{DeTable, DeValue};

use super::clouds::clouds;
use super::folder::Folder;
use super::spheres::{materials, spheres};
use super::stray::list;
use super::table::{Field, Table};
use super::{Diagnostic, Log};
use crate::scene::cloud::Data;
use crate::scene::{Camera, Estimator, ImageSize, Invalid, RenderSettings, Scene, check_point};

const ROOT_KEYS: &[&str] = &["camera", "image", "render", "materials", "spheres", "clouds"];
const CAMERA_KEYS: &[&str] = &["position", "look_at", "up", "vertical_fov"];
const IMAGE_KEYS: &[&str] = &["width", "height"];
const RENDER_KEYS: &[&str] = &["spp", "bounces", "estimator", "seed"];

/// The whole scene, and the data of its clouds with the number of rows of each; `None` if a part
/// of it could not be read. A scene may come back although there are mistakes in the log.
pub(super) fn scene(
    root: &DeTable<'_>,
    folder: Folder<'_>,
    log: &mut Log,
) -> Option<(Scene, Vec<(Data, usize)>)> {
    let root = Table::new("the scene".to_owned(), 0..0, root, ROOT_KEYS, log);
    let camera = section(&root, "camera", CAMERA_KEYS, log).and_then(|table| camera(&table, log));
    let size = section(&root, "image", IMAGE_KEYS, log).and_then(|table| image(&table, log));
    let settings = root
        .optional("render")
        .and_then(|field| open(&field, RENDER_KEYS, log))
        .map_or_else(RenderSettings::default, |table| render(&table, log));
    let materials = materials(&root, log);
    let mut spheres = spheres(&root, materials.as_ref(), log);
    let clouds = clouds(&root, materials.as_ref(), folder, &mut spheres, log);
    Some((Scene::new(camera?, size?, settings, spheres), clouds))
}

/// A table that every scene has.
fn section<'a>(
    root: &Table<'a>,
    key: &str,
    allowed: &'static [&'static str],
    log: &mut Log,
) -> Option<Table<'a>> {
    let field = root.optional(key);
    if field.is_none() && !root.mistyped(key) {
        log.push(
            Diagnostic::new(root.span(), format!("the scene has no `[{key}]`"))
                .label("add it anywhere in the file")
                .note(format!("keys of `[{key}]`: {}", list(allowed.iter().copied()))),
        );
    }
    open(&field?, allowed, log)
}

/// The value of `field` as a table with a header of its own.
fn open<'a>(
    field: &Field<'a>,
    allowed: &'static [&'static str],
    log: &mut Log,
) -> Option<Table<'a>> {
    let header = format!("`[{}]`", field.key());
    let value = field.value();
    let DeValue::Table(entries) = value.get_ref() else {
        let mend = format!("write {header}, with single brackets, above its keys");
        log.push(field.wrong_type("a table").note(mend));
        return None;
    };
    Some(Table::new(header, value.span(), entries, allowed, log))
}

fn camera(table: &Table<'_>, log: &mut Log) -> Option<Camera> {
    let position = table
        .required("position", "where the camera is, as `[x, y, z]`", log)
        .and_then(|field| point(&field, log));
    let look_at = table
        .required("look_at", "the point that the camera faces, as `[x, y, z]`", log)
        .and_then(|field| point(&field, log).map(|point| (field, point)));
    let up_field = table.optional("up");
    let up = up_field.as_ref().map_or(Some(DVec3::Y), |field| point(field, log));
    let degrees = vertical_fov(table, log);

    let (position, (look_at_field, look_at), up) = (position?, look_at?, up?);
    // Without its angle the scene is refused already; the directions are judged all
    // the same. The points and the angle are right on their own, so what may be left
    // is that the camera looks at itself or along `up`.
    let camera = Camera::new(position, look_at, up, degrees.unwrap_or(90.0));
    let looks_at_itself = (look_at - position).try_normalize().is_none();
    match up_field {
        Some(up) if !looks_at_itself => up.accept(camera, log),
        None if !looks_at_itself => {
            let allowed = "a point that is not straight above or below the camera";
            let hint = "or give `up` another direction than its default, `[0.0, 1.0, 0.0]`";
            camera.map_err(|_| log.push(look_at_field.wrong(allowed).note(hint))).ok()
        }
        _ => look_at_field.accept(camera, log),
    }
}

/// The field of view in degrees.
fn vertical_fov(table: &Table<'_>, log: &mut Log) -> Option<f64> {
    let what = "the angle from the bottom to the top of the picture, in degrees";
    let field = table.required("vertical_fov", what, log)?;
    let degrees = field.number(log)?;
    // Everything else about this camera is right, so that only the angle is judged.
    let judged = Camera::new(DVec3::ZERO, DVec3::NEG_Z, DVec3::Y, degrees);
    field.accept(judged, log).map(|_| degrees)
}

/// Three coordinates.
pub(super) fn point(field: &Field<'_>, log: &mut Log) -> Option<DVec3> {
    let point = field.vector(log)?;
    field.accept(check_point(point), log).map(|()| point)
}

fn image(table: &Table<'_>, log: &mut Log) -> Option<ImageSize> {
    let mut side = |key, what| {
        let field = table.required(key, what, log)?;
        let pixels = narrow(field.whole(log)?);
        field.accept(ImageSize::new(pixels, pixels), log).map(|_| pixels)
    };
    let width = side("width", "the number of pixels in a row of the picture");
    let height = side("height", "the number of rows of pixels in the picture");
    Some(ImageSize::new(width?, height?).expect("each side was judged above"))
}

/// The settings of `[render]`; a key that could not be read keeps its default.
fn render(table: &Table<'_>, log: &mut Log) -> RenderSettings {
    let mut settings = RenderSettings::default();
    let mut set =
        |key, apply: fn(RenderSettings, &Field<'_>, &mut Log) -> Option<RenderSettings>| {
            if let Some(field) = table.optional(key) {
                settings = apply(settings, &field, log).unwrap_or(settings);
            }
        };
    set("spp", |settings, field, log| {
        let spp = field.whole(log)?;
        field.accept(settings.with_spp(spp), log)
    });
    set("bounces", |settings, field, log| {
        let bounces = narrow(field.whole(log)?);
        field.accept(settings.with_bounces(bounces), log)
    });
    set("estimator", |settings, field, log| Some(settings.with_estimator(estimator(field, log)?)));
    set("seed", |settings, field, log| {
        let seed = u32::try_from(field.whole(log)?)
            .map_err(|_| Invalid(format!("a whole number from 0 to {}", u32::MAX)));
        field.accept(seed, log).map(|seed| settings.with_seed(seed))
    });
    settings
}

fn estimator(field: &Field<'_>, log: &mut Log) -> Option<Estimator> {
    let name = field.text(log)?;
    let parsed = name.parse::<Estimator>();
    if let (Err(allowed), "auto") = (&parsed, name) {
        // What the pilot chooses depends on the device, so a scene cannot ask for it.
        log.push(field.wrong(&allowed.0).label("the command line takes --estimator auto"));
        return None;
    }
    field.accept(parsed, log)
}

/// A `u32` for the constructors to judge: what does not fit becomes [`u32::MAX`],
/// which is more than any of them allows.
fn narrow(n: u64) -> u32 {
    u32::try_from(n).unwrap_or(u32::MAX)
}
