//! Ctrl-C and SIGTERM: the first one asks to stop and write, the second stops at once.

use super::INTERRUPTED;
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
pub(super) fn watch() -> Result<&'static AtomicBool, ctrlc::Error> {
    ctrlc::set_handler(|| {
        INTERRUPT.store(true, Ordering::Relaxed);
        let insists = FIRST.get_or_init(Instant::now).elapsed() > SAME_REQUEST;
        if insists && !WRITING.load(Ordering::Relaxed) {
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
