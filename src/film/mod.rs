//! The exact film: per pixel, integer sums of samples that no order of adding changes.
//!
//! A sample x enters as trunc(x·2^shift), below 2⁶⁴; `shift` comes from a proven
//! bound on one sample and so depends on scene, estimator and bounces alone. Per
//! pixel there are 13 words of 32 bits: 96 bits for the sum of each channel and 128
//! for Σ⌊Y²/2³²⌋, where Y is the integer luminance of the truncated channels. Up to
//! 2³² samples fit. `shaders/film.wgsl` adds in 32-bit words; here the same sums are
//! made from 64- and 128-bit integers, so that the two check each other.

mod fixed;
mod identity;
mod ranges;

pub use fixed::{LUMINANCE_WEIGHTS, SampleScale, luminance, square, to_fixed};
pub use identity::{Identity, NUMBERS};
pub use ranges::{MAX_SAMPLE_INDEX, RangeError, SampleRanges};

use crate::scene::ImageSize;
use std::ops::Range;
use std::sync::Arc;

/// 32-bit words per pixel: 3 × 3 for the channels, 4 for the squared luminance.
pub const WORDS: usize = 13;
/// Bytes per pixel, on the device and on the host.
pub const BYTES_PER_PIXEL: u64 = 4 * WORDS as u64;

/// The words of one pixel, low word first: R 0..3, G 3..6, B 6..9, squares 9..13.
pub type PixelWords = [u32; WORDS];

/// Why two films, or a film and a range of samples, cannot be added.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum FilmError {
    /// The film cannot take the samples.
    #[error(transparent)]
    Range(#[from] RangeError),
    /// The films are of different pictures.
    #[error("{}", .0.between("here", "there"))]
    Differs(Difference),
}

/// What differs between two films: ours, which is added to, and theirs, which is added.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Difference {
    /// What differs.
    pub field: &'static str,
    /// Its value in our film.
    pub ours: String,
    /// Its value in theirs.
    pub theirs: String,
}

impl Difference {
    /// Both values, with words for where they are.
    #[must_use]
    pub fn between(&self, ours: &str, theirs: &str) -> String {
        format!("{} differs: {} {ours}, {} {theirs}", self.field, self.ours, self.theirs)
    }
}

/// Exact sums of the samples of one picture. A clone shares the sums until one of the two is
/// added to.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Film {
    size: ImageSize,
    scale: SampleScale,
    samples: SampleRanges,
    pixels: Arc<Vec<PixelWords>>,
}

impl Film {
    /// A film without samples.
    #[must_use]
    pub fn new(size: ImageSize, scale: SampleScale) -> Self {
        let pixels = Arc::new(vec![[0; WORDS]; size.pixels() as usize]);
        Self { size, scale, samples: SampleRanges::default(), pixels }
    }

    /// A film that claims samples whose words are still to be written.
    #[must_use]
    pub fn awaiting(size: ImageSize, scale: SampleScale, samples: SampleRanges) -> Self {
        Self { samples, ..Self::new(size, scale) }
    }

    /// The picture's size.
    #[must_use]
    pub fn size(&self) -> ImageSize {
        self.size
    }

    /// How samples become integers.
    #[must_use]
    pub fn scale(&self) -> SampleScale {
        self.scale
    }

    /// Which samples of every pixel are in the film.
    #[must_use]
    pub fn samples(&self) -> &SampleRanges {
        &self.samples
    }

    /// The words of every pixel, row by row from the top.
    #[must_use]
    pub fn pixels(&self) -> &[PixelWords] {
        &self.pixels
    }

    /// Claims a range of samples for every pixel; whoever claims it adds it.
    ///
    /// # Errors
    /// If a sample of the range is already in the film, or the sums have no room left.
    pub fn claim(&mut self, range: Range<u64>) -> Result<(), FilmError> {
        Ok(self.samples.insert(range)?)
    }

    /// CRC-32 of the words, little-endian, row by row from the top.
    #[must_use]
    pub fn checksum(&self) -> u32 {
        crc32fast::hash(bytemuck::cast_slice(&self.pixels))
    }

    /// The words of every pixel, to be written by whoever claimed the samples.
    pub fn pixels_mut(&mut self) -> &mut [PixelWords] {
        Arc::make_mut(&mut self.pixels).as_mut_slice()
    }

    /// Adds another film of the same picture.
    ///
    /// # Errors
    /// If size or scale differ, samples overlap, or the sums have no room left; the
    /// film is then unchanged.
    pub fn merge(&mut self, other: &Film) -> Result<(), FilmError> {
        other.check_fits(self.size, self.scale)?;
        self.samples = self.samples.union(&other.samples)?;
        for (ours, theirs) in self.pixels_mut().iter_mut().zip(other.pixels()) {
            add_words(ours, theirs);
        }
        Ok(())
    }

    /// Checks that this film is of a picture of that size, at that scale.
    ///
    /// # Errors
    /// If size or scale differ.
    pub fn check_fits(&self, size: ImageSize, scale: SampleScale) -> Result<(), FilmError> {
        let differs =
            |field, ours, theirs| Err(FilmError::Differs(Difference { field, ours, theirs }));
        if self.size != size {
            return differs("size", size.to_string(), self.size.to_string());
        }
        if self.scale != scale {
            return differs("scale", scale.to_string(), self.scale.to_string());
        }
        Ok(())
    }
}

/// The sums of one pixel as integers: R, G, B and Σ⌊Y²/2³²⌋.
#[must_use]
pub fn sums(words: &PixelWords) -> [u128; 4] {
    let join = |part: &[u32]| part.iter().rev().fold(0, |sum, &w| (sum << 32) | u128::from(w));
    [join(&words[0..3]), join(&words[3..6]), join(&words[6..9]), join(&words[9..13])]
}

/// The sums of one pixel as integers while many samples are added: taking the words
/// apart and joining them costs more than adding.
#[derive(Debug, Clone, Copy)]
pub struct PixelSums([u128; 4]);

impl PixelSums {
    /// Starts from what a pixel holds.
    #[must_use]
    pub fn of(words: &PixelWords) -> Self {
        Self(sums(words))
    }

    /// Adds one sample, already checked against its bound.
    pub fn add(&mut self, rgb: [f32; 3], scale: SampleScale) {
        let channels = rgb.map(|x| to_fixed(x, scale.shift()));
        for (total, x) in self.0.iter_mut().zip(channels) {
            *total += u128::from(x);
        }
        self.0[3] += square(luminance(channels));
    }

    /// The words to be stored.
    #[must_use]
    pub fn words(self) -> PixelWords {
        split(self.0)
    }
}

/// Adds the sums of the same pixel in another film.
pub fn add_words(ours: &mut PixelWords, theirs: &PixelWords) {
    let (a, b) = (sums(ours), sums(theirs));
    *ours = split(std::array::from_fn(|i| a[i] + b[i]));
}

/// The inverse of [`sums`].
#[expect(clippy::cast_possible_truncation, reason = "takes the words of a sum apart")]
fn split(totals: [u128; 4]) -> PixelWords {
    std::array::from_fn(|word| {
        let (sum, place) = if word < 9 { (word / 3, word % 3) } else { (3, word - 9) };
        (totals[sum] >> (32 * place)) as u32
    })
}
