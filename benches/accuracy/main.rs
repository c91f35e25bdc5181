//! What accuracy costs inside the kernel: the worst error of each elementary function and of
//! each way to a hit, and beside it nanoseconds per call and per sample:
//! `cargo bench --bench accuracy [-- --rounds N --device NAME]`.
//!
//! The functions go through every input that the kernel can pass, some three thousand million,
//! which takes minutes. Times are taken in turns; an extra cost is the median of the
//! differences within the rounds with its 95 % interval, and one whose interval holds 0 is
//! called free. The process fails where a function exceeds its bound.

#[path = "../support/options.rs"]
mod options;
#[path = "../../tests/support/hits.rs"]
mod rays;
#[path = "../support/turns.rs"]
mod turns;
#[path = "../support/wgsl.rs"]
mod wgsl;

mod calls;
mod functions;
mod hits;
mod renders;

use std::process::ExitCode;

fn main() -> ExitCode {
    let rounds = options::count("--rounds").unwrap_or(15);
    let adapter = options::adapter();
    println!("{} ({}), {rounds} rounds\n", adapter.name(), adapter.driver());
    let functions = functions::measure(&adapter);
    functions::print(&functions);
    calls::measure_functions(&adapter, rounds, &functions);
    renders::measure_functions(&adapter, rounds, &functions);
    renders::measure_forms(&adapter, rounds, &hits::measure(&adapter));
    calls::measure_forms(&adapter, rounds);
    let exceeded = functions.iter().any(functions::Measured::exceeds);
    if exceeded { ExitCode::FAILURE } else { ExitCode::SUCCESS }
}
