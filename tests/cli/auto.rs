//! `--estimator auto`: what it says, and that the picture is the one of the estimator it took.

use crate::candor::{Folder, SCENE, dark_scene};

#[test]
fn auto_gives_the_bits_of_the_estimator_that_it_takes() {
    let folder = Folder::new();
    let auto = folder
        .candor("render scene.toml --device cpu --estimator auto --json -o auto.png -o auto.exr")
        .with_code(0);
    for name in ["implicit", "cosine", "explicit", "mis"] {
        let line = auto.stderr.lines().find(|line| line.starts_with(name));
        assert!(line.is_some_and(|line| line.contains("to 1 %")), "{name}: {}", auto.stderr);
    }
    let json = auto.json();
    let taken = json["estimator"].as_str().expect("a name");
    assert!(auto.stderr.contains(&format!("taken: {taken}")), "{}", auto.stderr);
    let named = format!("render scene.toml --device cpu --quiet --estimator {taken}");
    folder.candor(&format!("{named} -o named.png -o named.exr")).silently_done();
    assert_eq!(folder.read("auto.png"), folder.read("named.png"));
    // No sample of the trials is in it.
    assert_eq!(json["spp"], 4);
}

/// What an estimator cannot do leaves it out; the others are tried.
#[test]
fn an_estimator_that_is_refused_is_left_out() {
    let folder = Folder::new();
    folder.write("bright.toml", &SCENE.replace("diffuse = [0.5,", "diffuse = [1.0,"));
    let auto = folder
        .candor("render bright.toml --device cpu --estimator auto --bounces 64 -o bright.png")
        .with_code(0);
    assert!(auto.stderr.contains("implicit: left out; 64 bounces"), "{}", auto.stderr);
    assert!(auto.stderr.contains("taken: "), "{}", auto.stderr);
}

#[test]
fn auto_is_for_renders_of_lit_scenes() {
    let folder = Folder::new();
    folder.candor("verify scene.toml --estimator auto").refused(&["auto is for render"]);
    folder.write("dark.toml", dark_scene());
    let dark = folder.candor("render dark.toml --estimator auto --quiet -o dark.png");
    assert!(dark.silently_done().contains("error 0.000 %"));
}
