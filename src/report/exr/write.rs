//! Writes a picture, and the film that it shows, as an EXR file.

use super::header::checksum;
use super::{HEADER_CHECKSUM, PREFIX, Provenance, REC_709, STANDARD_ERROR, SUMS};
use crate::film::{Film, WORDS};
use crate::report::{FileError, Picture, replace};
use exr::block::writer::ChunksWriter;
use exr::block::{self, BlockIndex, UncompressedBlock, enumerate_ordered_header_block_indices};
use exr::meta::BlockDescription;
use exr::meta::attribute::{AttributeValue, ChannelDescription, LineOrder, SampleType, Text};
use exr::meta::header::{Header, ImageAttributes, LayerAttributes};
use exr::prelude::{Compression, Vec2};
use std::path::Path;

/// The exact sums, which make a picture a film.
#[derive(Debug, Clone, Copy)]
pub enum Sums<'a> {
    /// Left out: a picture that nothing can be added to.
    LeftOut,
    /// Without compression: soon written, large, for a while.
    Quick(&'a Film),
    /// Compressed without loss, to be kept.
    Compact(&'a Film),
}

impl<'a> Sums<'a> {
    fn film(self) -> Option<&'a Film> {
        match self {
            Self::LeftOut => None,
            Self::Quick(film) | Self::Compact(film) => Some(film),
        }
    }

    fn compression(self) -> Compression {
        match self {
            Self::Quick(_) => Compression::Uncompressed,
            Self::LeftOut | Self::Compact(_) => Compression::ZIP16,
        }
    }
}

/// Writes channels R, G, B and `stderr.L`, the words of the sums, and the provenance in the
/// header.
///
/// # Errors
/// If the file cannot be written; one that was there is then untouched.
pub fn write(
    path: &Path,
    picture: &Picture,
    sums: Sums,
    provenance: &Provenance,
) -> Result<(), FileError> {
    let channels = channels(sums.film().is_some());
    let header = header(picture, &channels, sums, provenance);
    let rows = Rows { picture, film: sums.film(), channels: &channels };
    replace(path, |file| {
        block::write(file, [header].into_iter().collect(), true, |meta, chunks| {
            let indices = enumerate_ordered_header_block_indices(&meta.headers);
            let blocks = indices.map(|(number, index)| (number, rows.block(index)));
            let chunks = chunks.on_progress(|_| ());
            match sums {
                // Copying has nothing to gain from threads that take turns with the render's.
                Sums::Quick(_) => chunks.compress_all_blocks_sequential(&meta, blocks),
                _ => chunks.compress_all_blocks_parallel(&meta, blocks),
            }
        })
        .map_err(|error| error.to_string())
    })
}

/// What a channel holds.
#[derive(Debug, Clone, Copy)]
enum Source {
    Colour(usize),
    Error,
    Word(usize),
}

/// The channels in the order of the file: by name.
fn channels(with_sums: bool) -> Vec<(&'static str, Source)> {
    let colours = ["R", "G", "B"].into_iter().zip((0..3).map(Source::Colour));
    let words = SUMS.into_iter().zip((0..WORDS).map(Source::Word)).filter(|_| with_sums);
    let mut all: Vec<_> = colours.chain([(STANDARD_ERROR, Source::Error)]).chain(words).collect();
    all.sort_unstable_by_key(|&(name, _)| name);
    all
}

fn header(
    picture: &Picture,
    channels: &[(&'static str, Source)],
    sums: Sums,
    provenance: &Provenance,
) -> Header {
    let described = channels.iter().map(|&(name, source)| {
        let kind = match source {
            Source::Colour(_) | Source::Error => SampleType::F32,
            Source::Word(_) => SampleType::U32,
        };
        ChannelDescription::named(name, kind)
    });
    let size = Vec2(picture.size.width() as usize, picture.size.height() as usize);
    let mut own = LayerAttributes {
        software_name: Some(Text::from(concat!("candor ", env!("CARGO_PKG_VERSION")))),
        ..LayerAttributes::default()
    };
    let mut attributes = provenance.attributes();
    attributes.extend(sums.film().map(|film| ("checksum", film.checksum().to_string())));
    for (name, value) in attributes {
        let name = Text::from(format!("{PREFIX}{name}").as_str());
        own.other.insert(name, AttributeValue::Text(utf8(&value)));
    }
    let checksum = AttributeValue::Text(Text::from(checksum(&own).to_string().as_str()));
    own.other.insert(Text::from(HEADER_CHECKSUM), checksum);
    let shared =
        ImageAttributes { chromaticities: Some(REC_709), ..ImageAttributes::with_size(size) };
    Header::new(Text::default(), size, described.collect())
        .with_encoding(sums.compression(), BlockDescription::ScanLines, LineOrder::Increasing)
        .with_shared_attributes(shared)
        .with_attributes(own)
}

/// Header texts are UTF-8, as `OpenEXR`'s own library takes them. The crate's would be Latin-1, which
/// others cannot read.
fn utf8(text: &str) -> Text {
    Text::from_slice_unchecked(text.as_bytes())
}

/// The rows of the file, made when they are written: all of them at once would take as much
/// memory as the film once more.
struct Rows<'a> {
    picture: &'a Picture,
    film: Option<&'a Film>,
    channels: &'a [(&'static str, Source)],
}

impl Rows<'_> {
    fn block(&self, index: BlockIndex) -> UncompressedBlock {
        let Vec2(width, height) = index.pixel_size;
        let mut data = Vec::with_capacity(4 * width * height * self.channels.len());
        for row in index.pixel_position.y()..index.pixel_position.y() + height {
            for &(_, source) in self.channels {
                self.line(row * width..(row + 1) * width, source, &mut data);
            }
        }
        UncompressedBlock { index, data }
    }

    fn line(&self, pixels: std::ops::Range<usize>, source: Source, data: &mut Vec<u8>) {
        match source {
            Source::Colour(c) => {
                let values = self.picture.rgb[pixels].iter().map(|rgb| rgb[c].to_ne_bytes());
                values.for_each(|bytes| data.extend_from_slice(&bytes));
            }
            Source::Error => {
                data.extend_from_slice(bytemuck::cast_slice(&self.picture.luminance_error[pixels]));
            }
            Source::Word(word) => {
                let all = self.film.map_or(&[][..], |film| &film.pixels()[pixels]);
                let values = all.iter().map(|words| words[word].to_ne_bytes());
                values.for_each(|bytes| data.extend_from_slice(&bytes));
            }
        }
    }
}
