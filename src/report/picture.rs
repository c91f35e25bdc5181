//! The picture that a film shows: mean radiance and its standard error per pixel.

use crate::estimate::estimate;
use crate::film::Film;
use crate::scene::ImageSize;

/// Mean radiance and standard error, row by row from the top.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Width and height in pixels.
    pub size: ImageSize,
    /// Mean radiance per channel, linear Rec. 709.
    pub rgb: Vec<[f32; 3]>,
    /// Standard error of the mean luminance; infinite where it is unproven (no sample
    /// has contributed yet, or fewer than two were taken).
    pub luminance_error: Vec<f32>,
}

impl Picture {
    /// Develops a film. `proven_dark` says that the scene has no lights, so that zeros
    /// are exact.
    #[must_use]
    #[expect(clippy::cast_possible_truncation, reason = "pictures are stored as f32")]
    pub fn develop(film: &Film, proven_dark: bool) -> Self {
        let samples = film.samples().count();
        let (rgb, luminance_error) = film
            .pixels()
            .iter()
            .map(|words| {
                let pixel = estimate(film, words);
                let error = match (proven_dark, pixel.is_unproven() || samples < 2) {
                    (true, _) => 0.0,
                    (false, true) => f32::INFINITY,
                    (false, false) => pixel.standard_error(samples) as f32,
                };
                (pixel.rgb.map(|c| c as f32), error)
            })
            .unzip();
        Self { size: film.size(), rgb, luminance_error }
    }
}
