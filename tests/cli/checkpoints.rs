//! Checkpoints: the film so far, whole at any moment, and nothing of it in the way afterwards.

use crate::candor::{Folder, Running, with_files_up_to};
use crate::film::{are_same, assert_same, attributes, channels, patch, rewrite};
use crate::signals::signal;
use candor::report::StoredFilm;
use std::collections::BTreeSet;
use std::fs::File;

const RENDER: &str = "render scene.toml --device cpu --quiet";
const ENDLESS: &str = "render scene.toml --device cpu --spp 4294967296 --checkpoint-every 1ms";

#[test]
fn checkpoints_change_nothing() {
    for device in ["gpu", "cpu"] {
        let folder = Folder::new();
        let render = format!("render scene.toml --device {device} --quiet --spp 3000");
        folder.candor(&format!("{render} -o whole.exr")).silently_done();
        folder.candor(&format!("{render} --checkpoint-every 1us")).silently_done();
        assert_same(&folder, "scene.exr", "whole.exr");
        assert_eq!(folder.files(), ["scene.exr", "scene.png", "whole.exr"]);
    }
}

/// Whenever the film is read while a render writes it again and again, it is whole, and holds
/// what its header says. An interrupted render ends with all that it traced.
#[test]
fn the_film_is_whole_at_any_moment() {
    let folder = Folder::new();
    let path = folder.path("scene.exr");
    let mut running = Running::start(&mut folder.command(&format!("{ENDLESS} --quiet")));
    running.wait_until("a checkpoint", || path.exists());
    let mut seen = BTreeSet::new();
    running.wait_until("twenty checkpoints", || {
        // Between the header and the sums another checkpoint may take its place; then the sums
        // are not those of the header, which is told.
        let stored = StoredFilm::open(&path).expect("a whole header");
        match stored.read() {
            Ok(_) => seen.insert(stored.provenance.samples.count()),
            Err(error) => {
                let now = StoredFilm::open(&path).expect("a whole header").provenance.samples;
                assert!(now != stored.provenance.samples, "torn: {error}");
                false
            }
        };
        seen.len() >= 20
    });
    signal(&running, "INT");
    running.end().with_code(130);
    let spp = attributes(&path)["candor.spp"].parse().expect("a count");
    assert!(seen.iter().all(|&earlier| earlier <= spp), "{spp} after {seen:?}");
    folder.candor(&format!("{RENDER} -o whole.exr --spp {spp}")).silently_done();
    // Not the header: no bound on the error is stated where a render was interrupted.
    assert!(channels(&path) == channels(&folder.path("whole.exr")));
}

/// A film that a render does not go on from stays until the new one is complete.
#[test]
fn checkpoints_go_beside_another_film() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} -o scene.exr")).silently_done();
    let old = folder.read("scene.exr");
    let mut running = Running::start(&mut folder.command(&format!("{ENDLESS} -o scene.exr")));
    running.wait_until("a checkpoint", || folder.path("scene.1.exr").exists());
    assert!(folder.read("scene.exr") == old);
    signal(&running, "INT");
    running.end().with_code(130);
    let spp = attributes(&folder.path("scene.exr"))["candor.spp"].clone();
    folder.candor(&format!("{RENDER} -o whole.exr --spp {spp}")).silently_done();
    let [ours, whole] = ["scene.exr", "whole.exr"].map(|name| channels(&folder.path(name)));
    assert!(ours == whole);
    assert_eq!(folder.files(), ["scene.exr", "whole.exr"]);
}

/// A killed render leaves both, and the checkpoint can be gone on from.
#[test]
fn a_checkpoint_beside_another_film_outlives_its_render() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} -o scene.exr")).silently_done();
    let old = folder.read("scene.exr");
    let mut running = Running::start(&mut folder.command(&format!("{ENDLESS} -o scene.exr")));
    running.wait_until("a checkpoint", || folder.path("scene.1.exr").exists());
    signal(&running, "KILL");
    assert_eq!(running.end().code, None);
    assert!(folder.read("scene.exr") == old);
    let there: u64 =
        attributes(&folder.path("scene.1.exr"))["candor.spp"].parse().expect("a count");
    let spp = there + 2;
    folder.candor(&format!("{RENDER} -o scene.1.exr --resume --spp {spp}")).silently_done();
    folder.candor(&format!("{RENDER} -o whole.exr --spp {spp}")).silently_done();
    assert_same(&folder, "scene.1.exr", "whole.exr");
}

