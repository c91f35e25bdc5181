//! Runs the binary in a folder of its own and keeps what it said.

use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Child, Command, Stdio};
use std::thread::sleep;
use std::time::{Duration, Instant};
use tempfile::{NamedTempFile, TempDir};

/// A floor under a lamp, both in view: quick to trace, and every sample has a good
/// chance to meet light.
pub const SCENE: &str = "\
[camera]
position = [0.0, 1.0, 5.0]
look_at = [0.0, 1.0, 0.0]
vertical_fov = 60.0

[image]
width = 8
height = 6

[render]
spp = 4

[materials.grey]
diffuse = [0.5, 0.5, 0.5]

[[spheres]]
name = \"floor\"
center = [0.0, -100.0, 0.0]
radius = 100.0
material = \"grey\"

[[spheres]]
name = \"lamp\"
center = [0.0, 3.0, 0.0]
radius = 1.5
emission = [0.5, 0.5, 0.5]
";

/// The same without the lamp.
pub fn dark_scene() -> &'static str {
    SCENE.rsplit_once("[[spheres]]").expect("the lamp comes last").0
}

/// Nothing here takes nearly as long: a test that reaches this hangs.
const HANG: Duration = Duration::from_mins(5);

/// A fresh folder with `scene.toml` in it, gone with the test.
pub struct Folder(TempDir);

impl Folder {
    pub fn new() -> Self {
        let folder = Self(TempDir::new().expect("a temporary folder can be made"));
        folder.write("scene.toml", SCENE);
        folder
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub fn write(&self, name: &str, content: &str) {
        fs::write(self.path(name), content).expect("a test's file can be written");
    }

    pub fn read(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    /// Names of what is in the folder besides `scene.toml`, in order.
    pub fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).expect("the folder can be listed");
        let names = entries.map(|entry| entry.expect("the folder can be listed").file_name());
        let mut names: Vec<_> = names.map(|name| name.to_string_lossy().into_owned()).collect();
        names.retain(|name| name != "scene.toml");
        names.sort();
        names
    }

    /// The binary, to be run here with these arguments, separated by spaces.
    pub fn command(&self, arguments: &str) -> Command {
        let mut command = Command::new(env!("CARGO_BIN_EXE_candor"));
        command.args(arguments.split_whitespace()).current_dir(self.0.path()).stdin(Stdio::null());
        command
    }

    /// Runs the binary to its end.
    pub fn candor(&self, arguments: &str) -> Ended {
        Running::start(&mut self.command(arguments)).end()
    }
}

/// On a machine without any Vulkan driver.
#[cfg(target_os = "linux")]
pub fn without_vulkan(command: &mut Command) -> &mut Command {
    command
        .env_remove("VK_ADD_DRIVER_FILES")
        .env("VK_DRIVER_FILES", "/nonexistent")
        .env("VK_ICD_FILENAMES", "/nonexistent")
}

/// In a shell under which no file may grow beyond so many blocks of 512 bytes, as on a disk that
/// is full.
#[cfg(unix)]
pub fn with_files_up_to(blocks: u64, command: &Command) -> Command {
    limited(&format!("ulimit -f {blocks}"), command)
}

/// In a shell that sets limits first.
#[cfg(unix)]
pub fn limited(limits: &str, command: &Command) -> Command {
    let mut shell = Command::new("sh");
    shell.args(["-c", &format!("{limits}; exec \"$@\""), "sh"]).arg(command.get_program());
    shell.args(command.get_args()).stdin(Stdio::null());
    shell.current_dir(command.get_current_dir().expect("a folder of its own"));
    shell
}

/// A process under way. Its streams are files, as with `> out 2> err`.
pub struct Running {
    child: Child,
    stdout: NamedTempFile,
    stderr: NamedTempFile,
}

impl Running {
    pub fn start(command: &mut Command) -> Self {
        let stream = || NamedTempFile::new().expect("a temporary file can be made");
        let (stdout, stderr) = (stream(), stream());
        let end = |file: &NamedTempFile| -> File { file.reopen().expect("it was just made") };
        let child = command.stdout(end(&stdout)).stderr(end(&stderr)).spawn();
        Self { child: child.expect("the program starts"), stdout, stderr }
    }

    #[cfg(unix)]
    pub fn id(&self) -> u32 {
        self.child.id()
    }

    /// Waits until stderr shows `text`.
    #[cfg(unix)]
    pub fn wait_for(&mut self, text: &str) {
        self.until(&format!("\"{text}\" on stderr"), |running| {
            said(&running.stderr).contains(text).then_some(())
        });
    }

    /// Waits until a condition holds while the process runs; `what` names it.
    #[cfg(unix)]
    pub fn wait_until(&mut self, what: &str, mut holds: impl FnMut() -> bool) {
        self.until(what, |running| {
            let ended = running.child.try_wait().expect("it is our child");
            assert!(ended.is_none(), "ended before {what}: {}", said(&running.stderr));
            holds().then_some(())
        });
    }

    /// Waits for the end.
    pub fn end(mut self) -> Ended {
        let status =
            self.until("its end", |running| running.child.try_wait().expect("it is our child"));
        Ended { code: status.code(), stdout: said(&self.stdout), stderr: said(&self.stderr) }
    }

    fn until<T>(&mut self, what: &str, mut reached: impl FnMut(&mut Self) -> Option<T>) -> T {
        let started = Instant::now();
        loop {
            if let Some(value) = reached(self) {
                return value;
            }
            assert!(started.elapsed() < HANG, "waited in vain for {what}: {}", said(&self.stderr));
            sleep(Duration::from_millis(2));
        }
    }
}

/// A test that fails leaves no process behind.
impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}

fn said(stream: &NamedTempFile) -> String {
    String::from_utf8(fs::read(stream.path()).expect("the stream is a file"))
        .expect("messages are UTF-8")
}

/// How a run ended, and what it said.
#[derive(Debug)]
pub struct Ended {
    pub code: Option<i32>,
    pub stdout: String,
    pub stderr: String,
}

impl Ended {
    #[track_caller]
    pub fn with_code(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "{self:?}");
        self
    }

    /// Done, without a word on stderr; what it said on stdout.
    #[track_caller]
    pub fn silently_done(self) -> String {
        let ended = self.with_code(0);
        assert_eq!(ended.stderr, "");
        ended.stdout
    }

    /// Refused with exit code 2 and one message, which is on stderr and has all of
    /// `parts` in it; nothing on stdout.
    #[track_caller]
    pub fn refused(self, parts: &[&str]) {
        let ended = self.with_code(2);
        assert_eq!(ended.stdout, "");
        assert!(ended.stderr.starts_with("error: "), "{}", ended.stderr);
        assert!(!ended.stderr.contains("mistake in candor"), "{}", ended.stderr);
        for part in parts {
            assert!(ended.stderr.contains(part), "no \"{part}\" in: {}", ended.stderr);
        }
    }

    /// The one JSON object on stdout.
    #[track_caller]
    pub fn json(&self) -> serde_json::Map<String, serde_json::Value> {
        assert_eq!(self.stdout.lines().count(), 1, "{}", self.stdout);
        serde_json::from_str(&self.stdout).unwrap_or_else(|e| panic!("{e}: {}", self.stdout))
    }
}
