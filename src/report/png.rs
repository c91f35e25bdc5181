//! Eight-bit PNG in sRGB.

use super::{FileError, Picture, replace};
use image::{ImageEncoder, codecs::png::PngEncoder};
use std::path::Path;

/// Writes the picture, brightened by `exposure` stops.
///
/// # Errors
/// If the file cannot be written; one that was there is then untouched.
pub fn write(path: &Path, picture: &Picture, exposure: f64) -> Result<(), FileError> {
    let gain = exposure.exp2();
    let shown = |rgb: &[f32; 3]| rgb.map(|x| encode(f64::from(x) * gain));
    let pixels: Vec<[u8; 3]> = picture.rgb.iter().map(shown).collect();
    write_rgb(path, picture.size.width(), &pixels)
}

/// Writes rows of `width` pixels, already in sRGB.
pub(super) fn write_rgb(path: &Path, width: u32, pixels: &[[u8; 3]]) -> Result<(), FileError> {
    let height = u32::try_from(pixels.len() / width as usize).unwrap_or(u32::MAX);
    replace(path, |file| {
        PngEncoder::new(file)
            .write_image(pixels.as_flattened(), width, height, image::ExtendedColorType::Rgb8)
            .map_err(|error| error.to_string())
    })
}

/// Linear light to an sRGB byte (IEC 61966-2-1), clipped at white.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "rounded and clamped to a byte"
)]
fn encode(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

#[cfg(test)]
mod tests {
    use super::encode;

    /// Values of IEC 61966-2-1: black, white, the end of the linear part, and byte 128.
    #[test]
    fn encodes_srgb() {
        let table = [(0.0, 0), (1.0, 255), (7.0, 255), (0.003_130_8, 10), (0.215_860_5, 128)];
        for (linear, byte) in table {
            assert_eq!(encode(linear), byte, "{linear}");
        }
    }
}
