//! One sample as integers: truncation, luminance and its square.

/// Weights of Rec. 709 luminance (0.2126, 0.7152, 0.0722) in units of 2⁻¹⁶; they add
/// up to 2¹⁶, so a grey sample's luminance is the sample itself.
pub const LUMINANCE_WEIGHTS: [u32; 3] = [13_933, 46_871, 4_732];

/// How a sample of bounded radiance becomes an integer: trunc(x·2^shift) < 2⁶⁴.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SampleScale {
    shift: i32,
    bound: f32,
}

// The bound is never NaN: it is made by `from_bound` alone.
impl Eq for SampleScale {}

impl SampleScale {
    /// The finest scale at which every sample up to `bound` fits into 64 bits.
    ///
    /// # Panics
    /// If `bound` is not a positive number that an `f32` can hold; a scene's limits
    /// keep it far below that.
    #[must_use]
    pub fn from_bound(bound: f64) -> Self {
        #[expect(clippy::cast_possible_truncation, reason = "rounded up right after")]
        let mut nearest = bound as f32;
        if f64::from(nearest) < bound {
            nearest = nearest.next_up();
        }
        assert!(nearest.is_normal() && nearest > 0.0, "no film scale for a bound of {bound}");
        // nearest = m·2^exponent with 1 <= m < 2, so nearest·2^(63-exponent) < 2^64.
        let exponent = (nearest.to_bits() >> 23).cast_signed() - 127;
        Self { shift: 63 - exponent, bound: nearest }
    }

    /// The power of two that a sample is multiplied by.
    #[must_use]
    pub fn shift(self) -> i32 {
        self.shift
    }

    /// The largest sample that is valid, in the scene's radiance.
    #[must_use]
    pub fn bound(self) -> f32 {
        self.bound
    }

    /// Radiance of one integer step.
    #[must_use]
    pub fn step(self) -> f64 {
        f64::from(-self.shift).exp2()
    }

    /// Whether a sample may enter the film: not NaN, not negative, not above the
    /// bound. Compared as bit patterns, as on the device.
    #[must_use]
    pub fn admits(self, rgb: [f32; 3]) -> bool {
        rgb.iter().all(|x| x.to_bits() <= self.bound.to_bits())
    }
}

impl std::fmt::Display for SampleScale {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "2^{}", self.shift)
    }
}

/// trunc(x·2^shift) for 0 ≤ x with x·2^shift < 2⁶⁴; subnormal x counts as 0, as a
/// device may flush it.
#[must_use]
pub fn to_fixed(x: f32, shift: i32) -> u64 {
    let bits = x.to_bits();
    let exponent = (bits >> 23).cast_signed();
    if exponent == 0 {
        return 0;
    }
    let mantissa = u64::from((bits & 0x007f_ffff) | 0x0080_0000);
    let up = exponent - 150 + shift;
    match up {
        0.. => mantissa << up,
        -23..0 => mantissa >> -up,
        _ => 0,
    }
}

/// Integer luminance of three channels, rounded down; at most the largest channel.
#[must_use]
#[expect(clippy::cast_possible_truncation, reason = "a weighted mean of u64 is one")]
pub fn luminance(rgb: [u64; 3]) -> u64 {
    let weighted = std::iter::zip(rgb, LUMINANCE_WEIGHTS)
        .map(|(x, w)| u128::from(x) * u128::from(w))
        .sum::<u128>();
    (weighted >> 16) as u64
}

/// ⌊y²/2³²⌋, below 2⁹⁶.
#[must_use]
pub fn square(y: u64) -> u128 {
    (u128::from(y) * u128::from(y)) >> 32
}
