// Logarithm and exponential of lobes, with bounds of their own: WGSL grants log an absolute
// error of 2^-21 near 1, where a narrow lobe has all its samples. These use only + - * /
// and integer operations.

const LN_2_HIGH: f32 = 0.693145751953125;
const LN_2_LOW: f32 = 1.42860682030941723212e-6;

// -log(1 - u) for u in [0, 1). With 1 - u = 2^k (1 + f), 1 + f in [√½, √2), s = f/(2 + f),
// the series log(1 + f) = 2s + 2s³/3 + … is summed to s⁹; |s| <= 0.1716. Where k is 0, f is
// -u itself, which keeps the digits of a small u; elsewhere 1 - u rounds by at most half
// a unit, which is small beside the logarithm.
fn minus_log_complement(u: f32) -> f32 {
    let bits = bitcast<u32>(1.0 - u);
    // Moves the mantissa's break from 1 to √½ (0x3f3504f3).
    let shifted = bits + (0x3f800000u - 0x3f3504f3u);
    let k = f32(i32(shifted >> 23u) - 127);
    let f = select(bitcast<f32>((shifted & 0x007fffffu) + 0x3f3504f3u) - 1.0, -u, k == 0.0);
    let s = f / (2.0 + f);
    let z = s * s;
    let tail = z * (0.66666666666 + z * (0.4 + z * (0.28571428571 + z * 0.22222222222)));
    // log(1 + f) = f - s (f - tail); exact in f where f is small.
    let log1p = f - s * (f - tail);
    return -(k * LN_2_HIGH + (log1p + k * LN_2_LOW));
}

// exp(-x) = power·(1 + rest) for x in [0, 87]: power = 2^k, rest = e^r - 1 by its Taylor
// series to r⁷, |r| <= ½ ln 2.
struct Exponential {
    power: f32,
    rest: f32,
}

fn exponential_minus(x: f32) -> Exponential {
    let k = floor(0.5 - x * 1.4426950408889634);
    let r = (-x - k * LN_2_HIGH) - k * LN_2_LOW;
    let p = r + r * r * (0.5 + r * (0.16666666667 + r * (0.041666666667
        + r * (0.0083333333333 + r * (0.0013888888889 + r * 1.9841269841e-4)))));
    return Exponential(bitcast<f32>(u32(i32(k) + 127) << 23u), p);
}

// 1 - exp(-x) for x in [0, 32]; small x keeps its relative precision.
fn one_minus_exp_minus(x: f32) -> f32 {
    let e = exponential_minus(x);
    return (1.0 - e.power) - e.power * e.rest;
}