/// The name beside the film is another render's by the time that this one ends: its film stays.
#[test]
fn only_its_own_checkpoint_is_taken_away() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} -o scene.exr")).silently_done();
    let endless = ENDLESS.replace("1ms", "1h");
    let mut running = Running::start(&mut folder.command(&format!("{endless} -o scene.exr")));
    running.wait_for(" spp, ");
    folder.candor(&format!("{RENDER} --seed 7 -o scene.1.exr")).silently_done();
    let other = folder.read("scene.1.exr");
    signal(&running, "INT");
    running.end().with_code(130);
    assert!(folder.read("scene.1.exr") == other);
}

/// The picture is large enough for the disk to fill up with a checkpoint, which is not compressed,
/// and small enough for the film that is kept.
#[test]
fn a_checkpoint_that_fails_is_a_warning() {
    let folder = Folder::new();
    let render = "render scene.toml --device cpu --size 96x64 --spp 64 -o";
    folder.candor(&format!("{render} whole.exr --quiet")).silently_done();
    let (kept, checkpoint) = (folder.read("whole.exr").len(), 96 * 64 * 68);
    assert!(kept + 1024 < checkpoint, "{kept} bytes");
    let blocks = u64::try_from(kept + 1024).expect("small") / 512;
    let command = folder.command(&format!("{render} scene.exr --checkpoint-every 1us"));
    let ended = Running::start(&mut with_files_up_to(blocks, &command)).end().with_code(0);
    for part in ["warning: no checkpoint, there is none", ": scene.exr: cannot be written: "] {
        assert!(ended.stderr.contains(part), "{}", ended.stderr);
    }
    assert_same(&folder, "scene.exr", "whole.exr");
    assert_eq!(folder.files(), ["scene.exr", "whole.exr"]);
}

/// The film that is gone on from stays while nothing can be written, to the end and after it.
#[test]
fn a_full_disk_costs_no_film() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} --size 96x64 -o scene.exr")).silently_done();
    let old = folder.read("scene.exr");
    let resume = "render scene.toml --device cpu --size 96x64 -o scene.exr --resume --spp 64";
    let command = folder.command(&format!("{resume} --checkpoint-every 1us"));
    let mut full = with_files_up_to(8, &command);
    // Where the film would be brought to safety is as full.
    full.env("TMPDIR", folder.path(""));
    let ended = Running::start(&mut full).end().with_code(2);
    assert!(ended.stderr.contains("warning: no checkpoint, "), "{}", ended.stderr);
    assert!(ended.stderr.contains("\nerror: scene.exr: cannot be written: "), "{}", ended.stderr);
    assert!(folder.read("scene.exr") == old);
    assert_eq!(folder.files(), ["scene.exr"]);
}

/// A killed render may leave a temporary file. The next one with the same output takes it away,
/// but not that of a process which still runs: that one holds a lock.
#[test]
fn what_killed_renders_left_is_taken_away() {
    let folder = Folder::new();
    let temporary = |folder: &Folder| {
        let mut names = folder.files();
        names.retain(|name| name.starts_with(".candor-"));
        names
    };
    let endless = format!("{ENDLESS} --quiet --size 512x512 -o scene.exr");
    for kill in 1.. {
        let mut running = Running::start(&mut folder.command(&endless));
        running.wait_until("a temporary file", || !temporary(&folder).is_empty());
        signal(&running, "KILL");
        running.end();
        if !temporary(&folder).is_empty() {
            break;
        }
        assert!(kill < 100, "a hundred kills have hit no checkpoint on its way");
    }
    let left = temporary(&folder);
    let held = File::open(folder.path(&left[0])).expect("it is there");
    held.lock().expect("nobody else holds it");
    let next = format!("{RENDER} -o scene.exr --force");
    folder.candor(&next).silently_done();
    assert_eq!(temporary(&folder), left);
    drop(held);
    folder.candor(&next).silently_done();
    assert_eq!(folder.files(), ["scene.exr"]);
}

/// The judge of all these tests tells films that differ in one sample, one bit of a sum, or one
/// text of the header.
#[test]
fn the_comparison_tells_films_apart() {
    let folder = Folder::new();
    let fresh = |name: &str, arguments: &str| {
        folder.candor(&format!("{RENDER} -o {name} {arguments}")).silently_done();
        folder.path(name)
    };
    let whole = fresh("whole.exr", "--spp 64");
    assert!(are_same(&whole, &fresh("same.exr", "--samples 0..64")));
    assert!(!are_same(&whole, &fresh("short.exr", "--spp 63")));
    assert!(!are_same(&whole, &fresh("shifted.exr", "--samples 1..65")));
    let flipped = fresh("flipped.exr", "--spp 64");
    rewrite(&flipped, false, |film| film.pixels_mut()[17][9] ^= 1);
    assert!(!are_same(&whole, &flipped));
    let renamed = fresh("renamed.exr", "--spp 64");
    patch(&renamed, "scene", "scene.toml", "other.toml");
    assert!(!are_same(&whole, &renamed));
}
