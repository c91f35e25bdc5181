//! Eight-bit PNG in sRGB.

use super::{FileError, Picture, replace};
use image::{ImageEncoder, codecs::png::PngEncoder};
use std::io::Write;
use std::path::Path;

/// Writes the picture, brightened by `exposure` stops.
///
/// # Errors
/// If the file cannot be written; one that was there is then untouched.
pub fn write(path: &Path, picture: &Picture, exposure: f64) -> Result<(), FileError> {
    write_rgb(path, picture.size.width(), &shown(picture, exposure))
}

/// Writes rows of `width` pixels, already in sRGB.
pub(super) fn write_rgb(path: &Path, width: u32, pixels: &[[u8; 3]]) -> Result<(), FileError> {
    replace(path, |file| write_to(file, width, pixels))
}

/// The bytes of the picture's file.
pub(super) fn encode_picture(picture: &Picture, exposure: f64) -> Result<Vec<u8>, String> {
    let mut file = Vec::new();
    write_to(&mut file, picture.size.width(), &shown(picture, exposure))?;
    Ok(file)
}

fn shown(picture: &Picture, exposure: f64) -> Vec<[u8; 3]> {
    let gain = exposure.exp2();
    picture.rgb.iter().map(|rgb| rgb.map(|x| encode(f64::from(x) * gain))).collect()
}

fn write_to(file: impl Write, width: u32, pixels: &[[u8; 3]]) -> Result<(), String> {
    let height = u32::try_from(pixels.len() / width as usize).unwrap_or(u32::MAX);
    PngEncoder::new(file)
        .write_image(pixels.as_flattened(), width, height, image::ExtendedColorType::Rgb8)
        .map_err(|error| error.to_string())
}

/// Writes a drawing of eight-bit RGB with the name of the software in its header.
pub(super) fn write_plot(
    path: &Path,
    rgb: &[u8],
    (width, height): (u32, u32),
    software: &str,
) -> Result<(), FileError> {
    replace(path, |file| {
        let mut encoder = png::Encoder::new(file, width, height);
        encoder.set_color(png::ColorType::Rgb);
        encoder
            .add_text_chunk("Software".to_owned(), software.to_owned())
            .and_then(|()| encoder.write_header()?.write_image_data(rgb))
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
