//! `render --resume`: a film that is gone on from is the film of one run.

use crate::candor::{Folder, dark_scene};
use crate::film::{assert_same, attributes, channels};

const RENDER: &str = "render scene.toml --device cpu --quiet";

#[test]
fn a_resumed_film_is_that_of_one_run() {
    for device in ["gpu", "cpu"] {
        let folder = Folder::new();
        let render = format!("render scene.toml --quiet --device {device}");
        folder.candor(&format!("{render} -o whole.exr --spp 37")).silently_done();
        for spp in [5, 6, 21, 37] {
            folder.candor(&format!("{render} -o a.exr --resume --spp {spp}")).silently_done();
            assert_eq!(attributes(&folder.path("a.exr"))["candor.samples"], format!("0..{spp}"));
        }
        assert_same(&folder, "a.exr", "whole.exr");
    }
}

/// Where nothing is there yet, or no more than an empty file, the render starts.
#[test]
fn nothing_is_resumed_by_starting() {
    let folder = Folder::new();
    folder.write("empty.exr", "");
    folder.candor(&format!("{RENDER} -o whole.exr")).silently_done();
    for name in ["empty.exr", "new.exr"] {
        folder.candor(&format!("{RENDER} --resume -o {name}")).silently_done();
        assert_same(&folder, name, "whole.exr");
    }
}

#[test]
fn a_film_that_holds_all_is_done() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} --spp 12")).silently_done();
    let before = channels(&folder.path("scene.exr"));
    // As many, fewer, and the scene's four.
    for wanted in ["--spp 12", "--spp 7", "--samples 3..5", ""] {
        let results = folder.candor(&format!("{RENDER} --resume {wanted}")).silently_done();
        assert!(results.contains("\ndone: ") && results.contains(", 12 spp, "), "{results}");
        assert!(channels(&folder.path("scene.exr")) == before, "{wanted}");
    }
    assert_eq!(folder.files(), ["scene.exr", "scene.png"]);
}

/// A film of the samples 0..3 and 8..12.
fn with_gap(name: &str) -> Folder {
    let folder = Folder::new();
    for range in ["0..3", "8..12"] {
        folder.candor(&format!("{RENDER} -o {range}.exr --samples {range}")).silently_done();
    }
    folder.candor(&format!("merge --quiet 0..3.exr 8..12.exr -o {name}")).silently_done();
    folder
}

#[test]
fn gaps_are_filled() {
    for (wanted, samples, whole) in [
        ("--spp 16", "0..16", Some("--spp 16")),
        ("--samples 0..20", "0..20", Some("--spp 20")),
        ("--samples 10..14", "0..3,8..14", None),
        ("--samples 2..6", "0..6,8..12", None),
    ] {
        let folder = with_gap("a.exr");
        folder.candor(&format!("{RENDER} -o a.exr --resume {wanted}")).silently_done();
        assert_eq!(attributes(&folder.path("a.exr"))["candor.samples"], samples, "{wanted}");
        if let Some(whole) = whole {
            folder.candor(&format!("{RENDER} -o whole.exr {whole}")).silently_done();
            assert_same(&folder, "a.exr", "whole.exr");
        }
    }
}

/// Where the error that is aimed at ends the render, what was traced last is after the end, and
/// nothing is left of the gap.
#[test]
fn gaps_are_filled_first() {
    let folder = with_gap("a.exr");
    let arguments = format!("{RENDER} -o a.exr --resume --target-error 100% --json");
    let json = folder.candor(&arguments).with_code(0).json();
    assert_eq!(json["samples"], format!("0..{}", json["spp"]));
}

/// Several outputs: the first film is gone on from, and all are written.
#[test]
fn the_first_of_several_films_is_gone_on_from() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} -o whole.exr --spp 9")).silently_done();
    folder.candor(&format!("{RENDER} -o a.exr --spp 5")).silently_done();
    let outputs = "-o a.png -o a.exr -o b.exr";
    folder.candor(&format!("{RENDER} {outputs} --resume --spp 9")).silently_done();
    assert_same(&folder, "a.exr", "whole.exr");
    assert_same(&folder, "b.exr", "whole.exr");
    // The other way round, what is there would be lost.
    folder
        .candor(&format!("{RENDER} -o c.exr -o a.exr --resume --spp 5"))
        .refused(&["a.exr holds 9 samples per pixel, more than 5", "--force"]);
}

/// A longer time: what fits into it depends on the machine, the pixels do not.
#[test]
fn a_longer_time_goes_on() {
    let folder = Folder::new();
    let size = "--size 64x48";
    let render = |arguments: &str| {
        let arguments = format!("{RENDER} {size} --json {arguments}");
        folder.candor(&arguments).with_code(0).json()["spp"].as_u64().expect("a count")
    };
    let first = render("-o a.exr --time 1ms");
    // The same time is up already.
    assert_eq!(render("-o a.exr --resume --time 1ms"), first);
    let end = first + 3;
    assert_eq!(render(&format!("-o a.exr --resume --time 1h --spp {end}")), end);
    render(&format!("-o whole.exr --spp {end}"));
    assert_same(&folder, "a.exr", "whole.exr");
    let seconds = |name: &str| {
        let seconds = attributes(&folder.path(name))["candor.seconds"].clone();
        seconds.parse::<f64>().expect("a number")
    };
    assert!(seconds("a.exr") >= 0.001, "the first run's time counts");
}

/// The choice was made when the film was begun.
#[test]
fn an_estimator_left_to_candor_is_the_films() {
    for estimator in ["implicit", "cosine", "explicit", "mis"] {
        let folder = Folder::new();
        let render = |arguments: &str| {
            folder.candor(&format!("{RENDER} {arguments}")).silently_done();
        };
        render(&format!("-o whole.exr --spp 9 --estimator {estimator}"));
        render(&format!("-o a.exr --spp 5 --estimator {estimator}"));
        render("-o a.exr --spp 9 --estimator auto --resume");
        assert_same(&folder, "a.exr", "whole.exr");
    }
}

/// Black for want of light is proven by whatever is there.
#[test]
fn darkness_keeps_its_samples() {
    let folder = Folder::new();
    folder.write("dark.toml", dark_scene());
    for (wanted, samples) in
        [("--spp 100", "0..100"), ("--target-error 1%", "0..100"), ("--spp 120", "0..120")]
    {
        let arguments = format!("render dark.toml --quiet --json --resume {wanted}");
        let json = folder.candor(&arguments).with_code(0).json();
        assert_eq!(json["samples"], samples, "{wanted}");
        assert_eq!(json["outputs"], serde_json::json!(["dark.exr", "dark.png"]));
    }
}
