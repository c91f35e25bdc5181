//! The searches among all spheres: written out for a few, or by groups of them.

use super::text::{Text, fragment};
use super::unrolled;
use crate::effects::{Effect, Effects};
use crate::viewpoint::Form;

/// The statement that loads a few spheres.
pub(super) const LOAD: &str = "    load_shapes();\n";

/// The groups that spheres are searched in, by the ends of their functions' names.
fn groups(effects: Effects) -> Vec<&'static str> {
    let hierarchy = effects.has(Effect::Hierarchy);
    // Those that hold the camera are not under the hierarchy.
    let factored = effects.has(Effect::Factored) && (!hierarchy || effects.has(Effect::Interior));
    let groups = [
        (hierarchy, "hierarchy"),
        (factored, "factored"),
        (effects.has(Effect::Anchored), "anchored"),
    ];
    groups.into_iter().filter_map(|(is_there, name)| is_there.then_some(name)).collect()
}

/// What is asked of a single sphere, in those groups that no hierarchy holds.
fn one_by_one(text: &mut Text, effects: Effects, groups: &[&str]) {
    if groups.iter().all(|&group| group == "hierarchy") {
        return;
    }
    if effects.has(Effect::Interior) {
        text.add(fragment!("exit")).add(fragment!("interior"));
    } else {
        text.add(fragment!("exterior"));
    }
    text.add(fragment!("closer"));
    if groups.contains(&"factored") {
        text.add(fragment!("closer_factored"));
    }
    if groups.contains(&"anchored") {
        text.add(fragment!("closer_anchored"));
    }
}

/// `nearest`: the sphere that a ray meets first. Whichever group it is in, at equal distances
/// the first in the scene file is met.
pub(super) fn nearest(text: &mut Text, effects: Effects, written: Option<&[Form]>) {
    let groups = groups(effects);
    one_by_one(text, effects, &groups);
    if let Some(forms) = written {
        text.push(unrolled::nearest(forms));
        return;
    }
    for group in &groups {
        text.add(match *group {
            "hierarchy" => fragment!("nearest_hierarchy"),
            "factored" => fragment!("nearest_factored"),
            _ => fragment!("nearest_anchored"),
        });
    }
    if groups.len() > 1 {
        text.add(fragment!("nearer"));
    }
    let found = groups.iter().map(|group| format!("nearest_{group}(ray, leaving)"));
    let nearest = found.reduce(|found, next| format!("nearer({found}, {next})"));
    text.push(format!(
        "// `leaving` is the sphere that the ray starts on.\n\
         fn nearest(ray: Ray, leaving: u32) -> Hit {{\n    return {};\n}}\n",
        nearest.unwrap_or_else(|| "Hit(MISS, NO_SPHERE)".to_owned())
    ));
}

/// `occluded`: whether a sphere other than a light is seen before it.
pub(super) fn occluded(
    text: &mut Text,
    effects: Effects,
    written: Option<&[Form]>,
    only: Option<u32>,
) {
    if let Some(forms) = written {
        text.push(unrolled::occluded(forms, only));
        return;
    }
    let groups = groups(effects);
    for group in &groups {
        text.add(match *group {
            "hierarchy" => fragment!("occluded_hierarchy"),
            "factored" => fragment!("occluded_factored"),
            _ => fragment!("occluded_anchored"),
        });
    }
    let by = |group: &&str| format!("occluded_{group}(ray, leaving, light, distance)");
    let any: Vec<String> = groups.iter().map(by).collect();
    text.push(format!(
        "// Whether a sphere other than `light` is seen first: one that is nearer than\n\
         // `distance`, or as near and earlier in the scene file.\n\
         fn occluded(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {{\n    \
         return {};\n}}\n",
        any.join("\n        || ")
    ));
}
