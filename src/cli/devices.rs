//! `candor devices`: what can render here.

use super::{DONE, Refusal, streams};
use crate::gpu::adapters;

pub(super) fn run() -> Result<u8, Refusal> {
    let adapters = adapters();
    let mut lines: Vec<String> = adapters
        .iter()
        .map(|a| format!("{}\n    {}; {}", a.name(), a.kind(), a.driver()))
        .collect();
    lines.push("cpu\n    the f64 reference on this machine's processor; always there".to_owned());
    let auto = adapters.first().map_or("cpu", |adapter| adapter.name());
    lines.push(format!("\n--device auto takes: {auto}"));
    streams::results(&lines.join("\n"))?;
    Ok(DONE)
}
