//! The program as its users meet it: the real binary, run in fresh folders.

mod arguments;
mod auto;
mod candor;
#[cfg(unix)]
mod checkpoints;
mod cost;
mod devices;
mod diff;
mod explain;
mod film;
mod films;
mod hostile;
#[cfg(unix)]
mod intruders;
mod kept;
#[cfg(unix)]
mod kills;
#[cfg(target_os = "linux")]
mod lossy;
mod merge;
mod pictures;
mod replay;
mod resume;
mod resume_refused;
mod resume_target;
#[cfg(unix)]
mod signals;
mod streams;
mod target;
