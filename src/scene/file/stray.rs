//! Keys that have no place in a scene file: what was meant, or what is not simulated.

use std::ops::Range;

use crate::scene::error::{Diagnostic, quoted};
use crate::scene::spelling::nearest;

/// Something that other renderers simulate and candor does not.
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Effect {
    /// Completes "candor does not simulate …".
    name: &'static str,
    /// A note on what to do instead, where there is something.
    instead: Option<&'static str>,
    /// Keys that ask for it.
    keys: &'static [&'static str],
}

const EFFECTS: &[Effect] = &[
    Effect {
        name: "transparent materials or refraction",
        instead: None,
        keys: &[
            "refraction",
            "refractive_index",
            "ior",
            "transmission",
            "transmittance",
            "transparency",
            "opacity",
            "alpha",
            "glass",
            "dielectric",
            "dispersion",
        ],
    },
    Effect {
        name: "fog or anything else that scatters light between surfaces",
        instead: None,
        keys: &[
            "fog",
            "haze",
            "smoke",
            "medium",
            "media",
            "volume",
            "volumes",
            "scattering",
            "absorption",
            "density",
            "subsurface",
        ],
    },
    Effect {
        name: "textures",
        instead: None,
        keys: &["texture", "textures", "normal_map", "bump_map", "displacement", "checker"],
    },
    Effect {
        name: "perfect mirrors or metals",
        instead: Some("a `glossy` material with a large `exponent` comes near"),
        keys: &["mirror", "specular", "reflection", "metal", "metallic", "conductor", "roughness"],
    },
    Effect {
        name: "shapes other than spheres",
        instead: Some("a very large sphere can stand for a plane"),
        keys: &[
            "triangles",
            "triangle",
            "meshes",
            "mesh",
            "models",
            "planes",
            "plane",
            "boxes",
            "box",
            "cubes",
            "disks",
            "cylinders",
            "quads",
        ],
    },
    Effect {
        name: "depth of field",
        instead: None,
        keys: &[
            "aperture",
            "lens_radius",
            "f_stop",
            "focal_distance",
            "focus_distance",
            "focal_length",
        ],
    },
    Effect {
        name: "light from a background",
        instead: Some("a very large sphere with an `emission`, around the scene, comes near"),
        keys: &["environment", "envmap", "background", "sky", "sun", "ambient"],
    },
    Effect {
        name: "lights other than spheres",
        instead: Some("a light is a sphere with an `emission`"),
        keys: &["lights", "light", "point_light", "point_lights", "area_lights"],
    },
    Effect { name: "motion", instead: None, keys: &["motion", "velocity", "shutter", "animation"] },
];

/// What a key that is not allowed was most likely meant to be.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Stray {
    /// An effect that candor does not simulate.
    Effect(&'static Effect),
    /// Another spelling of this allowed key.
    Mistyped(&'static str),
    /// Nothing that can be guessed.
    Unknown,
}

impl Stray {
    /// Guesses what `key` was meant to be where only `allowed` keys are.
    pub(super) fn new(key: &str, allowed: &[&'static str]) -> Self {
        let asks = |effect: &&Effect| effect.keys.iter().any(|k| k.eq_ignore_ascii_case(key));
        if let Some(effect) = EFFECTS.iter().find(asks) {
            return Self::Effect(effect);
        }
        nearest(key, allowed.iter().copied()).map_or(Self::Unknown, Self::Mistyped)
    }

    /// The message for `key` at `span`, found in `place`.
    pub(super) fn explain(
        &self,
        key: &str,
        span: Range<usize>,
        place: &str,
        allowed: &[&str],
    ) -> Diagnostic {
        let key = quoted(key);
        if let Self::Effect(effect) = self {
            let diagnostic =
                Diagnostic::new(span, format!("candor does not simulate {}", effect.name))
                    .label(format!("{key} is not a key of {place}"))
                    .note("candor renders diffuse, glossy and glowing spheres in empty space");
            return match effect.instead {
                Some(instead) => diagnostic.note(instead),
                None => diagnostic,
            };
        }
        let unknown = Diagnostic::new(span, format!("unknown key {key} in {place}"))
            .note(format!("allowed here: {}", list(allowed.iter().copied())));
        match self {
            Self::Mistyped(meant) => unknown.label(format!("did you mean `{meant}`?")),
            _ => unknown,
        }
    }
}

/// The names for a message, cut after the first dozen.
pub(super) fn list<'a>(names: impl ExactSizeIterator<Item = &'a str>) -> String {
    const MOST: usize = 12;
    let more = names.len().saturating_sub(MOST);
    let mut listed: Vec<String> = names.take(MOST).map(quoted).collect();
    if more > 0 {
        listed.push(format!("and {more} more"));
    }
    listed.join(", ")
}

#[cfg(test)]
mod tests {
    use super::*;

    const SPHERE: &[&str] = &["name", "center", "radius", "material", "emission"];

    #[test]
    fn slips_are_recognised_and_other_words_are_not() {
        let meant = |key| Stray::new(key, SPHERE);
        assert_eq!(meant("centre"), Stray::Mistyped("center"));
        assert_eq!(meant("Radius"), Stray::Mistyped("radius"));
        assert_eq!(meant("materials"), Stray::Mistyped("material"));
        assert_eq!(meant("rad"), Stray::Mistyped("radius"));
        assert_eq!(meant("game"), Stray::Mistyped("name"));
        assert_eq!(meant("size"), Stray::Unknown);
        assert_eq!(meant(""), Stray::Unknown);
        assert_eq!(meant(&"radius".repeat(1000)), Stray::Unknown);
    }

    #[test]
    fn effects_come_before_slips() {
        let effect = |key| match Stray::new(key, &["plan", "iron"]) {
            Stray::Effect(effect) => effect.name,
            other => panic!("{other:?}"),
        };
        assert_eq!(effect("IOR"), "transparent materials or refraction");
        assert_eq!(effect("planes"), "shapes other than spheres");
    }

    #[test]
    fn long_lists_are_cut() {
        let names: Vec<String> = (0..14).map(|i| i.to_string()).collect();
        let listed = list(names.iter().map(String::as_str));
        assert!(listed.ends_with("`10`, `11`, and 2 more"), "{listed}");
    }
}
