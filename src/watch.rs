//! Who looks on while something is measured: is told how far it is, and may stop it.

use std::sync::atomic::{AtomicBool, Ordering};

/// How far a measurement is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress<Step> {
    /// What is being measured.
    pub step: Step,
    /// The part of it that is over, from 0 to 1.
    pub share: f64,
}

/// The user stopped it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error("interrupted")]
pub struct Interrupted;

/// Who looks on: is told of the progress, and may interrupt.
pub struct Watch<'a, Step> {
    /// Raised to stop.
    pub interrupt: &'a AtomicBool,
    /// Told of the progress after every turn.
    pub observe: &'a mut dyn FnMut(Progress<Step>),
}

impl<Step> Watch<'_, Step> {
    /// Tells of the progress.
    ///
    /// # Errors
    /// If it is to stop.
    pub(crate) fn report(&mut self, step: Step, share: f64) -> Result<(), Interrupted> {
        (self.observe)(Progress { step, share: share.min(1.0) });
        if self.interrupt.load(Ordering::Relaxed) { Err(Interrupted) } else { Ok(()) }
    }
}
