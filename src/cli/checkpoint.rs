//! Checkpoints: the film so far, written beside the render by a thread of its own.

use super::args::RenderArgs;
use super::progress::Reporter;
use super::render::summary;
use crate::film::Film;
use crate::render::Progress;
use crate::report::{FileError, NextLook, Origin, Picture, Provenance, Spent, Sums, write_exr};
use crate::tracer::{TraceError, Tracer};
use std::path::{Path, PathBuf};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Where the film so far goes from time to time.
pub(super) struct Checkpoints {
    /// Nowhere, if no state is kept.
    path: Option<PathBuf>,
    origin: Origin,
    every: Duration,
    target: Option<f64>,
    last: Instant,
    writer: Option<JoinHandle<Result<(), FileError>>>,
    written: bool,
}

impl Checkpoints {
    /// Checkpoints in `path`.
    pub fn new(path: Option<PathBuf>, origin: &Origin, args: &RenderArgs) -> Self {
        Self {
            path,
            origin: origin.clone(),
            every: args.checkpoint_every,
            target: args.target_error,
            last: Instant::now(),
            writer: None,
            written: false,
        }
    }

    /// Begins to write one if it is time and the one before is written.
    pub fn observe(
        &mut self,
        progress: &Progress,
        tracer: &mut dyn Tracer,
        reporter: &Reporter,
    ) -> Result<(), TraceError> {
        let is_writing = self.writer.as_ref().is_some_and(|writer| !writer.is_finished());
        let Some(path) = self.path.clone().filter(|_| !is_writing) else { return Ok(()) };
        if self.last.elapsed() < self.every {
            return Ok(());
        }
        self.finish(reporter);
        self.last = Instant::now();
        let next_look = std::iter::zip(self.target, progress.next_look).next();
        let spent = Spent {
            ledger: tracer.ledger()?,
            seconds: progress.elapsed.as_secs_f64(),
            next_look: next_look.map(|(target, samples)| NextLook { target, samples }),
        };
        let (film, origin) = (tracer.film()?, self.origin.clone());
        self.writer = Some(std::thread::spawn(move || write(&path, origin, spent, &film)));
        Ok(())
    }

    /// Waits for the one that is being written, and says what is wrong with it.
    pub fn finish(&mut self, reporter: &Reporter) {
        let Some(writer) = self.writer.take() else { return };
        match writer.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)) {
            Ok(()) => self.written = true,
            Err(error) => {
                let before = if self.written { "the one before stays" } else { "there is none" };
                reporter.message(&format!("warning: no checkpoint, {before}: {error}"));
            }
        }
    }
}

fn write(path: &Path, origin: Origin, spent: Spent, film: &Film) -> Result<(), FileError> {
    let summary = summary(film, &spent.ledger, false);
    let picture = Picture::develop(film, origin.dark);
    let provenance = Provenance::new(origin, spent, film, &summary);
    write_exr(path, &picture, Sums::Quick(film), &provenance)
}
