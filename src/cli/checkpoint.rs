//! Checkpoints: the film so far, written beside the render by a thread of its own.

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
    path: PathBuf,
    origin: Origin,
    every: Duration,
    target: Option<f64>,
    last: Instant,
    writer: Option<JoinHandle<Result<(), FileError>>>,
    written: bool,
}

impl Checkpoints {
    /// Checkpoints in `path`, of a render to the error `target` if there is one.
    pub fn new(path: &Path, origin: Origin, every: Duration, target: Option<f64>) -> Self {
        let (path, last) = (path.to_owned(), Instant::now());
        Self { path, origin, every, target, last, writer: None, written: false }
    }

    /// Begins to write one if it is time and the one before is written. What a message to the
    /// user says is wrong with that one.
    pub fn observe(
        &mut self,
        progress: &Progress,
        tracer: &mut dyn Tracer,
    ) -> Result<Option<String>, TraceError> {
        if self.last.elapsed() < self.every || self.is_writing() {
            return Ok(None);
        }
        let wrong = self.finish();
        self.last = Instant::now();
        let next_look = std::iter::zip(self.target, progress.next_look).next();
        let spent = Spent {
            ledger: tracer.ledger()?,
            seconds: progress.elapsed.as_secs_f64(),
            next_look: next_look.map(|(target, samples)| NextLook { target, samples }),
        };
        let (film, origin, path) = (tracer.film()?, self.origin.clone(), self.path.clone());
        self.writer = Some(std::thread::spawn(move || write(&path, origin, spent, &film)));
        Ok(wrong)
    }

    fn is_writing(&self) -> bool {
        self.writer.as_ref().is_some_and(|writer| !writer.is_finished())
    }

    /// Waits for the one that is being written. What a message to the user says is wrong with it.
    pub fn finish(&mut self) -> Option<String> {
        let ended = self.writer.take()?.join();
        let Err(error) = ended.unwrap_or_else(|panic| std::panic::resume_unwind(panic)) else {
            self.written = true;
            return None;
        };
        let before = if self.written { "the one before stays" } else { "there is none yet" };
        Some(format!("warning: no checkpoint, {before}: {error}"))
    }
}

fn write(path: &Path, origin: Origin, spent: Spent, film: &Film) -> Result<(), FileError> {
    let summary = summary(film, &spent.ledger, false);
    let picture = Picture::develop(film, origin.dark);
    let provenance = Provenance::new(origin, spent, film, &summary);
    write_exr(path, &picture, Sums::Quick(film), &provenance)
}
