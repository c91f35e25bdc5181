//! Ctrl-C, SIGTERM and SIGHUP: the first one asks to stop and write, the second stops at once.

use super::{INTERRUPTED, streams};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

/// Signals this soon after the first are the same request: a supervisor may send one to
/// the process and one to its group.
const SAME_REQUEST: Duration = Duration::from_secs(1);

static INTERRUPT: AtomicBool = AtomicBool::new(false);
static FIRST: OnceLock<Instant> = OnceLock::new();
static WRITING: AtomicBool = AtomicBool::new(false);

/// The flag that is raised by the first signal.
pub(super) fn watch() -> std::io::Result<&'static AtomicBool> {
    listen(|| {
        INTERRUPT.store(true, Ordering::Relaxed);
        let insists = FIRST.get_or_init(Instant::now).elapsed() > SAME_REQUEST;
        if insists && !WRITING.load(Ordering::Relaxed) {
            streams::message("stopped at once; nothing more is written");
            std::process::exit(INTERRUPTED.into());
        }
    })?;
    Ok(&INTERRUPT)
}

/// From here on files are being written, which takes moments; no signal leaves them
/// half-way.
pub(super) fn writing_begins() {
    WRITING.store(true, Ordering::Relaxed);
}

#[cfg(unix)]
fn listen(on_signal: impl Fn() + Send + 'static) -> std::io::Result<()> {
    use signal_hook::consts::{SIGHUP, SIGINT, SIGTERM};
    let ignored = ignored();
    let asked =
        [SIGINT, SIGTERM, SIGHUP].into_iter().filter(|signal| ignored >> (signal - 1) & 1 == 0);
    let mut signals = signal_hook::iterator::Signals::new(asked)?;
    std::thread::spawn(move || signals.forever().for_each(|_| on_signal()));
    Ok(())
}

/// The signals that the process was started to ignore, signal n in bit n - 1, as `nohup` does with
/// SIGHUP: they stay ignored. Known on Linux alone.
#[cfg(unix)]
fn ignored() -> u64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let mask = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    mask.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok()).unwrap_or(0)
}

#[cfg(not(unix))]
fn listen(on_signal: impl Fn() + Send + 'static) -> std::io::Result<()> {
    ctrlc::set_handler(on_signal).map_err(std::io::Error::other)
}

/// A file that may not grow further is a write that fails, with a message, and no reason to end.
pub(super) fn survive_file_limits() {
    #[cfg(unix)]
    {
        /// SIGXFSZ on Linux, macOS and the BSDs.
        const TOO_LARGE: i32 = 25;
        let seen = std::sync::Arc::new(AtomicBool::new(false));
        // Where it cannot be caught, it ends the process as it does others.
        let _ = signal_hook::flag::register(TOO_LARGE, seen);
    }
}
