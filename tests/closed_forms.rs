//! Scenes whose radiance is known in closed form, on the CPU twin; and the closed
//! forms themselves against quadrature.

mod support {
    pub mod closed_form;
    pub mod closed_form_cases;
    pub mod closed_form_scenes;
    pub mod judge;
}

use candor::cpu::CpuTracer;
use candor::scene::Estimator;
use std::f64::consts::{FRAC_PI_2, PI};
use support::closed_form::{
    hemisphere_second_moment, integrating_sphere, lobe_above_horizon, lobe_albedo, lobe_at_light,
    sphere_form_factor,
};
use support::closed_form_cases::check_closed_forms;

fn check(estimator: Estimator) {
    check_closed_forms(estimator, &|scene| Box::new(CpuTracer::new(scene, None).expect("threads")));
}

#[test]
fn implicit_agrees_with_closed_forms() {
    check(Estimator::Implicit);
}

#[test]
fn cosine_agrees_with_closed_forms() {
    check(Estimator::Cosine);
}

#[test]
fn explicit_agrees_with_closed_forms() {
    check(Estimator::Explicit);
}

#[test]
fn mis_agrees_with_closed_forms() {
    check(Estimator::Mis);
}

fn assert_close(found: f64, expected: f64, tolerance: f64, what: &str) {
    let off = (found - expected).abs();
    assert!(off <= tolerance, "{what}: {found} instead of {expected}, off by {off:e}");
}

/// The midpoint rule on [0, 1].
fn integrate(f: impl Fn(f64) -> f64) -> f64 {
    const NODES: u32 = 400_000;
    let node = |i| (f64::from(i) + 0.5) / f64::from(NODES);
    (0..NODES).map(|i| f(node(i))).sum::<f64>() / f64::from(NODES)
}

/// Where the cosine to the normal, a + b·cosφ with b ≥ 0, is positive: |φ| below this.
fn lit_azimuth(a: f64, b: f64) -> f64 {
    if a >= b { PI } else { (-a / b).max(-1.0).acos() }
}

/// Mean over φ of max(0, a + b·cosφ).
fn mean_cosine(a: f64, b: f64) -> f64 {
    let limit = lit_azimuth(a, b);
    if a <= -b { 0.0 } else { (a * limit + b * limit.sin()) / PI }
}

/// Mean over φ of max(0, a + b·cosφ)².
fn mean_squared_cosine(a: f64, b: f64) -> f64 {
    let limit = lit_azimuth(a, b);
    let squares = (a * a + b * b / 2.0) * limit + b * b / 4.0 * (2.0 * limit).sin();
    if a <= -b { 0.0 } else { (squares + 2.0 * a * b * limit.sin()) / PI }
}

/// Integral over a cap of half angle `half_angle` around an axis at `zenith`; `ring`
/// gives the mean over one ring from the two parts of its cosine to the normal.
fn over_cap(zenith: f64, half_angle: f64, ring: impl Fn(f64, f64) -> f64) -> f64 {
    let height = 1.0 - half_angle.cos();
    2.0 * PI
        * height
        * integrate(|x| {
            let c = 1.0 - height * x;
            ring(zenith.cos() * c, zenith.sin() * (1.0 - c * c).sqrt())
        })
}

/// Mean over the Phong lobe around an axis at `zenith`, of which the share `1 − x`
/// lies within the angle α with cosα = x^(1/(n+1)); in x = y², whose root is smoother.
fn over_lobe(zenith: f64, n: f64, ring: impl Fn(f64, f64) -> f64) -> f64 {
    integrate(|y| {
        let t = -(2.0 * y.ln() / (n + 1.0)).exp_m1();
        2.0 * y * ring(zenith.cos() * (1.0 - t), zenith.sin() * (t * (2.0 - t)).sqrt())
    })
}

