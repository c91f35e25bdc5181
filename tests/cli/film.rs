//! Films as any reader of EXR sees them, and films made wrong on purpose.

use crate::candor::Folder;
use candor::report::{Picture, StoredFilm, Sums, write_exr};
use exr::meta::attribute::{AttributeValue, Text};
use exr::prelude::{FlatSamples, WritableImage, read_first_flat_layer_from_file};
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

/// The bits of all channels, so that equal means equal.
pub fn channels(path: &Path) -> BTreeMap<String, Vec<u32>> {
    let image = read_first_flat_layer_from_file(path).expect("the film can be read");
    let list = image.layer_data.channel_data.list.into_iter();
    list.map(|channel| {
        let bits = match channel.sample_data {
            FlatSamples::F32(samples) => samples.into_iter().map(f32::to_bits).collect(),
            FlatSamples::U32(samples) => samples,
            FlatSamples::F16(_) => panic!("{} is in half floats", channel.name),
        };
        (channel.name.to_string(), bits)
    })
    .collect()
}

/// Texts of the header.
pub fn attributes(path: &Path) -> BTreeMap<String, String> {
    let image = read_first_flat_layer_from_file(path).expect("the film can be read");
    let texts = image.layer_data.attributes.other.into_iter();
    texts
        .filter_map(|(name, value)| match value {
            AttributeValue::Text(text) => Some((name.to_string(), text.to_string())),
            _ => None,
        })
        .collect()
}

/// What is the same in two films of the same samples: all pixels, the header but for what a render
/// that goes on says otherwise, and the length of the file without that.
#[derive(PartialEq)]
struct Comparable {
    channels: BTreeMap<String, Vec<u32>>,
    attributes: BTreeMap<String, String>,
    length: usize,
}

/// The time that was spent; a bound, which a render that goes on has at fixed counts alone; and the
/// checksum, which covers both.
const OWN: [&str; 3] = ["candor.seconds", "candor.errorBound", "candor.headerChecksum"];

impl Comparable {
    fn read(path: &Path) -> Self {
        let mut attributes = attributes(path);
        let own = OWN.iter().filter_map(|&name| Some((name, attributes.remove(name)?)));
        // Name, type, the length in four bytes, and the text.
        let bytes = own.map(|(name, text)| name.len() + 1 + "string".len() + 1 + 4 + text.len());
        let length = fs::read(path).expect("the film is there").len() - bytes.sum::<usize>();
        Self { channels: channels(path), attributes, length }
    }
}

/// Whether two films hold the same, to the bit.
pub fn are_same(ours: &Path, theirs: &Path) -> bool {
    let [ours, theirs] = [ours, theirs].map(Comparable::read);
    ours.channels.contains_key("sum.L2.3") && ours == theirs
}

/// Asserts that two films in a folder hold the same, to the bit.
#[track_caller]
pub fn assert_same(folder: &Folder, ours: &str, theirs: &str) {
    let [a, b] = [ours, theirs].map(|name| folder.path(name));
    let [left, right] = [&a, &b].map(|path| attributes(path));
    assert!(are_same(&a, &b), "{ours} and {theirs} differ; their headers: {left:?} {right:?}");
}

/// Writes the film in a file anew, changed, without compression as a checkpoint is or with it.
pub fn rewrite(path: &Path, quick: bool, change: impl FnOnce(&mut candor::film::Film)) {
    let stored = StoredFilm::open(path).expect("a film");
    let mut film = stored.read().expect("a whole film");
    change(&mut film);
    let picture = Picture::develop(&film, false);
    let sums = if quick { Sums::Quick(&film) } else { Sums::Compact(&film) };
    write_exr(path, &picture, sums, &stored.provenance).expect("it can be written");
}

/// Changes the value of a header's text, as a program would that keeps the header's checksum.
pub fn patch(path: &Path, name: &str, from: &str, to: &str) {
    let mut image = read_first_flat_layer_from_file(path).expect("a film");
    let texts = &mut image.layer_data.attributes.other;
    let value = |text: &str| AttributeValue::Text(Text::from(text));
    let before = texts.insert(Text::from(format!("candor.{name}").as_str()), value(to));
    assert_eq!(before, Some(value(from)), "candor.{name}");
    let checksum = Text::from("candor.headerChecksum");
    texts.remove(&checksum);
    let lines = texts.iter().filter_map(|(name, value)| match value {
        AttributeValue::Text(text) => Some(format!("{name}={text}\n")),
        _ => None,
    });
    let mut lines: Vec<_> = lines.filter(|line| line.starts_with("candor.")).collect();
    lines.sort_unstable();
    let found = crc32fast::hash(lines.concat().as_bytes()).to_string();
    texts.insert(checksum, value(&found));
    image.write().to_file(path).expect("it can be written");
}
