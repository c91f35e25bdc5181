//! What must hold for any bytes that are read as a scene, as its data or as a picture. The fuzzers of
//! `fuzz/` call this for whatever they make up, and `corpus.rs` for what they have kept.

#![allow(dead_code, reason = "each fuzzer uses one half of it")]

use candor::cpu::{PreparedScene, SampleKey, trace};
use candor::effects::Effects;
use candor::kernel::{Kernel, pack, validate};
use candor::report::{PictureHeader, StoredFilm};
use candor::scene::{Estimator, ImageSize, Scene, SceneFileError, load, parse};
use candor::viewpoint::Viewpoint;
use candor::{bound, estimate};
use std::path::{Path, PathBuf};

/// Composing kernels takes ten times as long as reading a small scene, validating one a
/// thousand times, and so may tracing it. One scene in so many goes there, chosen by its hash.
const COMPOSED_ONE_IN: u8 = 4;
const TRACED_ONE_IN: u8 = 128;

/// Longest message: 20 mistakes, each with a line that is cut and notes that are cut.
const LONGEST_MESSAGE: usize = 64 * 1024;

/// A file that a fuzzer may overwrite.
pub fn scratch(ending: &str) -> PathBuf {
    std::env::temp_dir().join(format!("candor-fuzz-{}.{ending}", std::process::id()))
}

/// The characters of a message must be ones that do nothing to a terminal.
fn is_harmless(message: &str) -> bool {
    message.chars().all(|c| c == '\n' || !c.is_control())
}

/// Reads `bytes` as a scene file; `scratch` is a file that may be overwritten. Returns
/// whether they are a scene.
///
/// # Panics
/// If anything that must hold does not.
pub fn check_scene(bytes: &[u8], scratch: &Path) -> bool {
    let read = if let Ok(text) = std::str::from_utf8(bytes) {
        parse("scene.toml", text)
    } else {
        std::fs::write(scratch, bytes).expect("the scratch file can be written");
        load(scratch)
    };
    match read {
        Ok(scene) => check_accepted(&scene),
        Err(error) => check_refused(&error),
    }
}

/// What a scene may say about a data file: as little as it can, and something of everything.
const CLOUDS: [&str; 2] =
    ["", "radius = 0.5, material = \"m\", scale = 1e-9, offset = [1, -2, 1e15]"];

