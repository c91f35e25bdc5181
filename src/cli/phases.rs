//! Progress of a study on stderr: a bar on a terminal, a line for each phase elsewhere,
//! nothing if quiet.

use super::progress::bar;
use super::{on_terminal, streams, units};
use crate::cost::{Phase, Plan, Progress};
use indicatif::ProgressBar;

/// Shows which phase a study is in.
pub(super) enum Phases {
    Quiet,
    Bar(ProgressBar),
    Lines(Option<Phase>),
}

impl Phases {
    pub fn new(quiet: bool) -> Self {
        match (quiet, on_terminal()) {
            (true, _) => Self::Quiet,
            (false, true) => Self::Bar(bar()),
            (false, false) => Self::Lines(None),
        }
    }

    /// Says what is planned.
    pub fn announce(&self, plan: &Plan, device: &str) {
        let phases = Phase::ALL.map(|phase| {
            format!("{} {}", phase.name(), units::time(plan.length(phase).as_secs_f64()))
        });
        self.message(&format!("planned on {device}: {}", phases.join(", ")));
    }

    /// A line that stays on the screen.
    pub fn message(&self, text: &str) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => bar.println(text),
            Self::Lines(_) => streams::message(text),
        }
    }

    /// Tells of a turn.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share in thousandths, for show"
    )]
    pub fn observe(&mut self, progress: Progress) {
        match self {
            Self::Quiet => {}
            Self::Bar(bar) => {
                bar.set_position((1000.0 * progress.share) as u64);
                bar.set_message(progress.phase.name());
            }
            Self::Lines(latest) => {
                if *latest != Some(progress.phase) {
                    streams::message(progress.phase.name());
                    *latest = Some(progress.phase);
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
