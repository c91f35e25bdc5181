//! Radiometry that can be written down: what a renderer must converge to. Angles in
//! radians. `tests/closed_forms.rs` holds each formula against quadrature.

use std::f64::consts::PI;

/// Form factor from a surface element to a sphere: the share of the element's
/// cosine-weighted hemisphere that the sphere takes up, so that a Lambertian element
/// reflects ρ·L·F. The sphere's centre stands at `zenith` from the normal, at `h` > 1
/// of its radii. Above the horizon that is cos(zenith)/h²; where the horizon cuts the
/// sphere, see Snyder, "Area Light Sources for Real-Time Graphics", MSR-TR-96-11.
pub fn sphere_form_factor(zenith: f64, h: f64) -> f64 {
    let half_angle = (1.0 / h).asin();
    let cosine = zenith.cos();
    if zenith + half_angle <= PI / 2.0 {
        return cosine / (h * h);
    }
    if zenith - half_angle >= PI / 2.0 {
        return 0.0;
    }
    let k = (h * h - 1.0).sqrt();
    let cut = (1.0 - h * h * cosine * cosine).sqrt();
    let lens = cosine * (-cosine * k / zenith.sin()).acos() - k * cut;
    (lens / (h * h) + (cut / k).atan()) / PI
}

/// Second moment of the estimator 2cosθ·V that draws directions uniformly over the
/// hemisphere and sees a cap of half angle `half_angle` at `zenith`, all of it above
/// the horizon; in units of (ρL)².
pub fn hemisphere_second_moment(zenith: f64, half_angle: f64) -> f64 {
    let c = half_angle.cos();
    let along = 2.0 * PI * zenith.cos().powi(2) * (1.0 - c.powi(3)) / 3.0;
    let across = PI * zenith.sin().powi(2) * (2.0 / 3.0 - c + c.powi(3) / 3.0);
    2.0 / PI * (along + across)
}

/// Albedo A(θ, n) of the Phong lobe (n+1)cosⁿα/2π about the mirror direction, seen
/// from `theta`: the mean cosine to the normal, the part under the surface as zero.
pub fn lobe_albedo(theta: f64, n: f64) -> f64 {
    let (sine, cosine) = theta.sin_cos();
    let under = sine.powf(n + 2.0) - (n + 1.0) * cosine * sine_integral(theta, n + 1.0);
    (n + 1.0) / (n + 2.0) * cosine + whole_sine_integral(n + 2.0) / (2.0 * PI) * under
}

/// Share P(θ, n) of the Phong lobe that lies above the surface.
pub fn lobe_above_horizon(theta: f64, n: f64) -> f64 {
    let under = whole_sine_integral(n + 1.0) * sine_integral(theta, n);
    1.0 - (n + 1.0) / (2.0 * PI) * under
}

/// Reflectance of a Phong surface towards `theta` for a light of half angle
/// `half_angle` around the mirror direction, with nothing under the horizon. The odd
/// part of the cosine cancels around the axis, which leaves cosθ·cosα.
pub fn lobe_at_light(theta: f64, n: f64, half_angle: f64) -> f64 {
    theta.cos() * (n + 1.0) / (n + 2.0) * (1.0 - half_angle.cos().powf(n + 2.0))
}

/// Radiance of the diffuse wall of a hollow sphere around a light at its centre that
/// fills `fraction` = (r/R)² of every wall element's cosine-weighted view: the wall
/// lights itself with the rest, ρf·Σ(ρ(1−f))ⁱ over up to `bounces` scatterings.
pub fn integrating_sphere(albedo: f64, fraction: f64, bounces: u32) -> f64 {
    let passed_on = |i| (albedo * (1.0 - fraction)).powi(i);
    albedo * fraction * (0..bounces.cast_signed()).map(passed_on).sum::<f64>()
}

/// `I_k` = ∫₀^π sinᵏ = √π·Γ((k+1)/2)/Γ(k/2+1), k ≥ 0. Raised to large k by the
/// recurrence, then by the expansion of Γ(z+½)/Γ(z) (DLMF 5.11.13), because the
/// difference of two log-gammas has no digits left at k = 1e10.
fn whole_sine_integral(k: f64) -> f64 {
    if k < 256.0 {
        return whole_sine_integral(k + 2.0) * (k + 2.0) / (k + 1.0);
    }
    let z = f64::midpoint(k, 1.0);
    let w = 1.0 / z;
    let series = [-1.0 / 8.0, 1.0 / 128.0, 5.0 / 1024.0, -21.0 / 32768.0, -399.0 / 262_144.0];
    let ratio = 1.0 + series.iter().rev().fold(0.0, |sum, term| (sum + term) * w);
    (PI / z).sqrt() / ratio
}

/// `S_k(θ)` = ∫₀^θ sinᵏ for θ in [0, π/2]: half the incomplete beta function
/// B(sin²θ; (k+1)/2, ½), by its continued fraction on the side where that converges.
fn sine_integral(theta: f64, k: f64) -> f64 {
    let (sine, cosine) = theta.sin_cos();
    if sine == 0.0 {
        return 0.0;
    }
    let a = f64::midpoint(k, 1.0);
    let front = cosine * sine.powf(k + 1.0);
    if sine * sine < (a + 1.0) / (a + 2.5) {
        front / (k + 1.0) * beta_fraction(sine * sine, a, 0.5)
    } else {
        whole_sine_integral(k) / 2.0 - front * beta_fraction(cosine * cosine, 0.5, a)
    }
}

/// The continued fraction of B(x; a, b)·a/(xᵃ(1−x)ᵇ), DLMF 8.17.22, by the method of
/// Lentz, for x < (a+1)/(a+b+2).
fn beta_fraction(x: f64, a: f64, b: f64) -> f64 {
    let coefficient = |i: u32| {
        let half = f64::from(i / 2);
        let at = a + 2.0 * half;
        if i.is_multiple_of(2) {
            half * (b - half) * x / ((at - 1.0) * at)
        } else {
            -(a + half) * (a + b + half) * x / (at * (at + 1.0))
        }
    };
    let (mut value, mut upper, mut lower) = (1.0, 1.0, 0.0);
    for i in 1..1_000_000 {
        lower = 1.0 / (1.0 + coefficient(i) * lower);
        upper = 1.0 + coefficient(i) / upper;
        value *= upper * lower;
        if (upper * lower - 1.0).abs() < 1e-15 {
            return 1.0 / value;
        }
    }
    panic!("no convergence at x = {x}, a = {a}, b = {b}")
}
