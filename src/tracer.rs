//! What a tracer is: something that adds samples to a film. The GPU and the CPU twin
//! stand behind this trait, and everything to its right sees nothing else of them.

use crate::film::{Film, FilmError};
use std::ops::Range;

/// What traces, for messages and film headers.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Description {
    /// Name of the device.
    pub device: String,
    /// Driver and its version.
    pub driver: String,
    /// Whether the samples are computed in software, on this machine's processor.
    pub software: bool,
}

/// Why a sample did not enter the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum InvalidReason {
    /// A loop of the kernel was cut short by the driver.
    Unfinished,
    /// NaN, infinite, negative, or above the proven bound on one sample.
    OutOfBounds,
}

/// The address of an invalid sample.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InvalidSample {
    /// Pixel number, row by row from the top.
    pub pixel: u32,
    /// Sample index.
    pub index: u64,
    /// What was wrong with it.
    pub reason: InvalidReason,
}

/// Invalid samples: how many, and the first few of them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ledger {
    /// How many samples were invalid; they add 0 to the film and count in N.
    pub count: u64,
    /// The first recorded ones.
    pub records: Vec<InvalidSample>,
}

/// Why a tracer gave up.
#[derive(Debug, thiserror::Error)]
pub enum TraceError {
    /// No device, or it does not fit the scene; the text says what to do.
    #[error("{0}")]
    Device(String),
    /// The device stopped working in the middle.
    #[error("the device was lost: {0}")]
    DeviceLost(String),
    /// The picture does not fit into memory.
    #[error("not enough memory: {0}")]
    OutOfMemory(String),
    /// The film refused the samples.
    #[error(transparent)]
    Film(#[from] FilmError),
}

/// Adds samples of every pixel to a film.
pub trait Tracer {
    /// Traces the samples `range` of every pixel and adds them to the film.
    ///
    /// # Errors
    /// If the device fails, or the film already holds a sample of the range.
    fn add_samples(&mut self, range: Range<u64>) -> Result<(), TraceError>;

    /// The film with everything added so far.
    ///
    /// # Errors
    /// If the device fails.
    fn film(&mut self) -> Result<Film, TraceError>;

    /// The invalid samples met so far.
    ///
    /// # Errors
    /// If the device fails.
    fn ledger(&mut self) -> Result<Ledger, TraceError>;

    /// What traces.
    fn describe(&self) -> Description;
}
