//! Films that are kept: those of other samples, and those of pictures that cannot be gone on from.

use crate::candor::Folder;

/// As many samples, but others: nothing of what was paid for is lost by mistake.
#[test]
fn a_film_of_other_samples_is_replaced_only_by_force() {
    let folder = Folder::new();
    let render = "render scene.toml --device cpu --quiet -o a.exr";
    folder.candor(&format!("{render} --samples 0..4")).silently_done();
    let first = folder.read("a.exr");
    for samples in ["4..8", "2..7"] {
        let parts = ["a.exr holds samples 0..4 of the same picture; --resume"];
        folder.candor(&format!("{render} --samples {samples}")).refused(&parts);
        assert_eq!(folder.read("a.exr"), first);
    }
    // All of them and more, and another picture.
    folder.candor(&format!("{render} --samples 0..6")).silently_done();
    folder.candor(&format!("{render} --samples 4..9 --force")).silently_done();
    folder.candor(&format!("{render} --samples 0..5 --seed 9")).silently_done();
}

/// A PNG cannot be gone on from: its film is kept beside it, unless the state is not wanted.
#[test]
fn a_png_alone_keeps_its_film() {
    let folder = Folder::new();
    let render = "render scene.toml --device cpu --quiet -o a.png";
    folder.candor(&format!("{render} --no-state")).silently_done();
    assert_eq!(folder.files(), ["a.png"]);
    let results = folder.candor(render).silently_done();
    assert!(results.starts_with("wrote scene.exr\nwrote a.png\n"), "{results}");
    assert_eq!(folder.files(), ["a.png", "scene.exr"]);
    let results = folder.candor(&format!("{render} --resume --spp 9")).silently_done();
    assert!(results.contains(", 9 spp, "), "{results}");
}
