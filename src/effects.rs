//! What a scene calls for, decided once; the kernel is composed of nothing else.

use crate::light_tree::SCANNED_LIGHTS;
use crate::scene::{Estimator, Scene, Sphere, Surface};
use crate::viewpoint::{Form, Viewpoint};

/// Scenes with more small spheres than this get a hierarchy over them; for fewer, going
/// through all of them is faster (BENCHMARKS.md, "From one sphere to a million").
pub const HIERARCHY_FROM: usize = 64;

/// Something that a kernel can simulate, or that a scene may need it to handle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum Effect {
    /// Paths scatter at diffuse surfaces.
    Diffuse,
    /// Paths scatter at glossy surfaces.
    Glossy,
    /// Spheres are met by centre and radius.
    Factored,
    /// Huge spheres are met by their surfaces near the focus.
    Anchored,
    /// The camera is inside a sphere, whose inner side is then seen.
    Interior,
    /// Spheres are found through a hierarchy of boxes.
    Hierarchy,
    /// Lights are sampled where paths scatter.
    Connections,
    /// One of several lights is picked by a scan of all of them.
    LightScan,
    /// One of many lights is picked by a walk down a tree of them.
    LightTree,
    /// A light that is sampled is seen as a cone by centre and radius.
    FactoredLight,
    /// A light that is sampled is huge, and seen as a cone by its surface.
    AnchoredLight,
}

/// One line for each effect: the spheres that call for it.
const RULES: [(Effect, fn(Seen, &Facts) -> bool); 11] = [
    (Effect::Diffuse, |seen, facts| facts.scatters && seen.is_diffuse()),
    (Effect::Glossy, |seen, facts| facts.scatters && seen.is_glossy()),
    (Effect::Factored, |seen, _| seen.form == Form::Factored),
    (Effect::Anchored, |seen, _| seen.form == Form::Anchored),
    (Effect::Interior, |seen, _| seen.inside),
    (Effect::Hierarchy, |seen, facts| facts.small > HIERARCHY_FROM && seen.is_small()),
    (Effect::Connections, |seen, facts| facts.connects && seen.emits()),
    (Effect::LightScan, |seen, facts| {
        facts.connects && (2..=SCANNED_LIGHTS).contains(&facts.lights) && seen.emits()
    }),
    (Effect::LightTree, |seen, facts| {
        facts.connects && facts.lights > SCANNED_LIGHTS && seen.emits()
    }),
    (Effect::FactoredLight, |seen, facts| {
        facts.connects && seen.emits() && seen.form == Form::Factored
    }),
    (Effect::AnchoredLight, |seen, facts| {
        facts.connects && seen.emits() && seen.form == Form::Anchored
    }),
];

/// A sphere, and how it is seen.
#[derive(Clone, Copy)]
struct Seen<'a> {
    sphere: &'a Sphere,
    form: Form,
    inside: bool,
}

impl Seen<'_> {
    fn is_diffuse(self) -> bool {
        matches!(self.sphere.surface(), Surface::Diffuse(_))
    }

    fn is_glossy(self) -> bool {
        matches!(self.sphere.surface(), Surface::Glossy(..))
    }

    fn emits(self) -> bool {
        matches!(self.sphere.surface(), Surface::Emitter(_))
    }

    /// Whether a hierarchy may hold it.
    fn is_small(self) -> bool {
        self.form == Form::Factored && !self.inside
    }
}

fn all_seen<'a>(
    scene: &'a Scene,
    viewpoint: &'a Viewpoint,
) -> impl Iterator<Item = Seen<'a>> + Clone {
    let sides = viewpoint.forms().iter().zip(viewpoint.inside());
    let spheres = scene.spheres().iter().zip(sides);
    spheres.map(|(sphere, (&form, &inside))| Seen { sphere, form, inside })
}

/// What holds for a whole scene.
struct Facts {
    /// Whether a path may scatter.
    scatters: bool,
    /// Whether there is a surface from which the estimator samples lights.
    connects: bool,
    lights: usize,
    /// Spheres that a hierarchy may hold.
    small: usize,
}

impl Facts {
    fn of(scene: &Scene, viewpoint: &Viewpoint) -> Self {
        let all = all_seen(scene, viewpoint);
        let (diffuse, glossy) =
            (all.clone().any(Seen::is_diffuse), all.clone().any(Seen::is_glossy));
        let scatters = scene.settings().bounces() > 0;
        let from_here = match scene.settings().estimator() {
            Estimator::Implicit | Estimator::Cosine => false,
            Estimator::Explicit => diffuse,
            Estimator::Mis => diffuse || glossy,
        };
        Self {
            scatters,
            connects: scatters && from_here,
            lights: all.clone().filter(|seen| seen.emits()).count(),
            small: all.filter(|seen| seen.is_small()).count(),
        }
    }
}

/// A set of effects.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Effects(u32);

impl Effects {
    /// No effect: a picture of nothing.
    pub const NONE: Self = Self(0);

    /// Every effect there is.
    pub const ALL: Self = Self((1 << RULES.len()) - 1);

    /// Those that a scene calls for.
    #[must_use]
    pub fn of(scene: &Scene, viewpoint: &Viewpoint) -> Self {
        let facts = Facts::of(scene, viewpoint);
        let called_for = |&(effect, rule): &(Effect, fn(Seen, &Facts) -> bool)| {
            all_seen(scene, viewpoint).any(|seen| rule(seen, &facts)).then_some(effect)
        };
        RULES.iter().filter_map(called_for).fold(Self::NONE, Self::with)
    }

    /// Whether an effect is among them.
    #[must_use]
    pub fn has(self, effect: Effect) -> bool {
        self.0 & (1 << effect as u32) != 0
    }

    /// These and one more.
    #[must_use]
    pub fn with(self, effect: Effect) -> Self {
        Self(self.0 | 1 << effect as u32)
    }

    /// These but one.
    #[must_use]
    pub fn without(self, effect: Effect) -> Self {
        Self(self.0 & !(1 << effect as u32))
    }
}

/// The spheres that call for an effect, in the order of the scene file.
pub fn causes<'a>(
    effect: Effect,
    scene: &'a Scene,
    viewpoint: &'a Viewpoint,
) -> impl Iterator<Item = &'a Sphere> {
    let facts = Facts::of(scene, viewpoint);
    let rule = RULES[effect as usize].1;
    all_seen(scene, viewpoint).filter(move |&seen| rule(seen, &facts)).map(|seen| seen.sphere)
}

#[cfg(test)]
mod tests {
    use super::{Effect, RULES};

    #[test]
    fn every_effect_has_its_line() {
        for (place, (effect, _)) in (0..).zip(RULES) {
            assert_eq!(effect as u32, place);
        }
        assert_eq!(RULES.len(), Effect::AnchoredLight as usize + 1);
    }
}
