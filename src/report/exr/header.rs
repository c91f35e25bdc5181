//! Where a film comes from, as attributes of its file's header, written and read.

use super::{HEADER_CHECKSUM, PREFIX};
use crate::estimate::Summary;
use crate::film::{Film, Identity, SampleRanges, SampleScale};
use crate::report::printable;
use crate::scene::{Estimator, ImageSize};
use crate::tracer::{Description, InvalidReason, InvalidSample, Ledger};
use exr::meta::attribute::{AttributeValue, Text};
use exr::meta::header::{Header, LayerAttributes};
use exr::prelude::Vec2;
use std::fmt;
use std::str::FromStr;

/// Where a film comes from, whichever samples it holds.
#[derive(Debug, Clone, PartialEq)]
pub struct Origin {
    /// File name of the scene, without folders.
    pub scene_file: String,
    /// What the samples depend on.
    pub identity: Identity,
    /// Whether the scene has no lights, so that zeros are exact.
    pub dark: bool,
    /// Device and driver; of a film that several made, all of them.
    pub tracer: Description,
}

/// What went into a film.
#[derive(Debug, Clone, PartialEq)]
pub struct Spent {
    /// Invalid samples; they count as zeros.
    pub ledger: Ledger,
    /// Time spent tracing, in seconds, on all machines together.
    pub seconds: f64,
    /// Where a render to a stated error would have looked at it next.
    pub next_look: Option<NextLook>,
}

/// What a film's header says.
#[derive(Debug, Clone, PartialEq)]
pub struct Provenance {
    /// Where it comes from.
    pub origin: Origin,
    /// What went into it.
    pub spent: Spent,
    /// Samples of every pixel.
    pub samples: SampleRanges,
    /// Pixels that no sample has contributed to yet.
    pub unproven_pixels: u64,
    /// Pixels whose film step exceeds 1e-6 of their mean.
    pub coarse_pixels: u64,
    /// Relative RMS error of the picture, where it is known.
    pub relative_error: Option<f64>,
    /// Upper confidence bound (99 %) on it, where there is one.
    pub error_bound: Option<f64>,
}

/// The look at the error that a render had planned when its film was written. Who goes on to the
/// same target looks there, and so ends with the same samples as if nothing had come between.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct NextLook {
    /// The relative RMS error that was aimed at.
    pub target: f64,
    /// Samples per pixel at the look.
    pub samples: u64,
}

impl NextLook {
    /// The look, if there is a target.
    #[must_use]
    pub fn planned(target: Option<f64>, samples: Option<u64>) -> Option<Self> {
        Some(Self { target: target?, samples: samples? })
    }
}

impl Provenance {
    /// That of a film with this summary.
    #[must_use]
    pub fn new(origin: Origin, spent: Spent, film: &Film, summary: &Summary) -> Self {
        Self {
            origin,
            spent,
            samples: film.samples().clone(),
            unproven_pixels: summary.unproven_pixels,
            coarse_pixels: summary.coarse_pixels,
            relative_error: summary.relative_error,
            error_bound: summary.error_bound,
        }
    }

    /// Names and values.
    pub(super) fn attributes(&self) -> Vec<(&'static str, String)> {
        let Origin { scene_file, identity, dark, tracer } = &self.origin;
        let Spent { ledger, seconds, next_look } = &self.spent;
        let mut list = vec![
            ("version", env!("CARGO_PKG_VERSION").to_owned()),
            ("numbers", identity.numbers.to_string()),
            ("scene", scene_file.clone()),
            ("sceneHash", identity.scene.to_string()),
            ("estimator", identity.estimator.name().to_owned()),
            ("bounces", identity.bounces.to_string()),
            ("seed", identity.seed.to_string()),
            ("samples", self.samples.to_string()),
            ("spp", self.samples.count().to_string()),
            ("filmShift", identity.scale.shift().to_string()),
            ("sampleBound", identity.scale.bound().to_string()),
            ("device", tracer.device.clone()),
            ("driver", tracer.driver.clone()),
            ("software", tracer.software.to_string()),
            ("seconds", format!("{seconds:.3}")),
            ("dark", dark.to_string()),
            ("invalidSamples", ledger.count.to_string()),
            ("unprovenPixels", self.unproven_pixels.to_string()),
            ("coarsePixels", self.coarse_pixels.to_string()),
        ];
        let errors = [("relativeError", self.relative_error), ("errorBound", self.error_bound)];
        for (name, error) in errors {
            list.extend(error.map(|error| (name, error.to_string())));
        }
        list.extend(next_look.map(|look| ("nextLook", look.to_string())));
        if !ledger.records.is_empty() {
            list.push(("invalidRecords", records(ledger, identity.size.width())));
        }
        list
    }

    /// Reads what [`Self::attributes`] wrote.
    ///
    /// # Errors
    /// The attribute that is missing, or what is wrong with it.
    pub(super) fn read(part: &Header) -> Result<Self, String> {
        let size = size(part)?;
        let identity = Identity {
            numbers: required(part, "numbers")?,
            size,
            scene: required(part, "sceneHash")?,
            estimator: required::<Estimator>(part, "estimator")?,
            bounces: required(part, "bounces")?,
            seed: required(part, "seed")?,
            scale: scale(part)?,
        };
        let samples: SampleRanges = required(part, "samples")?;
        let tracer = Description {
            device: required(part, "device")?,
            driver: required(part, "driver")?,
            software: required(part, "software")?,
        };
        Ok(Self {
            origin: Origin {
                scene_file: required(part, "scene")?,
                identity,
                dark: required(part, "dark")?,
                tracer,
            },
            spent: Spent {
                ledger: ledger(part, size, &samples)?,
                seconds: seconds(part, "seconds")?,
                next_look: optional::<NextLook>(part, "nextLook")?,
            },
            samples,
            unproven_pixels: required(part, "unprovenPixels")?,
            coarse_pixels: required(part, "coarsePixels")?,
            relative_error: optional(part, "relativeError")?,
            error_bound: optional(part, "errorBound")?,
        })
    }
}

