//! Progress on stderr: a bar on a terminal, plain lines elsewhere, nothing if quiet.

use super::{on_terminal, streams, units};
use crate::estimate::Summary;
use crate::render::{Audience, Begun, Plan, Progress};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use std::time::Duration;

/// Plain lines come this far apart.
const LINE_EVERY: Duration = Duration::from_secs(10);

/// Shows how far a render is.
pub(super) struct Reporter {
    style: Style,
    pixels: u32,
    planned: u64,
    limit: Option<Duration>,
    target: Option<f64>,
    /// What was there before: it says nothing about the rate of this run.
    begun: Begun,
    /// Samples and time after the first round, which compiles the kernel and so says
    /// nothing about the rate of the others.
    first: Option<(u64, Duration)>,
}

enum Style {
    Quiet,
    Bar(ProgressBar),
    Lines { next: Duration },
}

impl Reporter {
    /// For a render of `pixels` pixels.
    pub fn new(quiet: bool, pixels: u32, plan: &Plan) -> Self {
        let style = match (quiet, on_terminal()) {
            (true, _) => Style::Quiet,
            (false, true) => Style::Bar(bar()),
            (false, false) => Style::Lines { next: Duration::ZERO },
        };
        let (limit, target) = (plan.time, plan.target_error);
        Self { style, pixels, planned: plan.total(), limit, target, begun: plan.begun, first: None }
    }

    /// A line that stays on the screen.
    pub fn message(&self, text: &str) {
        self.messenger()(text);
    }

    /// Shows such lines by itself, also while this is in use elsewhere.
    pub fn messenger(&self) -> Box<dyn Fn(&str)> {
        match &self.style {
            Style::Quiet => Box::new(|_| ()),
            Style::Bar(bar) => {
                let bar = bar.clone();
                Box::new(move |text| bar.println(text))
            }
            Style::Lines { .. } => Box::new(streams::message),
        }
    }

    /// Who sees the error.
    pub fn audience(&self) -> Audience {
        match self.style {
            Style::Quiet => Audience::Nobody,
            Style::Bar(_) | Style::Lines { .. } => Audience::Person,
        }
    }

    /// Tells of a round.
    pub fn observe(&mut self, progress: &Progress) {
        let first = *self.first.get_or_insert((progress.done, progress.elapsed));
        let (text, share) = (self.text(progress, first), self.share(progress));
        let tells_rate = progress.done > first.0 || progress.done == self.planned;
        match &mut self.style {
            Style::Quiet => {}
            Style::Bar(bar) => {
                bar.set_position(share);
                bar.set_message(text);
            }
            Style::Lines { next } => {
                if progress.elapsed >= *next && tells_rate {
                    streams::message(&text);
                    *next = progress.elapsed + LINE_EVERY;
                }
            }
        }
    }

    /// Takes the bar off the screen.
    pub fn finish(&self) {
        if let Style::Bar(bar) = &self.style {
            bar.finish_and_clear();
        }
    }

    #[expect(clippy::cast_precision_loss, reason = "for show")]
    fn text(&self, progress: &Progress, first: (u64, Duration)) -> String {
        let elapsed = progress.elapsed.as_secs_f64();
        let (samples, seconds) = match progress.done - first.0 {
            0 => {
                let earlier = self.begun.elapsed.as_secs_f64();
                (progress.done - self.begun.samples, elapsed - earlier)
            }
            samples => (samples, elapsed - first.1.as_secs_f64()),
        };
        let frames = samples as f64 / seconds.max(1e-9);
        let rate = frames * f64::from(self.pixels);
        let error = progress
            .summary
            .and_then(|summary| Some((summary.relative_error?, summary.samples)))
            // The look may be some samples old; the error falls with their square root.
            .map(|(error, at)| error * (at as f64 / progress.done as f64).sqrt())
            .map_or(String::new(), |error| format!(", error {:.2} %", 100.0 * error));
        let left = self.left(progress, frames);
        format!("{} spp, {}{error}, {left}", progress.done, units::rate(rate))
    }

    /// The time left, to the target if there is one and no limit comes first.
    #[expect(clippy::cast_precision_loss, reason = "for show")]
    fn left(&self, progress: &Progress, frames: f64) -> String {
        let by_samples = (self.planned - progress.done) as f64 / frames;
        let left = |limit: Duration| limit.saturating_sub(progress.elapsed).as_secs_f64();
        let limit = by_samples.min(self.limit.map_or(f64::INFINITY, left));
        let limited = format!("{} left", units::time(limit));
        let Some(target) = self.target else { return limited };
        let shown = units::percent(target);
        match self.needed(progress.summary.as_ref()) {
            None => format!("time to {shown} unknown"),
            Some(needed) => {
                let to_target = needed.saturating_sub(progress.done) as f64 / frames;
                if to_target <= limit {
                    format!("{} to {shown}", units::time(to_target))
                } else {
                    format!("{limited}, {} to {shown}", units::time(to_target))
                }
            }
        }
    }

    /// Samples per pixel that the target is predicted to take.
    fn needed(&self, summary: Option<&Summary>) -> Option<u64> {
        summary?.spread.samples_to(self.target?)
    }

    /// Thousandths of the render that are done.
    #[expect(
        clippy::cast_precision_loss,
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "for show"
    )]
    fn share(&self, progress: &Progress) -> u64 {
        let planned = self.needed(progress.summary.as_ref()).unwrap_or(self.planned);
        let samples = progress.done as f64 / planned.min(self.planned) as f64;
        let time = self.limit.map_or(0.0, |l| progress.elapsed.as_secs_f64() / l.as_secs_f64());
        (1000.0 * samples.max(time).min(1.0)) as u64
    }
}

/// A bar of thousandths with a message beside it.
pub(super) fn bar() -> ProgressBar {
    let bar = ProgressBar::with_draw_target(Some(1000), ProgressDrawTarget::stderr());
    let style = ProgressStyle::with_template("{bar:30} {percent:>3}%  {msg}")
        .expect("the template is a constant");
    bar.set_style(style);
    bar
}

#[cfg(test)]
mod tests {
    use super::Reporter;
    use crate::film::SampleRanges;
    use crate::render::{Begun, Plan, Progress};
    use std::time::Duration;

    /// What is said of a render that goes on from 1000 samples, which took 100 s, at ten times the
    /// rate, `rounds` of 10 samples later.
    fn said(time: Option<u64>, rounds: u64) -> String {
        let plan = Plan {
            begun: Begun { samples: 1000, elapsed: Duration::from_secs(100), next_look: None },
            ranges: SampleRanges::default().missing(&(1000..7000)),
            time: time.map(Duration::from_secs),
            target_error: None,
        };
        let mut reporter = Reporter::new(true, 1, &plan);
        let progress = |rounds: u64| Progress {
            done: 1000 + 10 * rounds,
            elapsed: Duration::from_secs(100) + Duration::from_millis(100 * rounds),
            next_look: None,
            summary: None,
        };
        (1..=rounds).for_each(|rounds| reporter.observe(&progress(rounds)));
        reporter.text(&progress(rounds), reporter.first.expect("a round"))
    }

    /// The time left is that of this run's rate from its first round on: what was there before was
    /// made at another one, and is not traced again.
    #[test]
    fn the_time_left_is_right_after_resuming() {
        assert_eq!(said(None, 1), "1010 spp, 0.1 ksamples/s, 60 s left");
        assert_eq!(said(None, 2), "1020 spp, 0.1 ksamples/s, 60 s left");
        // The limit counts what was spent before.
        assert_eq!(said(Some(130), 1), "1010 spp, 0.1 ksamples/s, 30 s left");
    }
}
