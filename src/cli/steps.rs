//! Progress of a measurement on stderr: a bar on a terminal, a line for each step elsewhere,
//! nothing if quiet.

use super::progress::bar;
use super::{on_terminal, streams};
use crate::watch::Progress;
use indicatif::ProgressBar;

/// Shows what is being measured.
pub(super) struct Steps<Step> {
    shown: Shown<Step>,
    /// What a step is called.
    name: fn(Step) -> &'static str,
}

enum Shown<Step> {
    Quiet,
    Bar(ProgressBar),
    /// With the latest step.
    Lines(Option<Step>),
}

impl<Step: Copy + PartialEq> Steps<Step> {
    pub fn new(quiet: bool, name: fn(Step) -> &'static str) -> Self {
        let shown = match (quiet, on_terminal()) {
            (true, _) => Shown::Quiet,
            (false, true) => Shown::Bar(bar()),
            (false, false) => Shown::Lines(None),
        };
        Self { shown, name }
    }

    /// A line that stays on the screen.
    pub fn message(&self, text: &str) {
        match &self.shown {
            Shown::Quiet => {}
            Shown::Bar(bar) => bar.println(text),
            Shown::Lines(_) => streams::message(text),
        }
    }

    /// Tells of a turn.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share in thousandths, for show"
    )]
    pub fn observe(&mut self, progress: Progress<Step>) {
        let name = (self.name)(progress.step);
        match &mut self.shown {
            Shown::Quiet => {}
            Shown::Bar(bar) => {
                bar.set_position((1000.0 * progress.share) as u64);
                bar.set_message(name);
            }
            Shown::Lines(latest) => {
                if *latest != Some(progress.step) {
                    streams::message(name);
                    *latest = Some(progress.step);
                }
            }
        }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        if let Shown::Bar(bar) = &self.shown {
            bar.finish_and_clear();
        }
    }
}
