//! EXR files as other programs write them, and as accidents leave them.

use candor::cpu::rng::{SampleKey, random_bits};
use candor::film::{Film, Identity, NUMBERS, SampleScale};
use candor::report::{
    NextLook, Origin, Picture, PictureHeader, Provenance, Spent, StoredFilm, StoredPicture, Sums,
    write_exr,
};
use candor::scene::{Estimator, ImageSize};
use candor::tracer::{Description, InvalidReason, InvalidSample, Ledger};
use exr::prelude::{
    AnyChannel, AnyChannels, Blocks, Compression, Encoding, FlatSamples, Image, Layer,
    LayerAttributes, LineOrder, Vec2, WritableImage, f16,
};
use std::path::{Path, PathBuf};
use tempfile::TempDir;

const WIDTH: usize = 20;
const HEIGHT: usize = 18;

fn read(path: &Path) -> Result<StoredPicture, String> {
    let header = PictureHeader::read(path).map_err(|error| error.to_string())?;
    header.read_pixels().map_err(|error| error.to_string())
}

/// A picture whose values are exact in half floats, with one unproven pixel.
fn picture() -> Picture {
    let value = |i: usize| if i == 7 { 0.0 } else { [0.25, 0.5, 3.0, 17.0][i % 4] };
    let (width, height) = (20, 18);
    Picture {
        size: ImageSize::new(width, height).expect("a size"),
        rgb: (0..WIDTH * HEIGHT).map(|i| [value(i), value(i) / 2.0, value(i) / 4.0]).collect(),
        luminance_error: (0..WIDTH * HEIGHT)
            .map(|i| if i == 7 { f32::INFINITY } else { value(i) / 8.0 })
            .collect(),
    }
}

/// Samples 0..16 and 32..48 of a picture, and words that no sample has made.
fn film() -> Film {
    let mut film = Film::new(picture().size, SampleScale::from_bound(64.0));
    film.claim(0..16).expect("room for it");
    film.claim(32..48).expect("room for it");
    for (pixel, words) in (0..).zip(film.pixels_mut()) {
        let bits = |block| random_bits(SampleKey { pixel, index: 0 }, block, 0);
        let all = [bits(0), bits(1), bits(2), bits(3)].concat();
        *words = std::array::from_fn(|word| all[word]);
    }
    film
}

