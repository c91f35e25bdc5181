//! The program as its users meet it: the real binary, run in fresh folders.

mod arguments;
mod auto;
mod candor;
mod cost;
mod devices;
mod diff;
mod explain;
mod films;
mod hostile;
#[cfg(target_os = "linux")]
mod lossy;
mod pictures;
mod replay;
#[cfg(unix)]
mod signals;
mod streams;
mod target;
