//! Ctrl-C and SIGTERM: the first one asks to stop and write, the second stops at once.

use super::INTERRUPTED;
use std::sync::atomic::{AtomicBool, Ordering};

static INTERRUPT: AtomicBool = AtomicBool::new(false);

/// The flag that is raised by the first signal.
pub(super) fn watch() -> Result<&'static AtomicBool, ctrlc::Error> {
    ctrlc::set_handler(|| {
        if INTERRUPT.swap(true, Ordering::Relaxed) {
            std::process::exit(INTERRUPTED.into());
        }
    })?;
    Ok(&INTERRUPT)
}
