//! The program, run in a folder: how long it took, and what of processor and memory.

use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// What a run took.
#[derive(Debug, Clone, Copy)]
pub struct Cost {
    pub wall: f64,
    /// Seconds of all cores together.
    pub processor: f64,
    /// Most memory at any moment, in bytes.
    pub memory: u64,
    /// How often the file that was watched was replaced.
    pub replaced: u32,
}

/// A folder with the classic scene in it.
pub struct Folder(tempfile::TempDir);

impl Folder {
    pub fn new() -> Self {
        let folder = tempfile::tempdir().expect("a temporary folder can be made");
        let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenes/two-spheres.toml");
        std::fs::copy(scene, folder.path().join("scene.toml")).expect("the scene can be copied");
        Self(folder)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    /// `prefix` before the program, such as what measures or limits it.
    fn command(&self, prefix: &[&str], arguments: &str) -> Command {
        let words = prefix.iter().copied().chain([env!("CARGO_BIN_EXE_candor")]);
        let mut words = words.chain(arguments.split_whitespace());
        let mut command = Command::new(words.next().expect("the program"));
        command.args(words).current_dir(self.0.path()).stdin(Stdio::null()).stdout(Stdio::null());
        command
    }

    /// Starts it; a limit of so many blocks of 512 bytes on files is a full disk.
    pub fn start(&self, arguments: &str, blocks: Option<u32>) -> Child {
        let limit = blocks.map(|n| format!("ulimit -f {n}; exec \"$@\""));
        let prefix = limit.iter().flat_map(|limit| ["sh", "-c", limit, "sh"]).collect::<Vec<_>>();
        let log = std::fs::File::create(self.path("stderr")).expect("a file can be made");
        self.command(&prefix, arguments).stderr(log).spawn().expect("the program starts")
    }

    pub fn said(&self) -> String {
        std::fs::read_to_string(self.path("stderr")).unwrap_or_default()
    }

    /// Runs it to its end.
    pub fn run(&self, arguments: &str) -> ExitStatus {
        self.start(arguments, None).wait().expect("the program ends")
    }

    /// Runs it to its end, which must be a good one, and measures it. Counts how often the file
    /// `watched` is replaced before.
    ///
    /// # Panics
    /// If it fails, or GNU time is not there.
    pub fn measure(&self, arguments: &str, watched: &str) -> Cost {
        let prefix = ["/usr/bin/time", "-f", "%U %S %M", "-o", "cost"];
        let started = Instant::now();
        let child = self.command(&prefix, arguments).stderr(Stdio::inherit()).spawn();
        let mut child = child.expect("GNU time is there; on Debian: apt-get install time");
        let (path, mut replaced) = (self.path(watched), 0);
        let modified = |path: &Path| path.metadata().and_then(|file| file.modified()).ok();
        let mut last: Option<SystemTime> = modified(&path);
        let status = loop {
            if let Some(status) = child.try_wait().expect("it is our child") {
                break status;
            }
            let now = modified(&path);
            replaced += u32::from(now != last);
            last = now;
            std::thread::sleep(Duration::from_millis(20));
        };
        let wall = started.elapsed().as_secs_f64();
        assert!(status.success(), "{arguments}: {status}");
        let cost = std::fs::read_to_string(self.path("cost")).expect("the cost was written");
        let numbers = cost.split_whitespace().map(|word| word.parse::<f64>().expect("a number"));
        let numbers: Vec<f64> = numbers.collect();
        let [user, system, kib] = numbers[..] else { panic!("GNU time says: {cost}") };
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "KiB")]
        let memory = kib as u64 * 1024;
        Cost { wall, processor: user + system, memory, replaced }
    }

    /// Bytes that are free on its disk.
    pub fn free(&self) -> u64 {
        let df = Command::new("df").args(["--output=avail", "-B1"]).arg(self.0.path()).output();
        let text = String::from_utf8(df.expect("df runs").stdout).expect("df writes text");
        text.lines().nth(1).and_then(|line| line.trim().parse().ok()).expect("df says bytes")
    }
}
