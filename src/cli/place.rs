//! Where a film is to go: what is there, and whether it may be replaced.

use crate::film::{Identity, SampleRanges};
use crate::report::{FileError, There, look_at};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

/// What is there and would be lost.
pub(super) struct InTheWay {
    /// What it holds, in words.
    pub what: String,
    /// Whether `--resume` would go on from it.
    pub same_picture: bool,
}

/// A film that is to be written.
pub(super) struct Ours<'a> {
    /// Of which picture, where that is known.
    pub identity: Option<&'a Identity>,
    pub samples: &'a SampleRanges,
    pub has_sums: bool,
    /// Whether what is there was not there when the work began, so that nobody has agreed to
    /// lose it.
    pub came_later: bool,
}

/// By what a file is known again.
#[derive(Debug, PartialEq)]
pub(super) struct Stamp(u64, Option<SystemTime>);

impl Stamp {
    /// That of a file, if there is one.
    pub fn of(path: &Path) -> Option<Self> {
        let there = path.metadata().ok()?;
        Some(Self(there.len(), there.modified().ok()))
    }
}

/// What a finished film must not replace unasked: what candor did not write, more samples, samples
/// of the same picture that it does not hold, sums if it has none itself, and another picture that
/// came there meanwhile.
pub(super) fn in_the_way(path: &Path, ours: &Ours) -> Result<Option<InTheWay>, FileError> {
    let &Ours { identity, samples, has_sums, came_later } = ours;
    let (there, provenance, sums) = match look_at(path)? {
        There::Nothing => return Ok(None),
        There::Foreign => {
            let what = "something that candor did not write".to_owned();
            return Ok(Some(InTheWay { what, same_picture: false }));
        }
        There::Film { samples, provenance, sums } => (samples, provenance, sums),
    };
    let same = provenance.filter(|there| Some(&there.origin.identity) == identity);
    let same_picture = same.is_some();
    let others = same.filter(|there| !samples.contains(&there.samples));
    let what = if there > samples.count() {
        let ours = samples.count();
        format!("{there} samples per pixel, more than {ours}")
    } else if let Some(others) = others {
        format!("samples {} of the same picture", others.samples)
    } else if same_picture && sums && !has_sums {
        "the exact sums, which --no-state leaves out".to_owned()
    } else if came_later && !same_picture {
        "another film by now".to_owned()
    } else {
        return Ok(None);
    };
    Ok(Some(InTheWay { what, same_picture }))
}

/// Where a checkpoint of these samples goes: to `path`, unless something else is there than a
/// film of the same picture that has no other samples; then beside it.
pub(super) fn for_checkpoint(
    path: &Path,
    identity: &Identity,
    samples: &SampleRanges,
) -> Result<PathBuf, FileError> {
    let there = look_at(path)?;
    if there == There::Nothing || is_part(&there, identity, samples) {
        return Ok(path.to_owned());
    }
    beside(path)
}

/// Whether what is there is a film of the same picture, none of whose samples would be lost with it.
pub(super) fn is_part(there: &There, identity: &Identity, samples: &SampleRanges) -> bool {
    match there {
        There::Film { provenance: Some(there), .. } => {
            there.origin.identity == *identity && samples.contains(&there.samples)
        }
        _ => false,
    }
}

/// The film beside `path` that a render of this picture left there, if one did.
pub(super) fn left_beside(path: &Path, identity: &Identity) -> Option<PathBuf> {
    let mut there = numbered(path).take_while(|name| name.exists());
    there.find(|name| match look_at(name) {
        Ok(There::Film { provenance: Some(film), .. }) => film.origin.identity == *identity,
        _ => false,
    })
}

/// The first of `box.1.exr`, `box.2.exr`, … that is not there yet.
pub(super) fn beside(path: &Path) -> Result<PathBuf, FileError> {
    let taken = || FileError::new(path, &"every name beside it is taken");
    numbered(path).find(|name| !name.exists()).ok_or_else(taken)
}

fn numbered(path: &Path) -> impl Iterator<Item = PathBuf> {
    let stem = path.file_stem().unwrap_or_default();
    let ending = path.extension().unwrap_or_default().to_string_lossy();
    (1..=u32::MAX).map(move |i| path.with_file_name(named(stem, &format!("{i}.{ending}"))))
}

/// The ending is added, not exchanged: `box.1.toml` makes `box.1.exr`, not `box.exr`.
pub(super) fn named(stem: &OsStr, ending: &str) -> PathBuf {
    let mut name = stem.to_owned();
    name.push(".");
    name.push(ending);
    PathBuf::from(name)
}
