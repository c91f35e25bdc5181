//! The two streams: results go to stdout, messages to stderr.

use super::{Refusal, refuse};
use std::io::{ErrorKind, Write};

/// Prints results. That their reader has left (`candor devices | head -1`) is no error;
/// a full disk is one.
pub(super) fn results(text: &str) -> Result<(), Refusal> {
    binary(&[text.as_bytes(), b"\n"].concat())
}

/// The same with results that are no text.
pub(super) fn binary(bytes: &[u8]) -> Result<(), Refusal> {
    let mut stdout = std::io::stdout().lock();
    match stdout.write_all(bytes).and_then(|()| stdout.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => {
            refuse(format_args!("cannot write to stdout: {error}"))
        }
        _ => Ok(()),
    }
}

/// Prints a message. Where nobody listens it is lost, and the work goes on.
pub(super) fn message(text: &str) {
    let _ = writeln!(std::io::stderr(), "{text}");
}
