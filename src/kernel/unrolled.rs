//! Searches among a few spheres, in straight-line code, one statement each.

use crate::viewpoint::Form;

/// Places of the spheres in the uniform buffer, with their forms, in the order of the
/// scene file: factored spheres come first there, each group in the order of the file.
fn places(forms: &[Form]) -> Vec<(&'static str, u32)> {
    let mut factored = 0..;
    let mut anchored = (0..).skip(forms.iter().filter(|&&form| form == Form::Factored).count());
    forms
        .iter()
        .filter_map(|form| match form {
            Form::Factored => Some(("factored", factored.next()?)),
            Form::Anchored => Some(("anchored", anchored.next()?)),
        })
        .collect()
}

/// Whether anything hides a light, in straight-line code, in the order of the scene file;
/// where there is only one light, it is not asked. At equal distances the first in the file
/// is seen, here as in the search, so what stands before the light in the file hides it there.
pub(super) fn occluded(forms: &[Form], only: Option<u32>) -> String {
    let steps: String = places(forms)
        .into_iter()
        .map(|(form, i)| {
            let arguments = match form {
                "factored" => format!("shape_{i}.position, shape_{i}.size"),
                _ => format!("shape_{i}.position, shape_{i}.offset, shape_{i}.size"),
            };
            let distance = format!("distance_to({form}(ray, {arguments}), {i}u, leaving)");
            match only {
                Some(light) if light == i => "    earlier = first;\n".to_owned(),
                Some(_) => format!("    first = min(first, {distance});\n"),
                None => format!(
                    "    earlier = select(earlier, first, light == {i}u);\n    \
                     first = min(first, select({distance}, MISS, light == {i}u));\n"
                ),
            }
        })
        .collect();
    format!(
        "// Whether a sphere other than `light` is seen first: one that is nearer than\n\
         // `distance`, or as near and earlier in the scene file.\n\
         fn occluded(ray: Ray, leaving: u32, light: u32, distance: f32) -> bool {{\n    \
         var first = MISS;\n    var earlier = MISS;\n{steps}    \
         return first < distance || earlier <= distance;\n}}\n"
    )
}

/// Straight-line search. The shapes are loaded once a path and not once a segment, which
/// matters where a driver fetches uniforms lane by lane.
pub(super) fn nearest(forms: &[Form]) -> String {
    let places = places(forms);
    let lines = |line: &dyn Fn(&str, u32) -> String| -> String {
        places.iter().map(|&(form, i)| line(form, i)).collect()
    };
    let variables = lines(&|_, i| format!("var<private> shape_{i}: Shape;\n"));
    let loads = lines(&|_, i| format!("    shape_{i} = shape_of({i}u);\n"));
    let steps = lines(&|form, i| {
        format!("    best = closer_{form}(best, ray, shape_{i}, {i}u, leaving);\n")
    });
    format!(
        "// A few spheres: one statement each, in the order of the scene file, so that a\n\
         // strict comparison leaves the lowest index.\n\n\
         {variables}\n\
         fn load_shapes() {{\n{loads}}}\n\n\
         // `leaving` is the sphere that the ray starts on.\n\
         fn nearest(ray: Ray, leaving: u32) -> Hit {{\n    \
         var best = Hit(MISS, NO_SPHERE);\n{steps}    return best;\n}}\n"
    )
}