#[test]
fn form_factors_agree_with_quadrature() {
    for h in [1.01_f64, 1.5, 2.0, 10.0] {
        for degrees in [0.0, 20.0, 60.0, 85.0, 89.0, 90.0, 91.0, 110.0, 175.0] {
            let zenith = f64::to_radians(degrees);
            let expected = over_cap(zenith, (1.0 / h).asin(), mean_cosine) / PI;
            assert_close(
                sphere_form_factor(zenith, h),
                expected,
                1e-8,
                &format!("h {h} at {degrees}°"),
            );
        }
    }
    assert_close(sphere_form_factor(FRAC_PI_2, 2.0), 0.028_834_4, 5e-8, "published");
}

#[test]
fn second_moments_agree_with_quadrature() {
    for (degrees, half_angle) in [(0.0, 0.1), (0.0, 1.5), (50.0, 0.5), (85.0, 0.05)] {
        let zenith = f64::to_radians(degrees);
        // p = 1/2π and X = 2·cosine, so E[X²] = 4/2π times the integral.
        let expected = 2.0 / PI * over_cap(zenith, half_angle, mean_squared_cosine);
        assert_close(hemisphere_second_moment(zenith, half_angle), expected, 1e-9, "moment");
    }
}

#[test]
fn lobe_albedos_agree_with_quadrature() {
    let above = |a: f64, b: f64| if a <= -b { 0.0 } else { lit_azimuth(a, b) / PI };
    for n in [0.0, 0.5, 1.0, 5.0, 50.0, 333.3, 1e4, 1e7, 1e10] {
        for degrees in [0.0, 1e-3, 30.0, 60.0, 80.0, 89.9, 90.0] {
            let (theta, what) = (f64::to_radians(degrees), format!("n {n} from {degrees}°"));
            assert_close(lobe_albedo(theta, n), over_lobe(theta, n, mean_cosine), 1e-9, &what);
            assert_close(lobe_above_horizon(theta, n), over_lobe(theta, n, above), 1e-6, &what);
        }
    }
}

#[test]
fn lobe_albedos_agree_with_published_values() {
    let published = [(60.0, 5.0, 0.445_205_859), (80.0, 50.0, 0.177_330_955), (60.0, 0.0, 0.375)];
    for (degrees, n, albedo) in published {
        assert_close(lobe_albedo(f64::to_radians(degrees), n), albedo, 5e-10, "published");
    }
    assert_close(lobe_above_horizon(FRAC_PI_2, 7.0), 0.5, 1e-14, "half a lobe");
    assert_close(lobe_albedo(0.0, 7.0), 8.0 / 9.0, 1e-15, "a lobe around the normal");
}

#[test]
fn lobes_at_lights_agree_with_quadrature() {
    for (degrees, n, half_angle) in [(0.0, 0.0, 1.0), (40.0, 20.0, 0.5), (80.0, 1e3, 0.1)] {
        let theta = f64::to_radians(degrees);
        let power = |a: f64, b: f64| {
            let cosine = a / theta.cos();
            (n + 1.0) / (2.0 * PI) * cosine.powf(n) * mean_cosine(a, b)
        };
        let expected = over_cap(theta, half_angle, power);
        assert_close(lobe_at_light(theta, n, half_angle), expected, 1e-9, "lobe at a light");
    }
}

/// One bounce is the form factor of the light straight above; without end, energy is
/// conserved: what enters the wall, f·L + (1−f)·B, times ρ leaves it as B.
#[test]
fn integrating_spheres_conserve_energy() {
    let (albedo, fraction) = (0.8, 0.25_f64);
    let h = (1.0 / fraction).sqrt();
    let once = integrating_sphere(albedo, fraction, 1);
    assert_close(once, albedo * over_cap(0.0, (1.0 / h).asin(), mean_cosine) / PI, 1e-9, "once");
    let twice = integrating_sphere(albedo, fraction, 2);
    assert_close(twice, albedo * (fraction + (1.0 - fraction) * once), 1e-15, "twice");
    let all = integrating_sphere(albedo, fraction, 1000);
    assert_close(all, albedo * (fraction + (1.0 - fraction) * all), 1e-15, "without end");
    // Without a light to absorb it, ρ + ρ² + … of the enclosure.
    assert_close(integrating_sphere(0.5, 1e-9, 3) / 1e-9, 0.875, 1e-8, "enclosure");
}
