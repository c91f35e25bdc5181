//! Progress of an explanation on stderr: a bar on a terminal, a line for each step elsewhere,
//! nothing if quiet.

use super::progress::bar;
use super::{on_terminal, streams};
use crate::explain::{Progress, Step};
use indicatif::ProgressBar;

/// Shows what is being measured.
pub(super) enum Steps {
    Quiet,
    Bar(ProgressBar),
    Lines(Option<Step>),
}

impl Steps {
    pub fn new(quiet: bool) -> Self {
        match (quiet, on_terminal()) {
            (true, _) => Self::Quiet,
            (false, true) => Self::Bar(bar()),
            (false, false) => Self::Lines(None),
        }
    }

    /// Tells of a turn.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share in thousandths, for show"
    )]
    pub fn observe(&mut self, progress: Progress) {
        let what = match progress.step {
            Step::Compiling => "compiling both kernels",
            Step::Tracing => "tracing with both kernels in turns",
        };
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                bar.set_position((1000.0 * progress.share) as u64);
                bar.set_message(what);
            }
            Self::Lines(latest) => {
                if *latest != Some(progress.step) {
                    streams::message(what);
                    *latest = Some(progress.step);
                }
            }
        }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        if let Self::Bar(bar) = self {
            bar.finish_and_clear();
        }
    }
}
