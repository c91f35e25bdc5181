//! Reads the film of an EXR file: the exact sums, and where they come from.

use super::header::{self, required, text};
use super::{Origin, Provenance, SUMS};
use crate::film::{Film, PixelWords};
use crate::report::FileError;
use exr::block::UncompressedBlock;
use exr::block::reader::Reader;
use exr::error::Error;
use exr::meta::MetaData;
use exr::meta::attribute::{ChannelList, SampleType};
use exr::prelude::Vec2;
use rayon::prelude::*;
use std::fs::File;
use std::io::BufReader;
use std::path::{Path, PathBuf};

/// Bytes of pixels that are taken apart at a time: enough for some threads (a chunk of candor's
/// has 16 rows, 2 MB of a picture 1920 pixels wide), little beside a film. A chunk of another
/// program's file may be as large as the whole picture.
const AT_A_TIME: usize = 1 << 24;

/// A film in a file, known by its header before its sums are read.
#[derive(Debug, Clone)]
pub struct StoredFilm {
    path: PathBuf,
    /// Where it comes from.
    pub provenance: Provenance,
    checksum: u32,
}

impl StoredFilm {
    /// Reads the header.
    ///
    /// # Errors
    /// If the file cannot be read, is no film of candor's, or holds no sums.
    pub fn open(path: &Path) -> Result<Self, FileError> {
        let fail = |reason: String| FileError::new(path, &reason);
        let reader = reader(path)?;
        let [part] = reader.headers() else {
            return Err(fail("has several parts; a film has one".to_owned()));
        };
        if text(part, "numbers").is_none() {
            return Err(fail(
                "is no film of this program: its header has no candor.numbers".into(),
            ));
        }
        if words(&part.channels).iter().flatten().count() < SUMS.len() {
            let reason = "holds no exact sums (it was written with --no-state, or another program \
                          wrote it); nothing can be added to it";
            return Err(fail(reason.to_owned()));
        }
        let (found, stated) =
            (header::checksum(&part.own_attributes), text(part, "headerChecksum"));
        if stated.and_then(|text| text.parse().ok()) != Some(found) {
            return Err(fail("is torn: its header does not have the checksum that it says".into()));
        }
        let provenance = Provenance::read(part).map_err(fail)?;
        let checksum = required(part, "checksum").map_err(fail)?;
        Ok(Self { path: path.to_owned(), provenance, checksum })
    }

    /// The file.
    #[must_use]
    pub fn path(&self) -> &Path {
        &self.path
    }

    /// Reads the sums.
    ///
    /// # Errors
    /// If the file is torn or was changed since its header was read, so that the sums are not
    /// those that were written.
    pub fn read(&self) -> Result<Film, FileError> {
        let fail = |reason: String| FileError::new(&self.path, &reason);
        let Provenance { origin: Origin { identity, .. }, samples, .. } = &self.provenance;
        let reader = reader(&self.path)?;
        let sizes: Vec<_> = reader.headers().iter().map(|part| part.layer_size).collect();
        let Vec2(width, height) = Vec2(identity.size.width(), identity.size.height());
        if sizes != [Vec2(width as usize, height as usize)] {
            return Err(fail("changed while it was read".to_owned()));
        }
        let mut film = Film::awaiting(identity.size, identity.scale, samples.clone());
        read_words(reader, width as usize, film.pixels_mut()).map_err(|error| match error {
            Error::NotSupported(what) => fail(format!("cannot be read: {what}")),
            other => fail(format!("is torn: {other}")),
        })?;
        let found = film.checksum();
        if found != self.checksum {
            let stated = self.checksum;
            return Err(fail(format!(
                "is torn: its sums have the checksum {found}, its header says {stated}"
            )));
        }
        Ok(film)
    }
}

fn reader(path: &Path) -> Result<Reader<BufReader<File>>, FileError> {
    // A pipe would be waited for.
    match path.metadata() {
        Ok(there) if there.is_dir() => {
            return Err(FileError::new(path, &"is a folder, not a file"));
        }
        Ok(there) if !there.is_file() => return Err(FileError::new(path, &"is no regular file")),
        _ => {}
    }
    let file = File::open(path).map_err(|error| FileError::new(path, &error))?;
    exr::block::read(BufReader::new(file), false)
        .map_err(|error| FileError::new(path, &format!("is not a readable EXR: {error}")))
}

/// Which word of a pixel each channel holds, if any.
fn words(channels: &ChannelList) -> Vec<Option<usize>> {
    let word = |channel: &exr::meta::attribute::ChannelDescription| {
        let plain = channel.sample_type == SampleType::U32 && channel.sampling == Vec2(1, 1);
        SUMS.iter().position(|name| plain && channel.name == **name)
    };
    channels.list.iter().map(word).collect()
}

/// Reads the sums of all pixels. Chunks come from the file one after another and are taken apart
/// on all cores.
fn read_words(
    reader: Reader<BufReader<File>>,
    width: usize,
    pixels: &mut [PixelWords],
) -> Result<(), Error> {
    let meta = reader.meta_data().clone();
    let words = words(&meta.headers[0].channels);
    let at_a_time = (AT_A_TIME / meta.headers[0].max_block_byte_size().max(1)).max(1);
    let mut chunks = reader.all_chunks(false)?;
    loop {
        let some: Vec<_> = chunks.by_ref().take(at_a_time).collect();
        if some.is_empty() {
            return Ok(());
        }
        let blocks: Vec<_> = some
            .into_par_iter()
            .map(|chunk| UncompressedBlock::decompress_chunk(chunk?, &meta, false))
            .collect();
        for block in blocks {
            copy(&block?, &meta, &words, width, pixels);
        }
    }
}

fn copy(
    block: &UncompressedBlock,
    meta: &MetaData,
    words: &[Option<usize>],
    width: usize,
    pixels: &mut [PixelWords],
) {
    for line in block.lines(&meta.headers[0].channels) {
        let Some(word) = words[line.location.channel] else { continue };
        let first = line.location.position.y() * width + line.location.position.x();
        let row = &mut pixels[first..first + line.location.sample_count];
        for (pixel, &bytes) in row.iter_mut().zip(line.value.as_chunks().0) {
            pixel[word] = u32::from_ne_bytes(bytes);
        }
    }
}
