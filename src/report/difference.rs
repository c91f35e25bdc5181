//! The picture of where two pictures differ: blue, white, red, in eight-bit PNG.

use super::{FileError, png};
use crate::estimate::DifferenceMap;
use std::path::Path;

/// The colours of -5, -4, … 5 units in sRGB: the scheme `RdBu` of Brewer and Harrower's
/// `ColorBrewer` 2.0, whose two ends people with any common colour blindness tell apart.
const COLOURS: [[u8; 3]; 11] = [
    [5, 48, 97],
    [33, 102, 172],
    [67, 147, 195],
    [146, 197, 222],
    [209, 229, 240],
    [247, 247, 247],
    [253, 219, 199],
    [244, 165, 130],
    [214, 96, 77],
    [178, 24, 43],
    [103, 0, 31],
];

/// Differences of this many units have full colour.
pub const FULL_COLOUR: u8 = 5;

/// Where nothing is known of the error.
const UNKNOWN: [u8; 3] = [128, 128, 128];

const WHITE: [u8; 3] = [255, 255, 255];

/// Rows of the legend below the picture, one colour for each unit, and of the gap above it.
const LEGEND: usize = 12;
const GAP: usize = 4;

/// Narrower pictures have no legend: its eleven colours could not be told apart.
const MIN_LEGEND_WIDTH: usize = 44;

/// Writes the map, pixel by pixel as large as the pictures, with the eleven colours of
/// -5 … 5 units below it.
///
/// # Errors
/// If the file cannot be written; one that was there is then untouched.
pub fn write(path: &Path, map: &DifferenceMap) -> Result<(), FileError> {
    let (width, height) = (map.size.width() as usize, map.size.height() as usize);
    let columns = width.div_ceil(map.block);
    let at = |x: usize, y: usize| colour(map.values[y / map.block * columns + x / map.block]);
    let mut rows: Vec<[u8; 3]> =
        (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| at(x, y)).collect();
    if width >= MIN_LEGEND_WIDTH {
        rows.extend(std::iter::repeat_n(WHITE, GAP * width));
        for _ in 0..LEGEND {
            rows.extend((0..width).map(|x| COLOURS[x * COLOURS.len() / width]));
        }
    }
    png::write_rgb(path, map.size.width(), &rows)
}

/// Between two colours of the scale the bytes are blended.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "clamped to the scale, and bytes between bytes"
)]
fn colour(units: f32) -> [u8; 3] {
    if units.is_nan() {
        return UNKNOWN;
    }
    let full = f32::from(FULL_COLOUR);
    let place = units.clamp(-full, full) + full;
    let below = (place as usize).min(COLOURS.len() - 2);
    let share = if place < 2.0 * full { place.fract() } else { 1.0 };
    std::array::from_fn(|c| {
        let (from, to) = (f32::from(COLOURS[below][c]), f32::from(COLOURS[below + 1][c]));
        (from + share * (to - from)).round() as u8
    })
}

#[cfg(test)]
mod tests {
    use super::{COLOURS, UNKNOWN, colour};

    /// Whole units have the colours of the scheme, what lies beyond has its ends.
    #[test]
    fn colours_of_differences() {
        for (units, place) in [(0.0, 5), (-5.0, 0), (5.0, 10), (2.0, 7), (-1e9, 0), (1e9, 10)] {
            assert_eq!(colour(units), COLOURS[place], "{units}");
        }
        assert_eq!(colour(f32::INFINITY), COLOURS[10]);
        assert_eq!(colour(0.5), [250, 233, 223], "halfway between two");
        assert_eq!(colour(f32::NAN), UNKNOWN);
    }
}
