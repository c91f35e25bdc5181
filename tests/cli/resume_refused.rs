//! What `render --resume` refuses, and why; the film that is there stays as it is.

use crate::candor::{Folder, SCENE};
use crate::film::{attributes, patch, rewrite};
use exr::prelude::{SpecificChannels, WritableImage};
use std::fs;

const RENDER: &str = "render scene.toml --device cpu --quiet";
const RESUME: &str = "render scene.toml --device cpu --quiet --resume --spp 4294967296";

/// A folder with a film of 4 samples.
fn begun() -> Folder {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} -o scene.exr")).silently_done();
    folder
}

/// Refused for the film in `scene.exr`, which stays. So many samples are asked for that the test
/// would hang if they were traced first.
#[track_caller]
fn refused(folder: &Folder, arguments: &str, parts: &[&str]) {
    let (film, files) = (folder.read("scene.exr"), folder.files());
    folder.candor(&format!("{RESUME} {arguments} -o scene.exr")).refused(parts);
    assert!(folder.read("scene.exr") == film, "{arguments} changed the film");
    assert_eq!(folder.files(), files);
}

#[test]
fn another_picture_is_refused_by_field_and_both_values() {
    for (arguments, difference) in [
        ("--seed 5", "the seed differs: 5 in this render, 0 in the film"),
        ("--estimator mis", "the estimator differs: mis in this render, implicit in the film"),
        ("--bounces 3", "the number of bounces differs: 3 in this render, 2 in the film"),
        ("--size 6x8", "the size differs: 6x8 in this render, 8x6 in the film"),
        // What is laid down first is told first.
        ("--seed 5 --size 6x8", "the size differs: 6x8 in this render, 8x6 in the film"),
    ] {
        refused(&begun(), arguments, &["scene.exr: cannot be resumed: ", difference, "-o names"]);
    }
}

#[test]
fn another_scene_is_refused_by_both_hashes() {
    let folder = begun();
    let theirs = attributes(&folder.path("scene.exr"))["candor.sceneHash"].clone();
    folder.write("scene.toml", &SCENE.replace("radius = 1.5", "radius = 1.5001"));
    folder.candor(&format!("{RENDER} -o other.exr")).silently_done();
    let ours = attributes(&folder.path("other.exr"))["candor.sceneHash"].clone();
    let difference = format!(
        "the scene differs: {}… in this render, {}… in the film",
        &ours[..16],
        &theirs[..16]
    );
    refused(&folder, "", &[&difference]);
    // Other words for the same scene are the same scene.
    folder.write("scene.toml", &format!("# A comment.\n{SCENE}"));
    folder.candor(&format!("{RENDER} --resume -o scene.exr")).silently_done();
}

#[test]
fn another_version_of_the_numbers_is_refused() {
    let folder = begun();
    let ours = candor::film::NUMBERS.to_string();
    let theirs = if ours == "9" { "8" } else { "9" };
    patch(&folder.path("scene.exr"), "numbers", &ours, theirs);
    let difference = format!("numbers differs: {ours} in this render, {theirs} in the film");
    refused(&folder, "", &["cannot be resumed: the version of the ", &difference]);
}

/// A header that contradicts itself is told by the attribute.
#[test]
fn a_header_that_cannot_be_is_refused() {
    for (name, from, to, part) in [
        ("samples", "0..4", "4..0", "candor.samples in its header is \"4..0\""),
        ("seed", "0", "x", "candor.seed in its header is \"x\""),
        ("estimator", "implicit", "explicut", "candor.estimator in its header is \"explicut\""),
        ("invalidSamples", "0", "-", "candor.invalidSamples in its header is \"-\""),
    ] {
        let folder = begun();
        patch(&folder.path("scene.exr"), name, from, to);
        refused(&folder, "", &["scene.exr: ", part]);
    }
}

#[test]
fn what_holds_no_sums_is_refused() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} --no-state -o scene.exr")).silently_done();
    refused(&folder, "", &["scene.exr: holds no exact sums", "--no-state"]);
}

#[test]
fn what_candor_did_not_write_is_refused() {
    let folder = Folder::new();
    folder.write("scene.exr", "a text");
    refused(&folder, "", &["scene.exr: was not written by candor", "-o names another file"]);
    refused(&folder, "--force", &["scene.exr: is not a readable EXR: "]);
    let grey = SpecificChannels::rgb(|_| (0.5_f32, 0.5_f32, 0.5_f32));
    let foreign = exr::prelude::Image::from_channels((8, 6), grey);
    foreign.write().to_file(folder.path("scene.exr")).expect("written");
    refused(&folder, "", &["scene.exr: was not written by candor", "-o names another file"]);
    refused(&folder, "--force", &["scene.exr: is no film of this program"]);
}

/// Wherever a film was cut, final or a checkpoint: in its header, in its table, in its pixels.
#[test]
fn a_film_that_is_cut_is_refused() {
    for quick in [false, true] {
        let folder = begun();
        let path = folder.path("scene.exr");
        if quick {
            rewrite(&path, true, |_| ());
        }
        let whole = folder.read("scene.exr");
        let last = [whole.len() - 1];
        for length in (1..whole.len()).step_by(whole.len() / 20).chain(last) {
            fs::write(&path, &whole[..length]).expect("written");
            refused(&folder, "", &["scene.exr: "]);
        }
        fs::write(&path, &whole).expect("written");
        folder.candor(&format!("{RENDER} --resume --spp 5 -o scene.exr")).silently_done();
    }
}

/// Nothing but the checksum tells that one bit of a sum in a checkpoint is another.
#[test]
fn a_bit_that_fell_over_is_refused() {
    let folder = begun();
    let path = folder.path("scene.exr");
    rewrite(&path, true, |_| ());
    let whole = folder.read("scene.exr");
    let words = 4 * candor::film::WORDS * 8;
    // The last row ends with its sums, those of a word of all pixels after another.
    for place in (whole.len() - words..whole.len()).step_by(13) {
        let mut bytes = whole.clone();
        bytes[place] ^= 1 << (place % 8);
        fs::write(&path, &bytes).expect("written");
        refused(&folder, "", &["scene.exr: is torn: its sums have the checksum "]);
    }
}

/// Nothing but its checksum tells that the header speaks of other samples.
#[test]
fn a_header_that_was_changed_is_refused() {
    let folder = begun();
    let mut bytes = folder.read("scene.exr");
    let at = bytes.windows(4).position(|window| window == b"0..4").expect("candor.samples");
    bytes[at + 3] = b'5';
    fs::write(folder.path("scene.exr"), bytes).expect("written");
    refused(&folder, "", &["scene.exr: is torn: its header does not have the checksum "]);
}

#[test]
fn resuming_needs_the_state() {
    let folder = begun();
    for arguments in ["--resume --no-state", "--no-state --checkpoint-every 5s"] {
        folder.candor(&format!("{RENDER} {arguments}")).refused(&["cannot be used with"]);
    }
}
