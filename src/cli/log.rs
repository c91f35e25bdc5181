//! The log of a render's error that was asked for, and what became of it.

use super::Refusal;
use super::args::RenderArgs;
use crate::estimate::Summary;
use crate::render::Progress;
use crate::report::{ErrorLog, FileError};
use std::time::Duration;

/// A log that cannot be written costs no picture: it is given up, and said at the end.
pub(super) struct Log {
    file: Option<ErrorLog>,
    error: Option<FileError>,
}

impl Log {
    /// Begins the log, or goes on with that of a render of `begun` samples per pixel.
    pub fn create(args: &RenderArgs, begun: u64) -> Result<Self, Refusal> {
        let file = args.log.as_deref().map(|path| ErrorLog::create(path, begun)).transpose()?;
        Ok(Self { file, error: None })
    }

    /// Whether there is one.
    pub fn is_kept(&self) -> bool {
        self.file.is_some()
    }

    /// Adds a look, if there just was one.
    pub fn observe(&mut self, progress: &Progress) {
        if let Some(summary) = progress.summary.filter(|look| look.samples == progress.done) {
            self.add(&summary, progress.elapsed);
        }
    }

    /// Adds a row.
    pub fn add(&mut self, summary: &Summary, elapsed: Duration) {
        let added = self.file.as_mut().map_or(Ok(()), |file| file.add(summary, elapsed));
        if let Err(error) = added {
            self.error = Some(error);
            self.file = None;
        }
    }

    /// Why it is not whole.
    pub fn end(self) -> Option<FileError> {
        self.error
    }
}
