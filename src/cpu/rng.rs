//! Random numbers as a pure function of (pixel, sample index, block, seed); the same
//! bits as `shaders/rng.wgsl`.

use glam::DVec2;

/// PCG-4D: Jarzynski & Olano, "Hash Functions for GPU Rendering", JCGT 9(3), 2020.
#[must_use]
pub fn pcg4d(key: [u32; 4]) -> [u32; 4] {
    let v = key.map(|k| k.wrapping_mul(1_664_525).wrapping_add(1_013_904_223));
    mix(mix(v).map(|x| x ^ (x >> 16)))
}

/// One round: every word takes in the product of two others, each in its new value.
fn mix([mut x, mut y, mut z, mut w]: [u32; 4]) -> [u32; 4] {
    x = x.wrapping_add(y.wrapping_mul(w));
    y = y.wrapping_add(z.wrapping_mul(x));
    z = z.wrapping_add(x.wrapping_mul(y));
    w = w.wrapping_add(y.wrapping_mul(z));
    [x, y, z, w]
}

/// The address of one sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SampleKey {
    /// Pixel number, row by row from the top.
    pub pixel: u32,
    /// Sample index, below 2⁵⁶.
    pub index: u64,
}

/// Four numbers of block `block` (below 256): block 0 serves the camera, block k the
/// k-th scattering.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "takes the index apart into words")]
pub fn random_bits(key: SampleKey, block: u32, seed: u32) -> [u32; 4] {
    let (low, high) = (key.index as u32, (key.index >> 32) as u32);
    pcg4d([key.pixel, low, (high << 8) | block, seed])
}

/// The top 24 bits as a multiple of 2⁻²⁴ in [0, 1 − 2⁻²⁴]: what the device's `f32`
/// can hold, so that both trace the same paths.
#[must_use]
pub fn unit_float(bits: u32) -> f64 {
    f64::from(bits >> 8) * (1.0 / f64::from(1 << 24))
}

/// The first two of four numbers as coordinates in the unit square.
#[must_use]
pub fn unit_floats(bits: [u32; 4]) -> DVec2 {
    DVec2::new(unit_float(bits[0]), unit_float(bits[1]))
}
