//! Renders that are killed again and again, on disks that fill up, over films that tear: no sample
//! is lost that was in a film, and none counts twice.

use crate::candor::{Folder, Running, with_files_up_to};
use crate::film::{assert_same, attributes};
use crate::signals::signal;
use std::fs;
use std::thread::sleep;
use std::time::Duration;

/// How a run is brought to its end.
enum Fault {
    /// SIGKILL so many milliseconds after it started.
    Killed(u64),
    /// SIGKILL as soon as it has written a checkpoint.
    KilledAfterCheckpoint,
    /// SIGKILL as soon as a checkpoint is on its way.
    KilledWhileWriting,
    /// SIGKILL after a checkpoint did not fit onto the disk.
    KilledOnFullDisk,
    /// The film was cut in half, which is refused; then the copy from before takes its place.
    Torn,
}

/// Ten kills, and a torn film. Results do not depend on when: where a run was killed before its
/// first checkpoint, the film is the one before.
const FAULTS: [Fault; 11] = [
    Fault::KilledAfterCheckpoint,
    Fault::Killed(0),
    Fault::Killed(61),
    Fault::KilledWhileWriting,
    Fault::Torn,
    Fault::KilledOnFullDisk,
    Fault::Killed(437),
    Fault::KilledWhileWriting,
    Fault::KilledAfterCheckpoint,
    Fault::Killed(183),
    Fault::Killed(9),
];

/// A render that would never end, with checkpoints as often as possible.
struct Victim {
    folder: Folder,
    render: String,
}

impl Victim {
    fn new(device: &str) -> Self {
        let render = format!("render scene.toml --device {device} --size 64x48 -o scene.exr");
        Self { folder: Folder::new(), render }
    }

    fn suffer(&self, fault: &Fault) {
        let endless = format!("{} --resume --spp 4294967296 --checkpoint-every 1ms", self.render);
        let mut command = self.folder.command(&endless);
        let path = self.folder.path("scene.exr");
        let modified = || fs::metadata(&path).and_then(|file| file.modified()).ok();
        match fault {
            Fault::Torn => return self.tear(&endless),
            Fault::KilledOnFullDisk => command = with_files_up_to(8, &command),
            _ => {}
        }
        let before = modified();
        let mut running = Running::start(&mut command);
        match fault {
            Fault::Killed(after) => sleep(Duration::from_millis(*after)),
            Fault::KilledAfterCheckpoint => {
                running.wait_until("a checkpoint", || modified() != before);
            }
            Fault::KilledWhileWriting => running.wait_until("a temporary file", || {
                self.folder.files().iter().any(|name| name.starts_with(".candor-"))
            }),
            Fault::KilledOnFullDisk => running.wait_for("warning: no checkpoint, "),
            Fault::Torn => {}
        }
        signal(&running, "KILL");
        assert_eq!(running.end().code, None, "it was killed");
    }

    fn tear(&self, resume: &str) {
        let path = self.folder.path("scene.exr");
        let whole = self.folder.read("scene.exr");
        let torn = &whole[..whole.len() / 2];
        fs::write(&path, torn).expect("written");
        self.folder.candor(resume).refused(&["scene.exr: is torn: "]);
        assert!(self.folder.read("scene.exr") == torn, "a torn film is somebody's, too");
        fs::write(&path, whole).expect("written");
    }

    fn samples(&self) -> u64 {
        match self.folder.path("scene.exr") {
            path if path.exists() => attributes(&path)["candor.spp"].parse().expect("a count"),
            _ => 0,
        }
    }
}

fn survives(device: &str) {
    let victim = Victim::new(device);
    let mut there = 0;
    for (number, fault) in FAULTS.iter().enumerate() {
        victim.suffer(fault);
        let now = victim.samples();
        assert!(now >= there, "fault {number} has lost samples: {now} of {there}");
        there = now;
    }
    let (folder, spp) = (&victim.folder, there + 3);
    let ended = folder.candor(&format!("{} --resume --quiet --spp {spp}", victim.render));
    ended.silently_done();
    let whole = victim.render.replace("scene.exr", "whole.exr");
    folder.candor(&format!("{whole} --quiet --spp {spp}")).silently_done();
    assert_same(folder, "scene.exr", "whole.exr");
    // Nothing that the killed runs left is there any more.
    assert_eq!(folder.files(), ["scene.exr", "whole.exr"]);
}

#[test]
fn a_render_on_the_device_survives() {
    survives("gpu");
}

#[test]
fn a_render_on_the_twin_survives() {
    survives("cpu");
}
