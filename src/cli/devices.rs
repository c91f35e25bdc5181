//! `candor devices`: what can render here.

use super::DONE;
use crate::gpu::adapters;

pub(super) fn run() -> u8 {
    let adapters = adapters();
    for adapter in &adapters {
        println!("{}\n    {}; {}", adapter.name(), adapter.kind(), adapter.driver());
    }
    println!("cpu\n    the f64 reference on this machine's processor; always there");
    let auto = adapters.first().map_or("cpu", |adapter| adapter.name());
    println!("\n--device auto takes: {auto}");
    DONE
}