/// Reads `bytes` as a data file of each format; `scratch` with other endings names files that
/// may be overwritten. Returns whether a scene accepts them.
///
/// # Panics
/// If anything that must hold does not.
pub fn check_data(bytes: &[u8], scratch: &Path) -> bool {
    let mut accepted = false;
    for ending in ["csv", "xyz"] {
        let data = scratch.with_extension(ending);
        std::fs::write(&data, bytes).expect("the scratch file can be written");
        let name = data.file_name().expect("a file").to_string_lossy();
        for cloud in CLOUDS {
            let text = format!(
                "camera = {{ position = [0, 0, 9], look_at = [0, 0, 0], vertical_fov = 50 }}
image = {{ width = 4, height = 3 }}
materials.m = {{ glossy = [0.9, 0.9, 0.9], exponent = 7 }}
clouds = [{{ file = \"{name}\", {cloud} }}]"
            );
            let scene = scratch.with_extension("toml");
            std::fs::write(&scene, text).expect("the scratch file can be written");
            accepted |= match load(&scene) {
                Ok(scene) => check_accepted(&scene),
                Err(error) => check_refused(&error),
            };
        }
    }
    accepted
}

fn check_refused(error: &SceneFileError) -> bool {
    let message = error.render(false);
    assert!(message.starts_with("error: "), "{message}");
    assert!(message.len() < LONGEST_MESSAGE, "{} bytes", message.len());
    assert!(is_harmless(&message), "{message:?}");
    if message.len().is_multiple_of(8) {
        assert!(error.render(true).len() > message.len(), "no colour: {message}");
    }
    let SceneFileError::Invalid { text, diagnostics, .. } = error else { return false };
    assert!(!diagnostics.is_empty(), "refused without a reason");
    for diagnostic in diagnostics {
        let span = diagnostic.span();
        assert!(text.get(span.clone()).is_some(), "{span:?} of {diagnostic:?}");
    }
    false
}

/// What is done with a scene before a device sees it.
fn check_accepted(scene: &Scene) -> bool {
    let hash = scene.hash();
    let viewpoint = Viewpoint::of(scene);
    assert!(viewpoint.focus().is_finite(), "{viewpoint:?}");
    assert!(viewpoint.extent() > 0.0 && viewpoint.extent().is_finite(), "{viewpoint:?}");
    let chosen = |one_in: u8| hash.as_bytes()[0].is_multiple_of(one_in);
    if !chosen(COMPOSED_ONE_IN) {
        return true;
    }
    for estimator in Estimator::ALL {
        let settings = scene.settings().with_estimator(estimator);
        let scene = scene.clone().with_settings(settings);
        assert_eq!(scene.hash(), hash, "the hash depends on the estimator");
        if bound::check(&scene).is_err() {
            continue;
        }
        let scale = bound::sample_scale(&scene);
        let effects = Effects::of(&scene, &viewpoint);
        let packed = pack(&scene, &viewpoint, effects, scale);
        let kernel = Kernel::of(&scene, effects, &packed).wgsl();
        if chosen(TRACED_ONE_IN) {
            if let Err(error) = validate(&kernel) {
                panic!("{error}");
            }
            check_samples(scene);
        }
    }
    true
}

/// A few samples of the twin are valid ones.
fn check_samples(scene: Scene) {
    let scale = bound::sample_scale(&scene);
    let scene = scene.with_size(ImageSize::new(4, 2).expect("a size"));
    let prepared = PreparedScene::new(&scene);
    for pixel in 0..8 {
        let radiance = trace(&prepared, SampleKey { pixel, index: 0 }).as_vec3().to_array();
        let is_black = radiance.iter().all(|&x| x == 0.0);
        assert!(is_black || scale.admits(radiance), "{radiance:?} in pixel {pixel}");
    }
}

/// Reads the file as a film, if it is one: what comes back are the sums that its checksum is of.
fn check_film(path: &Path) {
    let read = StoredFilm::open(path).and_then(|stored| Ok((stored.read()?, stored.provenance)));
    match read {
        Ok((film, provenance)) => {
            let identity = provenance.origin.identity;
            film.check_fits(identity.size, identity.scale).expect("the header's");
            assert_eq!(*film.samples(), provenance.samples);
        }
        Err(error) => {
            refused(&error.to_string());
        }
    }
}

/// Pictures of more pixels are not read: the program asks for memory first.
const MOST_PIXELS: u32 = 1 << 14;

/// Reads `bytes` as an EXR file, by way of `scratch`. Returns whether they are a picture.
///
/// # Panics
/// If anything that must hold does not.
pub fn check_picture(bytes: &[u8], scratch: &Path) -> bool {
    std::fs::write(scratch, bytes).expect("the scratch file can be written");
    let header = match PictureHeader::read(scratch) {
        Ok(header) if header.size.pixels() <= MOST_PIXELS => header,
        Ok(_) => return false,
        Err(error) => return refused(&error.to_string()),
    };
    check_film(scratch);
    let size = header.size;
    let picture = match header.read_pixels() {
        Ok(picture) => picture,
        Err(error) => return refused(&error.to_string()),
    };
    assert_eq!(picture.rgb.len(), size.pixels() as usize);
    assert!(picture.rgb.iter().flatten().all(|x| x.is_finite()), "a pixel is not finite");
    let measured = picture.measured();
    let difference = estimate::difference(&measured, &measured);
    assert_eq!(difference.rmse.to_bits(), 0, "{difference:?}");
    if measured.bars.is_some() {
        let found = estimate::compare_pictures(&measured, &measured);
        assert_eq!(found.image.z.to_bits(), 0, "{found:?}");
        assert!((0.0..=1.0).contains(&found.p()), "{found:?}");
    }
    let map = estimate::difference_map(&measured, &measured);
    assert_eq!(map.size, size);
    true
}

fn refused(message: &str) -> bool {
    assert!(message.len() < LONGEST_MESSAGE, "{} bytes", message.len());
    assert!(is_harmless(message), "{message:?}");
    false
}
