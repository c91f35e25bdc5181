//! `OpenEXR`: mean radiance, its standard error, and where the picture comes from.

use super::{FileError, Picture, replace};
use crate::film::{SampleRanges, SampleScale};
use crate::scene::SceneHash;
use crate::tracer::{Description, InvalidSample, Ledger};
use exr::meta::MetaData;
use exr::meta::attribute::{AttributeValue, Chromaticities, Text};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Vec2,
    WritableImage,
};
use std::path::Path;

/// Prefix of candor's header attributes.
pub(super) const PREFIX: &str = "candor.";

/// Channel of the standard error of the mean luminance.
pub(super) const STANDARD_ERROR: &str = "stderr.L";

/// Rec. 709 primaries and the D65 white point (ITU-R BT.709-6, table 1).
pub(super) const REC_709: Chromaticities = Chromaticities {
    red: Vec2(0.64, 0.33),
    green: Vec2(0.30, 0.60),
    blue: Vec2(0.15, 0.06),
    white: Vec2(0.3127, 0.3290),
};

/// Where a picture comes from: everything that its samples depend on, and what they cost.
#[derive(Debug, Clone)]
pub struct Provenance {
    /// File name of the scene, without folders.
    pub scene_file: String,
    /// Hash of what the scene means.
    pub scene_hash: SceneHash,
    /// Estimator.
    pub estimator: &'static str,
    /// Most scatterings of one path.
    pub bounces: u32,
    /// Seed of the random numbers.
    pub seed: u32,
    /// Samples of every pixel.
    pub samples: SampleRanges,
    /// Film scale.
    pub scale: SampleScale,
    /// Device and driver.
    pub tracer: Description,
    /// Time spent tracing, in seconds.
    pub seconds: f64,
    /// Invalid samples; they count as zeros.
    pub ledger: Ledger,
    /// Pixels that no sample has contributed to yet.
    pub unproven_pixels: u64,
    /// Pixels whose film step exceeds 1e-6 of their mean.
    pub coarse_pixels: u64,
    /// Relative RMS error of the picture, where it is known.
    pub relative_error: Option<f64>,
    /// Upper confidence bound (99 %) on it, where there is one.
    pub error_bound: Option<f64>,
}

impl Provenance {
    /// Names and values; `width` is that of the picture in pixels.
    fn attributes(&self, width: u32) -> Vec<(&'static str, String)> {
        let mut list = vec![
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("scene", self.scene_file.clone()),
            ("sceneHash", self.scene_hash.to_string()),
            ("estimator", self.estimator.to_owned()),
            ("bounces", self.bounces.to_string()),
            ("seed", self.seed.to_string()),
            ("samples", self.samples.to_string()),
            ("spp", self.samples.count().to_string()),
            ("filmShift", self.scale.shift().to_string()),
            ("device", self.tracer.device.clone()),
            ("driver", self.tracer.driver.clone()),
            ("seconds", format!("{:.3}", self.seconds)),
            ("invalidSamples", self.ledger.count.to_string()),
            ("unprovenPixels", self.unproven_pixels.to_string()),
            ("coarsePixels", self.coarse_pixels.to_string()),
        ];
        let errors = [("relativeError", self.relative_error), ("errorBound", self.error_bound)];
        for (name, error) in errors {
            list.extend(error.map(|error| (name, error.to_string())));
        }
        if !self.ledger.records.is_empty() {
            list.push(("invalidRecords", records(&self.ledger, width)));
        }
        list
    }
}

/// Column, row, sample index and reason of each invalid sample that was recorded.
fn records(ledger: &Ledger, width: u32) -> String {
    let record = |sample: &InvalidSample| {
        let (column, row) = (sample.pixel % width, sample.pixel / width);
        format!("{column},{row} {} {}", sample.index, sample.reason.name())
    };
    ledger.records.iter().map(record).collect::<Vec<_>>().join("; ")
}

/// Writes channels R, G, B and `stderr.L` with the provenance in the header.
///
/// # Errors
/// If the file cannot be written; one that was there is then untouched.
pub fn write(path: &Path, picture: &Picture, provenance: &Provenance) -> Result<(), FileError> {
    let channel = |name: &str, values: Vec<f32>| AnyChannel::new(name, FlatSamples::F32(values));
    let plane = |c: usize| picture.rgb.iter().map(|rgb| rgb[c]).collect();
    let channels = AnyChannels::sort(
        [
            channel("R", plane(0)),
            channel("G", plane(1)),
            channel("B", plane(2)),
            channel(STANDARD_ERROR, picture.luminance_error.clone()),
        ]
        .into_iter()
        .collect(),
    );
    let mut attributes = LayerAttributes {
        software_name: Some(Text::from(concat!("candor ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    for (name, value) in provenance.attributes(picture.size.width()) {
        attributes.other.insert(
            Text::from(format!("{PREFIX}{name}").as_str()),
            AttributeValue::Text(latin(&value)),
        );
    }
    let size = Vec2(picture.size.width() as usize, picture.size.height() as usize);
    let layer = Layer::new(size, attributes, Encoding::SMALL_LOSSLESS, channels);
    let mut image = Image::from_layer(layer);
    image.attributes.chromaticities = Some(REC_709);
    replace(path, |file| image.write().to_buffered(file).map_err(|error| error.to_string()))
}

/// Header texts are Latin-1; other characters of a file or device name become '?'.
fn latin(text: &str) -> Text {
    let shown: String = text.chars().map(|c| if c as u32 <= 0xff { c } else { '?' }).collect();
    Text::new_or_none(&shown).unwrap_or_else(|| Text::from("?"))
}

/// Samples per pixel of the film in `path`; 0 where there is no file, or an empty one.
/// `None` if candor did not write it.
///
/// # Errors
/// If the file cannot be opened, though it is there.
pub fn film_samples(path: &Path) -> Result<Option<u64>, FileError> {
    match std::fs::File::open(path).and_then(|file| file.metadata()) {
        Err(error) if error.kind() == std::io::ErrorKind::NotFound => return Ok(Some(0)),
        Err(error) => return Err(FileError::new(path, &error)),
        Ok(there) if there.len() == 0 || !there.is_file() => return Ok(Some(0)),
        Ok(_) => {}
    }
    let Ok(meta) = MetaData::read_from_file(path, false) else { return Ok(None) };
    let wanted = Text::from(format!("{PREFIX}spp").as_str());
    let value = meta.headers.iter().find_map(|header| header.own_attributes.other.get(&wanted));
    Ok(match value {
        Some(AttributeValue::Text(text)) => text.to_string().parse().ok(),
        _ => None,
    })
}
