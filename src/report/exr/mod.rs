//! `OpenEXR`: the picture, its standard error, and the exact sums that it was made from, with
//! where they come from in the header. One file is what viewers show, what a render goes on
//! from, and what films are merged from.

mod film;
mod header;
mod picture;
mod there;
mod write;

pub use film::StoredFilm;
pub use header::{NextLook, Origin, Provenance, Spent};
pub use picture::{PictureHeader, StoredPicture};
pub use there::{There, look_at};
pub use write::{Sums, write};

use crate::film::WORDS;
use exr::meta::attribute::Chromaticities;
use exr::prelude::Vec2;

/// Prefix of candor's header attributes.
const PREFIX: &str = "candor.";

/// Attribute of the checksum of the others: a film with another list of samples, or of another
/// seed, would be as wrong as one with other sums.
const HEADER_CHECKSUM: &str = "candor.headerChecksum";

/// Channel of the standard error of the mean luminance.
const STANDARD_ERROR: &str = "stderr.L";

/// Channels of the words of a pixel, in the film's order, low word first: the sums of R, G and
/// B, and of the squared luminance.
const SUMS: [&str; WORDS] = [
    "sum.R.0", "sum.R.1", "sum.R.2", "sum.G.0", "sum.G.1", "sum.G.2", "sum.B.0", "sum.B.1",
    "sum.B.2", "sum.L2.0", "sum.L2.1", "sum.L2.2", "sum.L2.3",
];

/// Rec. 709 primaries and the D65 white point (ITU-R BT.709-6, table 1).
const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};
