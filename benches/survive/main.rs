//! Films that survive, `cargo bench --bench survive [-- kills checkpoints merging sizes]`.
//!
//! Kills a render on the device a hundred times at random moments, with full disks and torn films
//! between, and fails if the film in the end is not that of a render which nothing interrupted, to
//! the bit. Then measures what a checkpoint costs at 1080p, how fast a hundred films are merged
//! and in how much memory, and how large films are. `--turns N` and `--spp N` set the pairs of
//! renders that checkpoints are measured with and their samples. Needs GNU time, and 8 GB of disk
//! where temporary files go.

mod costs;
mod kills;
#[path = "../support/options.rs"]
mod options;
mod program;

use std::process::ExitCode;

fn main() -> ExitCode {
    let parts = ["kills", "checkpoints", "merging", "sizes"];
    let named: Vec<String> = std::env::args().filter(|arg| parts.contains(&arg.as_str())).collect();
    let wanted = |part: &str| named.is_empty() || named.iter().any(|name| name == part);
    if wanted("kills") && !kills::survived() {
        return ExitCode::FAILURE;
    }
    if wanted("checkpoints") {
        let turns = options::count("--turns").and_then(|turns| turns.try_into().ok()).unwrap_or(6);
        costs::checkpoints(turns, options::count("--spp").unwrap_or(96));
    }
    if wanted("merging") {
        costs::merging();
    }
    if wanted("sizes") {
        costs::sizes();
    }
    ExitCode::SUCCESS
}
