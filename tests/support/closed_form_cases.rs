//! The table of scenes with known radiance, and the loop that holds a tracer to it.

use super::closed_form::{
    hemisphere_second_moment, integrating_sphere, lobe_above_horizon, lobe_albedo, lobe_at_light,
    sphere_form_factor,
};
use super::closed_form_scenes::{
    HOLLOW_RADIUS, body, diffuse, emitter, glossy, hollow, light, seen_along, seen_from, seen_wide,
    shell, sphere,
};
use super::judge::{Estimate, Quantity, detectable, deviation, is_exactly, limit};
use candor::film::Film;
use candor::scene::{Estimator, Scene, Sphere};
use candor::tracer::Tracer;

/// Exponents and angles, in degrees, at which Phong lobes are held to their albedo.
const EXPONENTS: [f64; 7] = [0.0, 1.0, 5.0, 50.0, 1e4, 1e7, 1e10];
const ANGLES: [f64; 5] = [0.0, 30.0, 60.0, 80.0, 89.9];

/// Radii of one wall, from the scene's own scale to one at which `f32` has 64 units
/// between neighbours.
const WALL_RADII: [f64; 6] = [1.0, 1e5, 1e6, 1e7, 1e8, 1e9];

/// Radius of a wall that is plane to the eye.
const WALL: f64 = 1e6;

/// What a camera ray's own error adds, relative to the truth, where the surface faces
/// it: half the field of view and the rounding of `f32` directions and normals, a few
/// units of 6e-8. Seen from θ it is as much larger as cosθ is smaller.
const BIAS: f64 = 1e-6;

/// One scene and what is known of it.
pub struct Case {
    name: String,
    scene: Scene,
    samples: u64,
    truth: Truth,
}

enum Truth {
    /// Every sample of every pixel is this.
    Exactly([f32; 3]),
    /// Means over many samples.
    Means(Vec<Claim>),
}

/// A mean that is known, and what it would be if something were wrong.
struct Claim {
    quantity: Quantity,
    truth: f64,
    /// Relative error of the truth for this camera.
    bias: f64,
    /// Relative error that must not go unnoticed.
    effect: f64,
    faults: Vec<(&'static str, f64)>,
}

impl Claim {
    /// A claim about every channel of a grey scene.
    fn grey(truth: f64, effect: f64) -> Self {
        Self::channel(1, truth, effect)
    }

    fn channel(channel: usize, truth: f64, effect: f64) -> Self {
        let faults = vec![("brighter", truth * (1.0 + effect)), ("darker", truth * (1.0 - effect))];
        Self { quantity: Quantity::Channel(channel), truth, bias: BIAS, effect, faults }
    }

    /// Adds what a named mistake would give, where it is large enough to be told.
    fn not(mut self, mistake: &'static str, value: f64) -> Self {
        if (value - self.truth).abs() > self.effect * self.truth {
            self.faults.push((mistake, value));
        }
        self
    }
}

impl Case {
    fn means(name: impl Into<String>, scene: Scene, samples: u64, claims: Vec<Claim>) -> Self {
        Self { name: name.into(), scene, samples, truth: Truth::Means(claims) }
    }

    fn exactly(name: impl Into<String>, scene: Scene, rgb: [f32; 3]) -> Self {
        Self { name: name.into(), scene, samples: 64, truth: Truth::Exactly(rgb) }
    }