impl fmt::Display for NextLook {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{} for {}", self.samples, self.target)
    }
}

/// Reads `608 for 0.01`.
impl FromStr for NextLook {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let parts = text.split_once(" for ");
        let look = parts.and_then(|(samples, target)| {
            Some(Self { samples: samples.parse().ok()?, target: target.parse().ok()? })
        });
        look.ok_or_else(|| "expected SAMPLES for ERROR".to_owned())
    }
}

/// CRC-32 of candor's attributes but the checksum itself: of each, in the order of their names,
/// its name, an equals sign, its text and a line feed.
pub(super) fn checksum(own: &LayerAttributes) -> u32 {
    let ours = own.other.iter().filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some((name.as_slice(), text.as_slice())),
        _ => None,
    });
    let mut ours: Vec<_> = ours
        .filter(|(name, _)| name.starts_with(PREFIX.as_bytes()))
        .filter(|&(name, _)| name != HEADER_CHECKSUM.as_bytes())
        .collect();
    ours.sort_unstable();
    let mut hasher = crc32fast::Hasher::new();
    for (name, text) in ours {
        for part in [name, b"=", text, b"\n"] {
            hasher.update(part);
        }
    }
    hasher.finalize()
}

/// Nobody has spent more: some 30,000 years.
const MOST_SECONDS: f64 = 1e12;

/// Size of the data window.
pub(super) fn size(part: &Header) -> Result<ImageSize, String> {
    let Vec2(width, height) = part.layer_size;
    let pixels = |length: usize| u32::try_from(length).unwrap_or(u32::MAX);
    ImageSize::new(pixels(width), pixels(height))
        .map_err(|allowed| format!("is {width}x{height}; each side must be {allowed}"))
}

/// The text of an attribute of candor's.
pub(super) fn text(part: &Header, name: &str) -> Option<String> {
    let name = Text::new_or_none(format!("{PREFIX}{name}"))?;
    match part.own_attributes.other.get(&name)? {
        AttributeValue::Text(text) => Some(printable(&String::from_utf8_lossy(text.as_slice()))),
        _ => None,
    }
}

pub(super) fn required<T: FromStr<Err: fmt::Display>>(
    part: &Header,
    name: &str,
) -> Result<T, String> {
    match optional(part, name)? {
        Some(value) => Ok(value),
        None => Err(format!("its header has no {PREFIX}{name}")),
    }
}

fn optional<T: FromStr<Err: fmt::Display>>(part: &Header, name: &str) -> Result<Option<T>, String> {
    let parsed = text(part, name).map(|value| {
        let parsed = value.parse();
        parsed.map_err(|error| format!("{PREFIX}{name} in its header is \"{value}\": {error}"))
    });
    parsed.transpose()
}

fn seconds(part: &Header, name: &str) -> Result<f64, String> {
    let value: f64 = required(part, name)?;
    if (0.0..=MOST_SECONDS).contains(&value) {
        return Ok(value);
    }
    Err(format!("{PREFIX}{name} in its header is {value}: expected 0 to {MOST_SECONDS}"))
}

/// The scale, from the bound that it was made from.
fn scale(part: &Header) -> Result<SampleScale, String> {
    let (bound, shift): (f32, i32) = (required(part, "sampleBound")?, required(part, "filmShift")?);
    let scale = (bound.is_normal() && bound > 0.0).then(|| SampleScale::from_bound(bound.into()));
    scale.filter(|scale| scale.shift() == shift).ok_or_else(|| {
        format!("{PREFIX}sampleBound {bound} and {PREFIX}filmShift {shift} in its header disagree")
    })
}

/// Column, row, sample index and reason of each invalid sample that was recorded.
fn records(ledger: &Ledger, width: u32) -> String {
    let record = |sample: &InvalidSample| {
        let (column, row) = (sample.pixel % width, sample.pixel / width);
        format!("{column},{row} {} {}", sample.index, sample.reason.name())
    };
    ledger.records.iter().map(record).collect::<Vec<_>>().join("; ")
}

fn ledger(part: &Header, size: ImageSize, samples: &SampleRanges) -> Result<Ledger, String> {
    let mut ledger = Ledger { count: required(part, "invalidSamples")?, records: Vec::new() };
    let all = u64::from(size.pixels()).saturating_mul(samples.count());
    if ledger.count > all {
        let count = ledger.count;
        return Err(format!("{PREFIX}invalidSamples in its header is {count}, of {all} samples"));
    }
    for record in text(part, "invalidRecords").iter().flat_map(|records| records.split("; ")) {
        let Some(sample) = invalid_sample(record, size) else {
            return Err(format!("{PREFIX}invalidRecords in its header has \"{record}\""));
        };
        ledger.records.push(sample);
    }
    Ok(ledger)
}

/// Reads `12,34 56 nan`.
fn invalid_sample(record: &str, size: ImageSize) -> Option<InvalidSample> {
    let mut words = record.split(' ');
    let (column, row) = words.next()?.split_once(',')?;
    let (column, row): (u32, u32) = (column.parse().ok()?, row.parse().ok()?);
    if column >= size.width() || row >= size.height() {
        return None;
    }
    let index = words.next()?.parse().ok()?;
    let reason = InvalidReason::named(words.next()?)?;
    Some(InvalidSample { pixel: row * size.width() + column, index, reason })
}
