//! What a scene calls for, decided once; the kernel is composed of nothing else.

use crate::light_tree::SCANNED_LIGHTS;
use crate::scene::{Estimator, Scene, Sphere, Surface};
use crate::viewpoint::{Form, Viewpoint, is_small};

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

/// An effect in words, and what calls for it.
struct Rule {
    effect: Effect,
    name: &'static str,
    /// What it does to the spheres that call for it; their names follow.
    role: &'static str,
    /// Whether it serves light sampling, and so has to meet [`SAMPLING`] first.
    samples_lights: bool,
    /// A sphere that meets all of them calls for the effect.
    conditions: &'static [Condition],
}

/// Something that has to hold, and what is said where no sphere meets it.
type Condition = (&'static str, fn(Seen, &Facts) -> bool);

const SCATTERS: Condition = ("no bounces", |_, facts| facts.scatters);

static SAMPLING: [Condition; 4] = [
    ("the estimator samples no lights", |_, facts| facts.samples_lights),
    SCATTERS,
    ("no surface to sample lights from", |_, facts| facts.connects),
    ("no lights", |seen, _| seen.emits()),
];

const fn rule(
    effect: Effect,
    name: &'static str,
    role: &'static str,
    conditions: &'static [Condition],
) -> Rule {
    Rule { effect, name, role, samples_lights: false, conditions }
}

const fn of_lights(
    effect: Effect,
    name: &'static str,
    role: &'static str,
    conditions: &'static [Condition],
) -> Rule {
    Rule { effect, name, role, samples_lights: true, conditions }
}

/// One entry for each effect, in the order of the enumeration.
#[rustfmt::skip]
static RULES: [Rule; 11] = [
    rule(Effect::Diffuse, "diffuse surfaces", "paths scatter at",
        &[SCATTERS, ("no diffuse sphere", |seen, _| seen.is_diffuse())]),
    rule(Effect::Glossy, "glossy surfaces", "paths scatter at",
        &[SCATTERS, ("no glossy sphere", |seen, _| seen.is_glossy())]),
    rule(Effect::Factored, "spheres of common size", "met by centre and radius:",
        &[("no sphere of common size", |seen, _| seen.form == Form::Factored)]),
    rule(Effect::Anchored, "huge spheres", "met by their surfaces near the focus:",
        &[("no huge sphere", |seen, _| seen.form == Form::Anchored)]),
    rule(Effect::Interior, "seen from inside", "the camera is in",
        &[("the camera is in no sphere", |seen, _| seen.inside)]),
    rule(Effect::Hierarchy, "hierarchy", "found by way of boxes around",
        &[("few enough spheres to go through all", |_, facts| facts.small > HIERARCHY_FROM),
          ("no small sphere", |seen, _| seen.is_small())]),
    of_lights(Effect::Connections, "light sampling", "where paths scatter, they connect to", &[]),
    of_lights(Effect::LightScan, "several lights: scanned", "one at a time is picked among",
        &[("one light", |_, facts| facts.lights > 1),
          ("more lights than are scanned", |_, facts| facts.lights <= SCANNED_LIGHTS)]),
    of_lights(Effect::LightTree, "many lights: a tree", "one at a time is picked among",
        &[("few enough lights to scan all", |_, facts| facts.lights > SCANNED_LIGHTS)]),
    of_lights(Effect::FactoredLight, "lights of common size", "cones by centre and radius:",
        &[("no light of common size", |seen, _| seen.form == Form::Factored)]),
    of_lights(Effect::AnchoredLight, "huge lights", "cones by their surfaces near the focus:",
        &[("no huge light", |seen, _| seen.form == Form::Anchored)]),
];

impl Rule {
    fn conditions(&self) -> impl Iterator<Item = &'static Condition> {
        let first: &[Condition] = if self.samples_lights { &SAMPLING } else { &[] };
        first.iter().chain(self.conditions)
    }

    fn holds(&self, seen: Seen, facts: &Facts) -> bool {
        self.conditions().all(|(_, holds)| holds(seen, facts))
    }
}

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
        self.sphere.emits()
    }

    fn is_small(self) -> bool {
        is_small(self.form, self.inside)
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
    /// Whether the estimator samples lights.
    samples_lights: bool,
    /// Whether there is a surface from which it does.
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
        let connects = match scene.settings().estimator() {
            Estimator::Implicit | Estimator::Cosine => false,
            Estimator::Explicit => diffuse,
            Estimator::Mis => diffuse || glossy,
        };
        Self {
            scatters: scene.settings().bounces() > 0,
            samples_lights: scene.settings().estimator().samples_lights(),
            connects,
            lights: all.clone().filter(|seen| seen.emits()).count(),
            small: all.filter(|seen| seen.is_small()).count(),
        }
    }
}

impl Effect {
    /// All of them.
    pub fn all() -> impl Iterator<Item = Self> {
        RULES.iter().map(|rule| rule.effect)
    }

    fn rule(self) -> &'static Rule {
        &RULES[self as usize]
    }

    /// What it is called.
    #[must_use]
    pub fn name(self) -> &'static str {
        self.rule().name
    }

    /// What it does to the spheres that call for it ([`causes`]), as the beginning of a sentence
    /// that ends with their names.
    #[must_use]
    pub fn role(self) -> &'static str {
        self.rule().role
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
        let called_for =
            |rule: &&Rule| all_seen(scene, viewpoint).any(|seen| rule.holds(seen, &facts));
        RULES.iter().filter(called_for).map(|rule| rule.effect).fold(Self::NONE, Self::with)
    }

    /// Those of the general kernel under a scene's estimator, which makes the same paths: every
    /// effect, but none that serves light sampling where the estimator samples no lights, or
    /// where there are none.
    #[must_use]
    pub fn general(scene: &Scene) -> Self {
        let samples_lights = scene.settings().estimator().samples_lights() && scene.has_lights();
        let serves = |rule: &&Rule| samples_lights || !rule.samples_lights;
        RULES.iter().filter(serves).map(|rule| rule.effect).fold(Self::NONE, Self::with)
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
    all_seen(scene, viewpoint)
        .filter(move |&seen| effect.rule().holds(seen, &facts))
        .map(|seen| seen.sphere)
}

/// Why a scene does not call for an effect: the first condition that none of its spheres meets
/// together with those before it. None if it does call for it.
#[must_use]
pub fn left_out(effect: Effect, scene: &Scene, viewpoint: &Viewpoint) -> Option<&'static str> {
    let facts = Facts::of(scene, viewpoint);
    let conditions = || effect.rule().conditions();
    let met = |seen| conditions().take_while(|(_, holds)| holds(seen, &facts)).count();
    let most = all_seen(scene, viewpoint).map(met).max().unwrap_or(0);
    conditions().nth(most).map(|(absence, _)| *absence)
}

#[cfg(test)]
mod tests {
    use super::{Effect, RULES};

    #[test]
    fn every_effect_has_its_rule() {
        for (place, rule) in (0..).zip(&RULES) {
            assert_eq!(rule.effect as u32, place);
        }
        assert_eq!(RULES.len(), Effect::AnchoredLight as usize + 1);
    }
}
