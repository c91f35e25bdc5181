//! Reads a picture from an EXR file, candor's own or another program's.

use super::header::{size, text};
use super::{REC_709, STANDARD_ERROR};
use crate::estimate::{Bars, Measured};
use crate::film::SampleRanges;
use crate::report::FileError;
use crate::scene::ImageSize;
use exr::meta::MetaData;
use exr::meta::attribute::{Chromaticities, SampleType, Text};
use exr::meta::header::Header;
use exr::prelude::{ReadChannels, ReadLayers, ReadSpecificChannel, Vec2, read};
use std::path::{Path, PathBuf};

/// Relative rounding of a half float (IEEE 754 binary16: 11 bits) and of an `f32`.
const HALF_ROUNDING: f64 = 1.0 / 2048.0;
const SINGLE_ROUNDING: f64 = 1.0 / 16_777_216.0;

/// Coordinates of primaries are written with two to four decimals.
const SAME_PRIMARY: f32 = 1e-3;

/// What an EXR file says of its picture, known before its pixels are read. All that only
/// candor writes is `None` in files of other programs.
#[derive(Debug, Clone)]
pub struct PictureHeader {
    path: PathBuf,
    /// Size of the data window.
    pub size: ImageSize,
    /// Whether R, G or B is stored in half floats.
    pub half: bool,
    /// Whether the file names primaries other than Rec. 709's.
    pub other_primaries: bool,
    /// The samples of every pixel. Only what has error bars has samples.
    pub samples: Option<SampleRanges>,
    /// Hash of what the scene means, in hex.
    pub scene_hash: Option<String>,
    /// Estimator.
    pub estimator: Option<String>,
    /// Most scatterings of one path.
    pub bounces: Option<String>,
    /// Seed of the random numbers.
    pub seed: Option<u32>,
    /// Device that traced it.
    pub device: Option<String>,
    /// How many of its samples were invalid, and count as zeros.
    pub invalid_samples: Option<u64>,
    /// The first of them: column, row, sample index and reason of each.
    pub invalid_records: Option<String>,
}

/// A picture from a file.
#[derive(Debug, Clone)]
pub struct StoredPicture {
    /// What the file says of it.
    pub header: PictureHeader,
    /// Mean radiance per channel, row by row from the top; finite.
    pub rgb: Vec<[f32; 3]>,
    /// Standard error of the mean luminance, where the file has it; infinite where it is
    /// unproven, which only black pixels are.
    pub luminance_error: Option<Vec<f32>>,
}

impl PictureHeader {
    /// Reads the header of the first part that has channels R, G and B.
    ///
    /// # Errors
    /// If the file cannot be read, is no EXR, or has no such part in a form that can be
    /// compared; if it has error bars, but does not say of which samples.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        if path.is_dir() {
            return Err(FileError::new(path, &"is a folder, not a file"));
        }
        let file = std::fs::File::open(path).map_err(|error| FileError::new(path, &error))?;
        let meta = MetaData::read_from_buffered(std::io::BufReader::new(file), false)
            .map_err(|error| FileError::new(path, &format!("is not a readable EXR: {error}")))?;
        let part = meta.headers.iter().find(|part| has(part, &["R", "G", "B"]));
        let Some(part) = part else {
            return Err(FileError::new(path, &without_colours(&meta)));
        };
        Self::of(path, part).map_err(|reason| FileError::new(path, &reason))
    }

    fn of(path: &Path, part: &Header) -> Result<Self, String> {
        if part.deep {
            return Err("holds deep data, which has no single value per pixel".to_owned());
        }
        let colours = || part.channels.list.iter().filter(|c| is_colour(&c.name));
        if colours().any(|channel| channel.sampling != Vec2(1, 1)) {
            return Err("R, G and B are subsampled".to_owned());
        }
        let size = size(part)?;
        let samples = text(part, "samples").and_then(|ranges| ranges.parse().ok());
        let has_bars = has(part, &[STANDARD_ERROR]);
        if has_bars && samples.is_none() {
            let header = "its header does not say of which samples (candor.samples)";
            return Err(format!("has error bars ({STANDARD_ERROR}), but {header}"));
        }
        let primaries = part.shared_attributes.chromaticities;
        Ok(Self {
            path: path.to_owned(),
            size,
            half: colours().any(|channel| channel.sample_type == SampleType::F16),
            other_primaries: primaries.is_some_and(|found| !same_primaries(&found, &REC_709)),
            samples: samples.filter(|_| has_bars),
            scene_hash: text(part, "sceneHash"),
            estimator: text(part, "estimator"),
            bounces: text(part, "bounces"),
            seed: text(part, "seed").and_then(|seed| seed.parse().ok()),
            device: text(part, "device"),
            invalid_samples: text(part, "invalidSamples").and_then(|count| count.parse().ok()),
            invalid_records: text(part, "invalidRecords"),
        })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Reads the pixels.
    ///
    /// # Errors
    /// If the file is torn, or holds values that no picture or error bar can have.
    pub fn read_pixels(self) -> Result<StoredPicture, FileError> {
        let fail = |reason: &str| FileError::new(&self.path, &reason);
        // One thread: a worker that panics on a corrupt block would abort the process.
        let image = read()
            .no_deep_data()
            .largest_resolution_level()
            .specific_channels()
            .required("R")
            .required("G")
            .required("B")
            .optional(STANDARD_ERROR, f32::NAN)
            .collect_pixels(Pixels::new, Pixels::set)
            .first_valid_layer()
            .all_attributes()
            .non_parallel()
            .from_file(&self.path)
            .map_err(|error| fail(&format!("its pixels cannot be read: {error}")))?;
        let Pixels { width, values } = image.layer_data.channel_data.pixels;
        if (width, values.len()) != (self.size.width() as usize, self.size.pixels() as usize) {
            return Err(fail("changed while it was read"));
        }
        let has_bars = self.samples.is_some();
        if let Some((i, reason)) = impossible(&values, has_bars) {
            return Err(fail(&format!("pixel {},{} {reason}", i % width, i / width)));
        }
        let rgb = values.iter().map(|&[r, g, b, _]| [r, g, b]).collect();
        let luminance_error = has_bars.then(|| values.iter().map(|&[.., error]| error).collect());
        Ok(StoredPicture { header: self, rgb, luminance_error })
    }
}

