//! The processor time of this process, which does not count what others do beside it.

#![allow(dead_code, reason = "each benchmark uses some of it")]

use std::time::Instant;

/// Nanoseconds that the threads of this process have run on a processor, all together, as
/// Linux counts them; nothing elsewhere. Threads that ended are not in it, so that only
/// differences over the same threads say something.
fn threads_ran() -> Option<u64> {
    let tasks = std::fs::read_dir("/proc/self/task").ok()?;
    let ran = |task: std::fs::DirEntry| -> Option<u64> {
        let told = std::fs::read_to_string(task.path().join("schedstat")).ok()?;
        told.split_whitespace().next()?.parse().ok()
    };
    Some(tasks.filter_map(|task| ran(task.ok()?)).sum())
}

/// What some work took, in seconds.
#[derive(Debug, Clone, Copy)]
pub struct Took {
    /// By the clock.
    pub wall: f64,
    /// On processors, all cores together; by the clock where the system does not tell.
    pub processor: f64,
}

/// Does some work and says what it took.
#[expect(clippy::cast_precision_loss, reason = "nanoseconds below 2^53")]
pub fn timed(work: impl FnOnce()) -> Took {
    let (started, before) = (Instant::now(), threads_ran());
    work();
    let wall = started.elapsed().as_secs_f64();
    let ran = before.zip(threads_ran()).map(|(before, after)| after.saturating_sub(before));
    Took { wall, processor: ran.map_or(wall, |ran| ran as f64 / 1e9) }
}
