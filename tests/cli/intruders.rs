//! What comes into the way while a render is under way, and what outputs may be: links, pipes, files
//! that are closed to others.

use crate::candor::{Folder, Running};
use crate::film::{are_same, attributes};
use crate::signals::signal;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::process::Command;

const RENDER: &str = "render scene.toml --device cpu --quiet";
const ENDLESS: &str =
    "render scene.toml --device cpu --spp 4294967296 --checkpoint-every 1ms -o a.exr";

/// An endless render that has written a checkpoint.
fn under_way(folder: &Folder) -> Running {
    let running = Running::start(&mut folder.command(ENDLESS));
    running_until(folder, running, "a.exr")
}

fn running_until(folder: &Folder, mut running: Running, name: &str) -> Running {
    running.wait_until(name, || folder.path(name).exists());
    running
}

/// Another film comes to the place of the checkpoints, with as many samples or fewer, of this
/// picture or another: it stays, and checkpoints and film go beside it.
#[test]
fn a_film_that_comes_meanwhile_stays() {
    for other in ["--seed 7 --spp 2", "--samples 4294967296..4294967299"] {
        let folder = Folder::new();
        folder.candor(&format!("{RENDER} {other} -o other.exr")).silently_done();
        let film = folder.read("other.exr");
        let running = under_way(&folder);
        fs::rename(folder.path("other.exr"), folder.path("a.exr")).expect("renamed");
        let running = running_until(&folder, running, "a.1.exr");
        signal(&running, "INT");
        let ended = running.end().with_code(130);
        assert!(ended.stdout.starts_with("wrote a.1.exr\n"), "{}", ended.stdout);
        let said = "a.exr holds another film: checkpoints go to a.1.exr";
        assert!(ended.stderr.contains(said), "{}", ended.stderr);
        assert!(folder.read("a.exr") == film, "{other}");
        assert_eq!(folder.files(), ["a.1.exr", "a.exr"]);
    }
}

#[test]
fn a_file_that_comes_meanwhile_stays() {
    let folder = Folder::new();
    let running = under_way(&folder);
    folder.write("text", "somebody's");
    fs::rename(folder.path("text"), folder.path("a.exr")).expect("renamed");
    let running = running_until(&folder, running, "a.1.exr");
    signal(&running, "INT");
    running.end().with_code(130);
    assert_eq!(folder.read("a.exr"), b"somebody's");
}

/// What cannot be looked at may be anything: a link in a circle.
#[test]
fn what_cannot_be_looked_at_costs_no_film() {
    let folder = Folder::new();
    let mut running = under_way(&folder);
    symlink("a.exr", folder.path("circle.exr")).expect("a link");
    fs::rename(folder.path("circle.exr"), folder.path("a.exr")).expect("renamed");
    running.wait_for("warning: no checkpoint, the one before stays: a.exr: ");
    signal(&running, "INT");
    let ended = running.end().with_code(130);
    assert!(ended.stdout.starts_with("wrote a.1.exr\n"), "{}", ended.stdout);
}

/// The film of this render that is beside the one in the way is named.
#[test]
fn a_checkpoint_that_was_left_beside_is_named() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} --seed 7 -o a.exr")).silently_done();
    let running = running_until(&folder, Running::start(&mut folder.command(ENDLESS)), "a.1.exr");
    signal(&running, "KILL");
    running.end();
    let part = "it stays as it is, and -o a.1.exr goes on from another film, of this render";
    folder.candor(&format!("{ENDLESS} --resume")).refused(&["the seed differs", part]);
}

#[test]
fn sums_are_not_left_out_by_mistake() {
    let folder = Folder::new();
    folder.candor(&format!("{RENDER} -o a.exr")).silently_done();
    let part = "a.exr holds the exact sums, which --no-state leaves out; --resume";
    folder.candor(&format!("{RENDER} -o a.exr --no-state")).refused(&[part]);
    folder.candor("merge a.exr --no-state -o a.exr").refused(&["a.exr holds the exact sums"]);
    folder.candor(&format!("{RENDER} -o a.exr --no-state --force")).silently_done();
    // What has none loses none.
    folder.candor(&format!("{RENDER} -o a.exr --no-state")).silently_done();
}

/// A link stays one, to a file that is there or not; what it leads to is written and gone on from.
#[test]
fn a_link_is_followed() {
    let folder = Folder::new();
    fs::create_dir(folder.path("far")).expect("a folder");
    symlink("far/film.exr", folder.path("near.exr")).expect("a link");
    symlink("near.exr", folder.path("a.exr")).expect("a link");
    folder.candor(&format!("{RENDER} -o a.exr")).silently_done();
    folder.candor(&format!("{RENDER} -o a.exr --resume --spp 9")).silently_done();
    folder.candor(&format!("{RENDER} -o whole.exr --spp 9")).silently_done();
    assert!(are_same(&folder.path("far/film.exr"), &folder.path("whole.exr")));
    for link in ["near.exr", "a.exr"] {
        assert!(folder.path(link).is_symlink(), "{link}");
    }
}

/// New files are as open to others as the mask allows, and keep what they were.
#[test]
fn permissions_are_the_users() {
    let folder = Folder::new();
    let mode = |name: &str| {
        let there = fs::metadata(folder.path(name)).expect("it is there");
        there.permissions().mode() & 0o777
    };
    for (mask, expected) in [("077", 0o600), ("002", 0o664), ("022", 0o644)] {
        let render = folder.command(&format!("{RENDER} -o {mask}.exr -o {mask}.png"));
        let mut shell = Command::new("sh");
        shell.args(["-c", &format!("umask {mask}; exec \"$@\""), "sh"]).arg(render.get_program());
        shell.args(render.get_args()).current_dir(folder.path(""));
        Running::start(&mut shell).end().silently_done();
        for ending in ["exr", "png"] {
            assert_eq!(mode(&format!("{mask}.{ending}")), expected, "{mask} {ending}");
        }
    }
    fs::set_permissions(folder.path("022.exr"), PermissionsExt::from_mode(0o640)).expect("ours");
    folder.candor(&format!("{RENDER} -o 022.exr --resume --spp 9")).silently_done();
    assert_eq!(mode("022.exr"), 0o640);
}

/// A pipe would be waited for, for ever.
#[test]
fn a_pipe_is_no_film() {
    let folder = Folder::new();
    let made = Command::new("mkfifo").arg(folder.path("a.exr")).status();
    assert!(made.expect("mkfifo runs").success());
    folder.candor(&format!("{RENDER} -o a.exr")).refused(&["a.exr: is no regular file"]);
    folder.candor("merge a.exr -o b.exr").refused(&["a.exr: is no regular file"]);
}

/// What a process is started to ignore it ignores: `nohup` outlives the terminal.
#[cfg(target_os = "linux")]
#[test]
fn an_ignored_signal_stays_ignored() {
    let folder = Folder::new();
    let render = folder.command(ENDLESS);
    let mut shell = Command::new("sh");
    shell.args(["-c", "trap '' HUP; exec \"$@\"", "sh"]).arg(render.get_program());
    shell.args(render.get_args()).current_dir(folder.path(""));
    let running = running_until(&folder, Running::start(&mut shell), "a.exr");
    signal(&running, "HUP");
    let samples = || attributes(&folder.path("a.exr"))["candor.samples"].clone();
    let before = samples();
    let mut running = running;
    running.wait_until("a later checkpoint", || samples() != before);
    signal(&running, "INT");
    running.end().with_code(130);
}