fn provenance() -> Provenance {
    let scene =
        candor::scene::load(&Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml"));
    let reasons = [InvalidReason::NotANumber, InvalidReason::Unfinished];
    let records = (7..).zip(reasons).map(|(pixel, reason)| InvalidSample {
        pixel,
        index: u64::from(pixel) << 50,
        reason,
    });
    let identity = Identity {
        numbers: NUMBERS,
        size: picture().size,
        scene: scene.expect("a scene").hash(),
        estimator: Estimator::Mis,
        bounces: 3,
        seed: u32::MAX,
        scale: film().scale(),
    };
    Provenance {
        origin: Origin {
            scene_file: "s.toml".to_owned(),
            identity,
            dark: false,
            tracer: Description { device: "D".into(), driver: "d".into(), software: true },
        },
        spent: Spent {
            ledger: Ledger { count: 9, records: records.collect() },
            seconds: 1.125,
            next_look: Some(NextLook { target: 0.1, samples: 608 }),
        },
        samples: film().samples().clone(),
        unproven_pixels: 1,
        coarse_pixels: 2,
        relative_error: Some(0.1),
        error_bound: None,
    }
}

/// A film as candor writes it.
fn ours(folder: &TempDir) -> PathBuf {
    written(folder, Sums::Compact(&film()))
}

fn written(folder: &TempDir, sums: Sums) -> PathBuf {
    let path = folder.path().join("ours.exr");
    write_exr(&path, &picture(), sums, &provenance()).expect("it can be written");
    path
}

fn read_film(path: &Path) -> Result<(Film, Provenance), String> {
    let stored = StoredFilm::open(path).map_err(|error| error.to_string())?;
    let film = stored.read().map_err(|error| error.to_string())?;
    Ok((film, stored.provenance))
}

/// The same picture as another program may write it.
fn theirs(
    path: &Path,
    names: &[&str],
    encoding: Encoding,
    sample: impl Fn(f32) -> f32,
    half: bool,
) {
    let channel = |(c, name): (usize, &&str)| {
        let values = picture().rgb.iter().map(|rgb| sample(rgb[c % 3])).collect::<Vec<_>>();
        let samples = if half {
            FlatSamples::F16(values.into_iter().map(f16::from_f32).collect())
        } else {
            FlatSamples::F32(values)
        };
        AnyChannel::new(*name, samples)
    };
    let channels = AnyChannels::sort(names.iter().enumerate().map(channel).collect());
    let layer = Layer::new(Vec2(WIDTH, HEIGHT), LayerAttributes::default(), encoding, channels);
    Image::from_layer(layer).write().to_file(path).expect("it can be written");
}

fn encodings() -> Vec<(&'static str, Encoding)> {
    let lines = |compression| Encoding {
        compression,
        blocks: Blocks::ScanLines,
        line_order: LineOrder::Increasing,
    };
    vec![
        ("uncompressed", lines(Compression::Uncompressed)),
        ("rle", lines(Compression::RLE)),
        ("zip1", lines(Compression::ZIP1)),
        ("zip16", lines(Compression::ZIP16)),
        ("piz", lines(Compression::PIZ)),
        ("tiles", Encoding { blocks: Blocks::Tiles(Vec2(8, 8)), ..lines(Compression::ZIP16) }),
    ]
}

#[test]
fn a_film_comes_back_as_it_was_written() {
    let folder = TempDir::new().expect("a folder");
    let found = read(&ours(&folder)).expect("it is a film");
    assert_eq!(
        (found.rgb, found.luminance_error.expect("bars")),
        (picture().rgb, picture().luminance_error)
    );
    let header = found.header;
    assert_eq!(header.size, picture().size);
    assert_eq!(header.samples.map(|samples| samples.to_string()).as_deref(), Some("0..16,32..48"));
    assert_eq!((header.seed, header.bounces.as_deref()), (Some(u32::MAX), Some("3")));
    assert_eq!((header.estimator.as_deref(), header.device.as_deref()), (Some("mis"), Some("D")));
    assert_eq!(header.scene_hash.map(|hash| hash.len()), Some(64));
    assert!(!header.half && !header.other_primaries);
}

/// Sums and provenance, compressed or not, to the bit.
#[test]
fn a_film_can_be_gone_on_from() {
    let folder = TempDir::new().expect("a folder");
    for sums in [Sums::Compact(&film()), Sums::Quick(&film())] {
        let (found, from) = read_film(&written(&folder, sums)).expect("a film");
        assert!(found == film(), "other sums");
        assert_eq!(from, provenance());
    }
    let error = read_film(&written(&folder, Sums::LeftOut)).expect_err("no sums");
    assert!(error.contains("--no-state"), "{error}");
}

/// One wrong byte anywhere makes a refusal or the same film, never another one: checksums cover
/// the sums and what the header says of them.
#[test]
fn corrupt_films_are_never_taken_for_others() {
    let folder = TempDir::new().expect("a folder");
    let mut refused = 0;
    for sums in [Sums::Compact(&film()), Sums::Quick(&film())] {
        let path = written(&folder, sums);
        let whole = std::fs::read(&path).expect("it is there");
        for place in (0..whole.len()).step_by(29) {
            let mut bytes = whole.clone();
            bytes[place] ^= [0x01, 0x80, 0xff][place % 3];
            std::fs::write(&path, &bytes).expect("written");
            match read_film(&path) {
                Ok((found, from)) => {
                    assert_eq!(found.pixels(), film().pixels(), "byte {place}");
                    assert_eq!(from, provenance(), "byte {place}");
                }
                Err(_) => refused += 1,
            }
        }
    }
    assert!(refused > 1000, "{refused} refused");
}

#[test]
fn other_programs_files_are_read() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("theirs.exr");
    for half in [false, true] {
        for (name, encoding) in encodings() {
            theirs(&path, &["R", "G", "B", "A", "albedo.R"], encoding, |x| x, half);
            let found = read(&path).unwrap_or_else(|error| panic!("{name}: {error}"));
            assert!(found.rgb == picture().rgb && found.luminance_error.is_none(), "{name}");
            assert_eq!((found.header.half, &found.header.samples), (half, &None), "{name}");
        }
    }
}

