//! Checkpoints: the film so far, written beside the render by a thread of its own.

use super::args::RenderArgs;
use super::place::for_checkpoint;
use super::progress::Reporter;
use super::render::summary;
use crate::film::{Film, SampleRanges};
use crate::render::Progress;
use crate::report::{FileError, NextLook, Origin, Picture, Provenance, Spent, Sums, write_exr};
use crate::tracer::{TraceError, Tracer};
use std::path::{Path, PathBuf};
use std::thread::{Builder, JoinHandle};
use std::time::{Duration, Instant};

/// Where the film so far goes from time to time.
pub(super) struct Checkpoints {
    /// Nowhere, if no state is kept.
    path: Option<PathBuf>,
    /// Where they should go.
    wanted: Option<PathBuf>,
    origin: Origin,
    every: Duration,
    target: Option<f64>,
    last: Instant,
    writer: Option<JoinHandle<Result<PathBuf, FileError>>>,
    /// Whether one is there.
    written: bool,
}

impl Checkpoints {
    /// Checkpoints in `path`, of which a render that goes on has `begun` there.
    pub fn new(
        path: Option<&Path>,
        origin: &Origin,
        args: &RenderArgs,
        begun: &SampleRanges,
    ) -> Result<Self, FileError> {
        let place = path.map(|path| for_checkpoint(path, &origin.identity, begun)).transpose()?;
        Ok(Self {
            path: place,
            wanted: path.map(Path::to_owned),
            origin: origin.clone(),
            every: args.checkpoint_every,
            target: args.target_error,
            last: Instant::now(),
            writer: None,
            written: begun.count() > 0,
        })
    }

    /// Where they go if not to where they should.
    pub fn aside(&self) -> Option<&Path> {
        self.path.as_deref().filter(|_| self.path != self.wanted)
    }

    /// Says where they go, if that is not where the user expects them.
    pub fn announce(&self, reporter: &Reporter) {
        if let (Some(aside), Some(wanted)) = (self.aside(), &self.wanted) {
            let (aside, wanted) = (aside.display(), wanted.display());
            reporter.message(&format!(
                "{wanted} holds another film: checkpoints go to {aside} (-o {aside} --resume goes on \
                 from it)"
            ));
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
        if is_writing || self.last.elapsed() < self.every {
            return Ok(());
        }
        self.finish(reporter);
        let Some(path) = self.path.clone() else { return Ok(()) };
        self.last = Instant::now();
        let spent = Spent {
            ledger: tracer.ledger()?,
            seconds: progress.elapsed.as_secs_f64(),
            next_look: NextLook::planned(self.target, progress.next_look),
        };
        let (film, origin) = (tracer.film()?, self.origin.clone());
        let place = path.clone();
        match Builder::new().spawn(move || write(&place, origin, spent, &film)) {
            Ok(writer) => self.writer = Some(writer),
            Err(error) => self.warn(&FileError::new(&path, &error), reporter),
        }
        Ok(())
    }

    /// Waits for the one that is being written, and says what is wrong with it.
    pub fn finish(&mut self, reporter: &Reporter) {
        let Some(writer) = self.writer.take() else { return };
        let mistake =
            |_| Err(FileError::new(Path::new("candor"), &"a mistake while it was written"));
        match writer.join().unwrap_or_else(mistake) {
            Ok(path) => {
                self.written = true;
                if self.path.replace(path.clone()) != Some(path) {
                    self.announce(reporter);
                }
            }
            Err(error) => self.warn(&error, reporter),
        }
    }

    fn warn(&self, error: &FileError, reporter: &Reporter) {
        let before = if self.written { "the one before stays" } else { "there is none" };
        reporter.message(&format!("warning: no checkpoint, {before}: {error}"));
    }
}

/// Writes one, beside `path` if something has come there that it must not replace; says where.
fn write(path: &Path, origin: Origin, spent: Spent, film: &Film) -> Result<PathBuf, FileError> {
    let summary = summary(film, &spent.ledger, false);
    let picture = Picture::develop(film, origin.dark);
    let provenance = Provenance::new(origin, spent, film, &summary);
    let place = for_checkpoint(path, &provenance.origin.identity, film.samples())?;
    write_exr(&place, &picture, Sums::Quick(film), &provenance)?;
    Ok(place)
}