    fn claims(&self) -> &[Claim] {
        match &self.truth {
            Truth::Exactly(_) => &[],
            Truth::Means(claims) => claims,
        }
    }
}

/// Every case, for an estimator: the means are the same for all of them.
fn cases(estimator: Estimator) -> Vec<Case> {
    let mut cases = exact();
    cases.extend(diffuse_under_light(estimator));
    cases.extend(diffuse_under_cut_light(estimator));
    cases.extend(walls());
    cases.extend(in_shell());
    cases.extend(lobes());
    cases.extend(lobes_at_light());
    cases.extend(hollow_spheres());
    cases.extend(coincident());
    // Other random numbers for every case, so that no two share an unlucky draw.
    for (seed, case) in (0..).zip(&mut cases) {
        let settings = case.scene.settings().with_seed(seed).with_estimator(estimator);
        case.scene = case.scene.clone().with_settings(settings);
    }
    cases
}

/// Nothing random: one value in every sample, and no variance.
fn exact() -> Vec<Case> {
    let chalk = || body(1.0, diffuse([0.5; 3]));
    let aside = |target: [f64; 3], spheres| seen_wide([0.0, 0.0, 0.0], target, 2, spheres);
    let below = |surface| vec![body(1.0, surface), light(130_f64.to_radians(), 2.0, 10.0)];
    vec![
        Case::exactly(
            "camera in the light",
            aside([1.0, 0.0, 0.0], vec![shell([10.0; 3])]),
            [10.0; 3],
        ),
        Case::exactly(
            "on the light, looking in",
            aside([0.0, -1.0, 0.0], vec![body(1.0, emitter([10.0; 3]))]),
            [10.0; 3],
        ),
        Case::exactly(
            "on the body, looking out",
            aside([0.0, 1.0, 0.0], vec![chalk(), shell([1.0, 2.0, 3.0])]),
            [1.0, 2.0, 3.0],
        ),
        Case::exactly("no light", seen_from(0.5, 2, vec![chalk()]), [0.0; 3]),
        Case::exactly("no spheres", seen_from(0.5, 2, vec![]), [0.0; 3]),
        Case::exactly("no bounces", seen_from(0.5, 0, vec![chalk(), shell([1.0; 3])]), [0.0; 3]),
        Case::exactly(
            "black body",
            seen_from(0.5, 2, vec![body(1.0, diffuse([0.0; 3])), shell([1.0; 3])]),
            [0.0; 3],
        ),
        Case::exactly(
            "light below a diffuse horizon",
            seen_from(0.5, 2, below(diffuse([1.0; 3]))),
            [0.0; 3],
        ),
        Case::exactly(
            "light below a glossy horizon",
            seen_from(0.5, 2, below(glossy(1.0, 0.0))),
            [0.0; 3],
        ),
        Case::exactly(
            "light and wall coincide, light first",
            seen_from(0.5, 2, vec![body(1.0, emitter([3.0; 3])), chalk(), shell([1.0; 3])]),
            [3.0; 3],
        ),
    ]
}

/// A diffuse sphere under a light that is wholly above the horizon. Where the path finds
/// the light by itself, the second moment of its samples is known too, and so is their
/// variance: under cosine-weighted directions a sample is ρL or nothing.
fn diffuse_under_light(estimator: Estimator) -> Vec<Case> {
    let (albedo, radiance, h) = (0.5, 10.0, 2.0_f64);
    let half_angle = (1.0 / h).asin();
    let case = |degrees: f64| {
        let zenith = degrees.to_radians();
        let truth = albedo * radiance * sphere_form_factor(zenith, h);
        let mean = Claim::grey(truth, 0.01)
            .not("cosine dropped", 2.0 * albedo * radiance * (1.0 - half_angle.cos()))
            .not("pdf 1/π", truth / 2.0);
        let uniform = hemisphere_second_moment(zenith, half_angle);
        let cosine = sphere_form_factor(zenith, h);
        let moment = match estimator {
            Estimator::Implicit => Some((uniform, cosine)),
            Estimator::Cosine => Some((cosine, uniform)),
            Estimator::Explicit | Estimator::Mis => None,
        };
        let squared = moment.map(|(own, other)| {
            let square = (albedo * radiance).powi(2);
            Claim { quantity: Quantity::SquaredLuminance, ..Claim::grey(square * own, 0.01) }
                .not("the other estimator's", square * other)
        });
        let name = format!("diffuse, light at {degrees}°");
        let claims = [mean].into_iter().chain(squared).collect();
        Case::means(name, lit(1.0, albedo, zenith, h, radiance), 12288, claims)
    };
    [20.0, 50.0].map(case).into()
}

/// The same, but the horizon cuts the light.
/// Cosine-weighted directions hardly ever go there, hence the more samples.
fn diffuse_under_cut_light(estimator: Estimator) -> Vec<Case> {
    let (albedo, radiance, h) = (0.5, 10.0, 2.0_f64);
    let case = |(degrees, effect): (f64, f64)| {
        let zenith = degrees.to_radians();
        let claim = Claim::grey(albedo * radiance * sphere_form_factor(zenith, h), effect)
            .not("horizon ignored", albedo * radiance * zenith.cos().max(0.0) / (h * h));
        let name = format!("diffuse, light at {degrees}°, cut");
        let samples = if estimator == Estimator::Cosine { 24576 } else { 8192 };
        Case::means(name, lit(1.0, albedo, zenith, h, radiance), samples, vec![claim])
    };
    [(75.0, 0.02), (90.0, 0.02), (105.0, 0.03)].map(case).into()
}

/// A diffuse body seen from half a radian, and a light over it.
fn lit(radius: f64, albedo: f64, zenith: f64, h: f64, radiance: f64) -> Scene {
    seen_from(0.5, 2, vec![body(radius, diffuse([albedo; 3])), light(zenith, h, radiance)])
}

/// One wall, ever less curved: the radiance at the point that all share stays.
fn walls() -> Vec<Case> {
    let truth = 0.75 * 10.0 * sphere_form_factor(45_f64.to_radians(), 2.0);
    let case = |radius| {
        let scene = lit(radius, 0.75, 45_f64.to_radians(), 2.0, 10.0);
        let claim = Claim::grey(truth, 0.02);
        Case::means(format!("wall of radius {radius:e}"), scene, 3072, vec![claim])
    };
    WALL_RADII.map(case).into()
}

/// A convex diffuse body in uniform light reflects exactly its albedo of it.
fn in_shell() -> Vec<Case> {
    let (albedo, radiance) = ([0.25, 0.5, 1.0], [4.0, 1.0, 0.125]);
    let spheres = vec![body(1.0, diffuse(albedo)), shell(radiance)];
    let claims = (0..3).map(|c| {
        let truth = albedo[c] * radiance[c];
        Claim::channel(c, truth, 0.01).not("cosine dropped", 2.0 * truth)
    });
    vec![Case::means("diffuse in a shell", seen_from(0.7, 2, spheres), 1024, claims.collect())]
}

/// A Phong wall in uniform light reflects its lobe's albedo, ρ·A(θ, n).
fn lobes() -> Vec<Case> {
    let case = |degrees: f64, n| {
        let theta = degrees.to_radians();
        let spheres = vec![body(WALL, glossy(0.5, n)), shell([2.0; 3])];
        let (truth, above) = (lobe_albedo(theta, n), lobe_above_horizon(theta, n));
        let claim = Claim::grey(truth, 0.02)
            .not("cosine dropped", above)
            .not("lobe under the surface drawn again", truth / above)
            .not("divided by the cosine", truth / theta.cos());
        let claim = Claim { bias: BIAS / theta.cos(), ..claim };
        let name = format!("lobe of exponent {n:e} from {degrees}°");
        Case::means(name, seen_from(theta, 2, spheres), 1024, vec![claim])
    };
    EXPONENTS.iter().flat_map(|&n| ANGLES.map(|degrees| case(degrees, n))).collect()
}

/// A light around the mirror direction of a Phong surface.
fn lobes_at_light() -> Vec<Case> {
    let (theta, h) = (40_f64.to_radians(), 2.0_f64);
    let case = |n: f64| {
        let share = lobe_at_light(theta, n, (1.0 / h).asin());
        let claim = Claim::grey(0.8 * 10.0 * share, 0.02)
            .not("normalised by n + 2", 8.0 * share * (n + 2.0) / (n + 1.0))
            .not("cosine dropped", 8.0 * (1.0 - h.recip().asin().cos().powf(n + 1.0)));
        let spheres = vec![body(1.0, glossy(0.8, n)), light(theta, h, 10.0)];
        Case::means(
            format!("lobe of exponent {n:e} at a light"),
            seen_from(theta, 2, spheres),
            2048,
            vec![claim],
        )
    };
    [1.0, 20.0, 1e3].map(case).into()
}

/// The wall of a hollow sphere with a light at its centre.
fn hollow_spheres() -> Vec<Case> {
    let (albedo, fraction, radiance) = (0.8, 0.25, 5.0);
    let inside = [0.0, HOLLOW_RADIUS * 0.75, 0.0];
    let on_wall = [HOLLOW_RADIUS, 0.0, 0.0];
    let case = |name: &str, bounces, scene: Scene| {
        let value = |bounces| radiance * integrating_sphere(albedo, fraction, bounces);
        let claim = Claim::grey(value(bounces), 0.02)
            .not("one bounce more", value(bounces + 1))
            .not("one bounce less", value(bounces - 1))
            .not("cosine dropped", 2.0 * value(bounces));
        Case::means(format!("hollow sphere, {name}, {bounces} bounces"), scene, 3072, vec![claim])
    };
    let within = |bounces| {
        let spheres = hollow(albedo, fraction, radiance);
        case("from within", bounces, seen_along(inside, [1.0, 3.5, 0.0], bounces, spheres))
    };
    let standing = seen_along(on_wall, [1.0, 3.8, 0.0], 2, hollow(albedo, fraction, radiance));
    vec![within(1), within(2), within(8), case("from its wall", 2, standing)]
}

/// Of spheres in the same place the first is seen.
fn coincident() -> Vec<Case> {
    let case = |name: &str, first: Sphere, second: Sphere, truth: f64, other: f64| {
        let scene = seen_from(0.5, 2, vec![first, second, shell([1.0; 3])]);
        let claim = Claim::grey(truth, 0.01).not("the last is seen", other);
        Case::means(name, scene, 1024, vec![claim])
    };
    let chalk = |rho: f64| sphere([0.0, -1.0, 0.0], 1.0, diffuse([rho; 3]));
    let lamp = sphere([0.0, -1.0, 0.0], 1.0, emitter([3.0; 3]));
    vec![
        case("two walls coincide, bright first", chalk(0.8), chalk(0.2), 0.8, 0.2),
        case("two walls coincide, dark first", chalk(0.2), chalk(0.8), 0.2, 0.8),
        case("light and wall coincide, wall first", chalk(0.8), lamp, 0.8, 3.0),
    ]
}

/// Holds a tracer to every case: the mean must agree within an error bar at which the
/// whole table fails a correct tracer once in a million, and the same judge must
/// reject every fault. Prints the table.
///
/// # Panics
/// With the cases that fail.
pub fn check_closed_forms(estimator: Estimator, make: &dyn Fn(&Scene) -> Box<dyn Tracer>) {
    let cases = cases(estimator);
    let claims = cases.iter().map(|case| case.claims().len()).sum();
    println!("{:<46}{:>12}{:>12}{:>7}{:>9}", "case", "truth", "mean", "z", "detects");
    let failures: Vec<String> = cases.iter().flat_map(|case| case.judge(make, claims)).collect();
    assert!(failures.is_empty(), "{} failures:\n{}", failures.len(), failures.join("\n"));
}

impl Case {
    /// What is wrong with the tracer or with the case.
    fn judge(&self, make: &dyn Fn(&Scene) -> Box<dyn Tracer>, claims: usize) -> Vec<String> {
        let mut tracer = make(&self.scene);
        tracer.add_samples(0..self.samples).expect("the tracer traces");
        let film = tracer.film().expect("the tracer has a film");
        let invalid = tracer.ledger().expect("the tracer has a ledger").count;
        let mut failures = match &self.truth {
            Truth::Exactly(radiance) => self.judge_exactly(&film, *radiance),
            Truth::Means(all) => {
                all.iter().flat_map(|claim| self.judge_mean(&film, claim, claims)).collect()
            }
        };
        if invalid > 0 {
            failures.push(format!("{}: {invalid} invalid samples", self.name));
        }
        failures
    }

