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

impl Description {
    /// Both names, where they differ: who made a film of which another made a part.
    #[must_use]
    pub fn and(&self, other: &Self) -> Self {
        let join = |ours: &str, theirs: &str| {
            let known = ours.split(BETWEEN).any(|name| name == theirs);
            if known { ours.to_owned() } else { format!("{ours}{BETWEEN}{theirs}") }
        };
        Self {
            device: join(&self.device, &other.device),
            driver: join(&self.driver, &other.driver),
            software: self.software && other.software,
        }
    }
}

/// Stands between the names of several devices.
const BETWEEN: &str = "; ";

/// Why a sample did not enter the film.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub enum InvalidReason {
    /// A loop of the kernel was cut short by the driver.
    Unfinished,
    /// A channel is not a number.
    NotANumber,
    /// A channel is infinite, of either sign.
    Infinite,
    /// A channel is negative; −0 is.
    Negative,
    /// A channel is above the proven bound on one sample ([`crate::bound`]).
    AboveBound,
}

impl InvalidReason {
    /// What is wrong with the radiance of a finished sample, the first reason of this list that
    /// holds for any channel; `None` if all are from 0 to `bound`. It looks at bit patterns, as
    /// the device does: no compiler may assume NaN away.
    #[must_use]
    pub fn of(radiance: [f32; 3], bound: f32) -> Option<Self> {
        const INFINITY: u32 = f32::INFINITY.to_bits();
        const SIGN: u32 = 1 << 31;
        let bits = radiance.map(f32::to_bits);
        let any = |holds: fn(u32) -> bool| bits.into_iter().any(holds);
        if any(|bits| bits & !SIGN > INFINITY) {
            Some(Self::NotANumber)
        } else if any(|bits| bits & !SIGN == INFINITY) {
            Some(Self::Infinite)
        } else if any(|bits| bits & SIGN != 0) {
            Some(Self::Negative)
        } else {
            bits.into_iter().any(|bits| bits > bound.to_bits()).then_some(Self::AboveBound)
        }
    }

    /// The reason of that [`name`](Self::name).
    #[must_use]
    pub fn named(name: &str) -> Option<Self> {
        let all =
            [Self::Unfinished, Self::NotANumber, Self::Infinite, Self::Negative, Self::AboveBound];
        all.into_iter().find(|reason| reason.name() == name)
    }

    /// One word, for files and `--json`.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self {
            Self::Unfinished => "unfinished",
            Self::NotANumber => "nan",
            Self::Infinite => "infinite",
            Self::Negative => "negative",
            Self::AboveBound => "above-bound",
        }
    }
}

/// For people.
impl std::fmt::Display for InvalidReason {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::Unfinished => "the driver cut a loop short",
            Self::NotANumber => "NaN",
            Self::Infinite => "infinite",
            Self::Negative => "negative",
            Self::AboveBound => "above the bound on one sample",
        })
    }
}

/// The address of an invalid sample, and what was wrong with it.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InvalidSample {
    /// Pixel number, row by row from the top.
    pub pixel: u32,
    /// Sample index.
    pub index: u64,
    /// What was wrong with it.
    pub reason: InvalidReason,
}

/// Invalid samples that a ledger records.
pub const LEDGER_RECORDS: usize = 16;

/// Invalid samples: how many, and the first few of them.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Ledger {
    /// How many samples were invalid; they add 0 to the film and count in N.
    pub count: u64,
    /// Those met first, at most [`LEDGER_RECORDS`], in the order of (pixel, index). Where there
    /// are more, which of them were met first is left to chance on a device.
    pub records: Vec<InvalidSample>,
}

impl Ledger {
    /// Adds what was met later. The records that were there stay.
    pub fn append(&mut self, later: Self) {
        self.count += later.count;
        let room = LEDGER_RECORDS.saturating_sub(self.records.len());
        self.records.extend(later.records.into_iter().take(room));
        self.records.sort_unstable_by_key(|record| (record.pixel, record.index));
    }
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

    /// Goes on from a film of the same picture and its invalid samples, which take the place of
    /// what this tracer has so far.
    ///
    /// # Errors
    /// If the device fails, or size or scale differ.
    fn restore(&mut self, film: &Film, ledger: &Ledger) -> Result<(), TraceError>;

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