impl StoredPicture {
    /// The picture as the statistics take it.
    #[must_use]
    pub fn measured(&self) -> Measured<'_> {
        let samples = self.header.samples.as_ref().map_or(0, SampleRanges::count);
        let bars = self.luminance_error.as_deref();
        Measured {
            size: self.header.size,
            rgb: &self.rgb,
            bars: bars.map(|luminance_error| Bars { luminance_error, samples }),
            rounding: if self.header.half { HALF_ROUNDING } else { SINGLE_ROUNDING },
        }
    }
}

/// R, G, B and the standard error, as they come from the file.
struct Pixels {
    width: usize,
    values: Vec<[f32; 4]>,
}

impl Pixels {
    fn new<Channels>(Vec2(width, height): Vec2<usize>, _: &Channels) -> Self {
        Self { width, values: vec![[0.0; 4]; width * height] }
    }

    fn set(&mut self, at: Vec2<usize>, (r, g, b, error): (f32, f32, f32, f32)) {
        self.values[at.y() * self.width + at.x()] = [r, g, b, error];
    }
}

/// The first pixel with values that no picture or error bar can have, and what is wrong.
fn impossible(values: &[[f32; 4]], has_bars: bool) -> Option<(usize, String)> {
    values.iter().enumerate().find_map(|(i, &[r, g, b, error])| {
        let reason = if !(r.is_finite() && g.is_finite() && b.is_finite()) {
            format!("is not finite: R {r}, G {g}, B {b}")
        } else if !has_bars {
            return None;
        } else if error.is_nan() || error < 0.0 {
            format!("has {STANDARD_ERROR} {error}")
        } else if error.is_infinite() && [r, g, b].iter().any(|&x| x != 0.0) {
            "has light and no error: one sample says nothing of it; render at least 2".to_owned()
        } else {
            return None;
        };
        Some((i, reason))
    })
}

fn has(part: &Header, names: &[&str]) -> bool {
    names.iter().all(|&name| part.channels.list.iter().any(|channel| channel.name == *name))
}

fn is_colour(name: &Text) -> bool {
    ["R", "G", "B"].iter().any(|&colour| *name == *colour)
}

/// Says which channels are there where the colours are not.
fn without_colours(meta: &MetaData) -> String {
    let channels = || meta.headers.iter().flat_map(|part| &part.channels.list);
    let mut names: Vec<String> = channels().take(12).map(|c| c.name.to_string()).collect();
    if channels().count() > names.len() {
        names.push("…".to_owned());
    }
    format!("has no channels R, G and B; it has: {}", names.join(", "))
}

fn same_primaries(a: &Chromaticities, b: &Chromaticities) -> bool {
    let points = |c: &Chromaticities| [c.red, c.green, c.blue, c.white];
    std::iter::zip(points(a), points(b)).all(|(Vec2(ax, ay), Vec2(bx, by))| {
        (ax - bx).abs() < SAME_PRIMARY && (ay - by).abs() < SAME_PRIMARY
    })
}