#[test]
fn what_is_no_picture_is_refused_with_the_reason() {
    let folder = TempDir::new().expect("a folder");
    let path = folder.path().join("theirs.exr");
    let plain = encodings()[0].1;
    theirs(&path, &["Y", "A", "Z"], plain, |x| x, false);
    let error = read(&path).expect_err("no colours");
    assert!(error.ends_with("has no channels R, G and B; it has: A, Y, Z"), "{error}");
    theirs(&path, &["R", "G", "B"], plain, |x| if x > 16.0 { f32::NAN } else { x }, false);
    let error = read(&path).expect_err("not finite");
    assert!(error.contains("pixel ") && error.contains(" is not finite: R NaN"), "{error}");
    theirs(&path, &["R", "G", "B", "stderr.L"], plain, |x| x, false);
    let error = read(&path).expect_err("bars of unknown samples");
    assert!(error.contains("has error bars (stderr.L), but"), "{error}");
    std::fs::write(&path, "no picture").expect("written");
    let error = read(&path).expect_err("a text");
    assert!(error.contains("is not a readable EXR"), "{error}");
    let error = read(folder.path()).expect_err("a folder");
    assert!(error.contains("is a folder"), "{error}");
    let error = read(&folder.path().join("none.exr")).expect_err("nothing there");
    assert!(error.contains("No such file"), "{error}");
}

/// A file that ends early is refused, wherever it ends.
#[test]
fn torn_files_are_refused() {
    let folder = TempDir::new().expect("a folder");
    let whole = std::fs::read(ours(&folder)).expect("it is there");
    let path = folder.path().join("torn.exr");
    for i in 0..50 {
        let length = whole.len() * i / 50;
        std::fs::write(&path, &whole[..length]).expect("written");
        assert!(read(&path).is_err(), "{length} of {} bytes", whole.len());
        assert!(read_film(&path).is_err(), "{length} of {} bytes", whole.len());
    }
}

/// Whatever one wrong byte does, it makes a picture or a refusal, not a panic: every 23rd
/// byte of each file. A header that claims another size is left alone, as the program first
/// asks whether there is memory for it.
#[test]
fn corrupt_files_do_no_harm() {
    let folder = TempDir::new().expect("a folder");
    let mut files = vec![std::fs::read(ours(&folder)).expect("it is there")];
    let path = folder.path().join("corrupt.exr");
    for (name, encoding) in encodings() {
        theirs(&path, &["R", "G", "B"], encoding, |x| x, name == "piz");
        files.push(std::fs::read(&path).expect("it is there"));
    }
    let (mut refused, mut read_in_full) = (0, 0);
    for (start, whole) in files.into_iter().enumerate() {
        for place in (start..whole.len()).step_by(23) {
            let mut bytes = whole.clone();
            bytes[place] ^= [0x01, 0x80, 0xff][place % 3];
            std::fs::write(&path, &bytes).expect("written");
            let Ok(header) = PictureHeader::read(&path) else { continue };
            if header.size == picture().size {
                let result = header.read_pixels();
                *(if result.is_ok() { &mut read_in_full } else { &mut refused }) += 1;
            }
        }
    }
    assert!(refused > 0 && read_in_full > 0, "{refused} refused, {read_in_full} read");
}