    fn judge_exactly(&self, film: &Film, radiance: [f32; 3]) -> Vec<String> {
        println!("{:<46}{:>12.6}   exactly", self.name, radiance[1]);
        let mut failures = Vec::new();
        if !is_exactly(film, radiance, self.samples) {
            failures.push(format!("{} is not exactly {radiance:?}", self.name));
        }
        let [r, g, b] = radiance;
        // One step in one channel, and one sample too few.
        #[expect(clippy::cast_possible_truncation, reason = "a power of two")]
        let step = film.scale().step() as f32;
        let faults = [
            ([r, g, b.next_up().max(step)], self.samples),
            ([r, g, b.max(step)], self.samples - 1),
        ];
        if faults.iter().any(|&(rgb, samples)| is_exactly(film, rgb, samples)) {
            failures.push(format!("{}: a fault is accepted", self.name));
        }
        failures
    }

    fn judge_mean(&self, film: &Film, claim: &Claim, claims: usize) -> Vec<String> {
        let estimate = Estimate::of(film, claim.quantity);
        let limit = limit(claims, estimate.freedom);
        let detects = detectable(estimate, claim.truth, claim.bias, limit);
        let z = deviation(estimate, claim.truth, claim.bias);
        let (name, truth) = (&self.name, claim.truth);
        println!("{name:<46}{truth:>12.6}{:>12.6}{z:>7.2}{:>8.2}%", estimate.mean, 100.0 * detects);
        let mut failures = Vec::new();
        if z.abs() > limit {
            failures.push(format!("{name}: {} where {truth} is true, z = {z:.1}", estimate.mean));
        }
        if detects > claim.effect {
            failures.push(format!("{name}: would miss an error of {}", claim.effect));
        }
        for (fault, value) in &claim.faults {
            if deviation(estimate, *value, claim.bias).abs() <= limit {
                failures.push(format!("{name}: {value} is accepted, as if {fault}"));
            }
        }
        failures
    }
}
