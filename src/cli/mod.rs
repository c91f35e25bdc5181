//! The command line: what the user asked for, turned into calls of the library and
//! into messages. Results go to stdout; progress and messages to stderr.

mod args;
mod checkpoint;
mod choose;
mod cost;
mod cost_table;
mod devices;
mod diff;
mod endure;
mod environment;
mod explain;
mod explain_table;
mod hard;
mod interrupt;
mod ledger;
mod log;
mod memory;
mod merge;
mod output;
mod pilot;
mod place;
mod progress;
mod render;
mod render_report;
mod replay;
mod replay_json;
mod replay_table;
mod resume;
mod setup;
mod steps;
mod streams;
mod values;
mod verify;

use crate::units;
use args::{Cli, Command};
use clap::Parser;
use std::io::IsTerminal;
use std::process::ExitCode;
use tempfile::TempDir;

/// Everything was done.
const DONE: u8 = 0;
/// A check failed or a target was not reached.
const FAILED: u8 = 1;
/// The input or the machine does not allow it.
const REFUSED: u8 = 2;
/// Stopped by Ctrl-C or SIGTERM.
const INTERRUPTED: u8 = 130;

/// Why a command ended without a result: a message for the user.
#[derive(Debug)]
struct Refusal(String);

impl<E: std::error::Error> From<E> for Refusal {
    fn from(error: E) -> Self {
        Self(format!("error: {error}"))
    }
}

/// A refusal in words of our own.
fn refuse<T>(message: impl std::fmt::Display) -> Result<T, Refusal> {
    Err(Refusal(format!("error: {message}")))
}

/// Runs the program and says how it ended.
#[must_use]
pub fn main() -> ExitCode {
    let cli = Cli::parse();
    let afresh = cli.command.compiles_afresh().then(tempfile::tempdir).transpose();
    let cache = match afresh {
        Ok(folder) => folder,
        Err(error) => {
            streams::message(&format!("error: cannot make a folder for compiled kernels: {error}"));
            return ExitCode::from(REFUSED);
        }
    };
    environment::prepare(cli.command.threads(), cache.as_ref().map(TempDir::path));
    report_panics();
    interrupt::survive_file_limits();
    let ended = std::panic::catch_unwind(|| match &cli.command {
        Command::Render(args) => render::run(args),
        Command::Verify(args) => verify::run(args),
        Command::Merge(args) => merge::run(args),
        Command::Diff(args) => diff::run(args),
        Command::Cost(args) => cost::run(args),
        Command::Replay(args) => replay::run(args),
        Command::Explain(args) => explain::run(args),
        Command::Devices => devices::run(),
    });
    match ended {
        Ok(Ok(code)) => ExitCode::from(code),
        Ok(Err(Refusal(message))) => {
            streams::message(&message);
            ExitCode::from(REFUSED)
        }
        Err(_) => ExitCode::from(REFUSED),
    }
}

/// A panic is a mistake of ours; the user gets one line that says so, and where.
fn report_panics() {
    std::panic::set_hook(Box::new(|panic| {
        if crate::gpu::is_polling() {
            return;
        }
        let place = panic.location().map(ToString::to_string).unwrap_or_default();
        let cause = panic.payload_as_str().unwrap_or("unknown");
        streams::message(&format!("error: this is a mistake in candor, at {place}: {cause}"));
    }));
}

/// Whether messages go to a terminal that can move its cursor.
fn on_terminal() -> bool {
    std::io::stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// Whether messages may be coloured (see no-color.org).
fn in_colour() -> bool {
    on_terminal() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}
