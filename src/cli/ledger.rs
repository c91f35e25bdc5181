//! The invalid samples of a render, as the commands that trace them again.

use super::args::{DeviceChoice, RenderArgs};
use crate::scene::Scene;
use crate::tracer::{InvalidSample, Ledger};
use serde::Serialize;

/// An invalid sample in `--json`.
#[derive(Serialize)]
pub(super) struct Record {
    /// Column and row, from the top left.
    pixel: [u32; 2],
    sample: u64,
    reason: &'static str,
    replay: String,
}

/// What `--json` says of the invalid samples that were recorded.
pub(super) fn records(args: &RenderArgs, scene: &Scene, ledger: &Ledger) -> Vec<Record> {
    let record = |sample: &InvalidSample| Record {
        pixel: place(scene, sample),
        sample: sample.index,
        reason: sample.reason.name(),
        replay: command(args, scene, sample),
    };
    ledger.records.iter().map(record).collect()
}

/// What people are told: one command a line, which a shell takes as it stands.
pub(super) fn lines(args: &RenderArgs, scene: &Scene, ledger: &Ledger) -> Vec<String> {
    if ledger.count == 0 {
        return Vec::new();
    }
    let recorded = ledger.records.len();
    let which = match usize::try_from(ledger.count) {
        Ok(count) if count == recorded => "traced again by:".to_owned(),
        _ => format!("the first {recorded} are traced again by:"),
    };
    let samples =
        if ledger.count == 1 { "sample counts as zero" } else { "samples count as zeros" };
    let mut lines = vec![format!("{} invalid {samples}; {which}", ledger.count)];
    lines.extend(ledger.records.iter().map(|sample| {
        let command = command(args, scene, sample);
        format!("{command}  # {}", sample.reason)
    }));
    lines
}

fn place(scene: &Scene, sample: &InvalidSample) -> [u32; 2] {
    let width = scene.size().width();
    [sample.pixel % width, sample.pixel / width]
}

/// The command that traces the sample again: what the render was told, and the address.
fn command(args: &RenderArgs, scene: &Scene, sample: &InvalidSample) -> String {
    let (common, settings) = (&args.common, scene.settings());
    let mut words = vec![format!("candor replay {}", quoted(&args.scene.to_string_lossy()))];
    if args.sampling.estimator.is_some() {
        words.push(format!("--estimator {}", settings.estimator().name()));
    }
    words.extend(common.bounces.map(|bounces| format!("--bounces {bounces}")));
    words.extend(common.seed.map(|seed| format!("--seed {seed}")));
    words.extend(common.size.map(|size| format!("--size {size}")));
    words.extend(match &common.device {
        DeviceChoice::Auto => None,
        DeviceChoice::Gpu => Some("--device gpu".to_owned()),
        DeviceChoice::Cpu => Some("--device cpu".to_owned()),
        DeviceChoice::Named(name) => Some(format!("--device {}", quoted(name))),
    });
    let [column, row] = place(scene, sample);
    words.push(format!("--pixel {column},{row} --sample {}", sample.index));
    words.join(" ")
}

/// A word as a shell takes it.
fn quoted(word: &str) -> String {
    let is_plain = |c: char| c.is_ascii_alphanumeric() || "_./=,:@%+-".contains(c);
    if !word.is_empty() && word.chars().all(is_plain) {
        return word.to_owned();
    }
    format!("'{}'", word.replace('\'', r"'\''"))
}

#[cfg(test)]
mod tests {
    use super::super::args::{Cli, Command, RenderArgs};
    use super::super::render_report::Finished;
    use super::super::{DONE, FAILED, INTERRUPTED};
    use super::{lines, quoted, records};
    use crate::bound::sample_scale;
    use crate::estimate::summarize;
    use crate::film::{Film, Identity, SampleRanges};
    use crate::render::{Outcome, Stop};
    use crate::report::{Origin, PictureHeader, Sums, write_exr};
    use crate::scene::{Camera, ImageSize, Radiance, RenderSettings, Scene, Sphere, Surface};
    use crate::tracer::{Description, InvalidReason, InvalidSample, Ledger};
    use clap::Parser;
    use glam::DVec3;
    use std::time::Duration;

    fn arguments(typed: &str) -> RenderArgs {
        let words = ["candor", "render"].into_iter().chain(typed.split_whitespace());
        match Cli::parse_from(words).command {
            Command::Render(args) => args,
            other => panic!("{other:?}"),
        }
    }

    fn scene() -> Scene {
        let camera = Camera::new(DVec3::ZERO, DVec3::X, DVec3::Z, 60.0).expect("a camera");
        let light = Surface::Emitter(Radiance::new(DVec3::splat(10.0)).expect("a radiance"));
        let spheres = vec![Sphere::new(DVec3::ZERO, 1.0, light).expect("a sphere")];
        let size = ImageSize::new(7, 5).expect("a size");
        Scene::new(camera, size, RenderSettings::default(), spheres)
    }

    /// A render that met one invalid sample for each reason.
    fn finished(reasons: &[InvalidReason], stop: Stop) -> Finished {
        let scene = scene();
        let mut samples = SampleRanges::default();
        samples.insert(0..4).expect("four samples");
        let film = Film::awaiting(scene.size(), sample_scale(&scene), samples);
        let records = (16..).zip(reasons).map(|(pixel, &reason)| InvalidSample {
            pixel,
            index: u64::from(pixel) << 40,
            reason,
        });
        Finished {
            summary: summarize(&film),
            film,
            ledger: Ledger { count: reasons.len() as u64, records: records.collect() },
            outcome: Outcome { stop, elapsed: Duration::from_secs(1), next_look: None },
            origin: Origin {
                scene_file: "s.toml".to_owned(),
                identity: Identity::of(&scene, sample_scale(&scene)),
                dark: true,
                tracer: Description { device: "a".into(), driver: "b".into(), software: true },
            },
            target: None,
            aside: None,
            log_error: None,
            scene,
        }
    }

    const REASONS: [InvalidReason; 5] = [
        InvalidReason::NotANumber,
        InvalidReason::Infinite,
        InvalidReason::Negative,
        InvalidReason::AboveBound,
        InvalidReason::Unfinished,
    ];

    /// Any reason fails a strict render, none does another; an interruption says so first.
    #[test]
    fn strict_renders_fail_by_invalid_samples() {
        let (strict, lax) = (arguments("s.toml --strict"), arguments("s.toml"));
        for reason in REASONS {
            let done = finished(&[reason], Stop::Done);
            assert_eq!((done.code(&strict), done.code(&lax)), (FAILED, DONE), "{reason:?}");
            assert_eq!(finished(&[reason], Stop::Time).code(&strict), FAILED);
            assert_eq!(finished(&[reason], Stop::Interrupted).code(&strict), INTERRUPTED);
        }
        assert_eq!(finished(&[], Stop::Done).code(&strict), DONE);
    }

    /// The header counts invalid samples, and has address and reason of each.
    #[test]
    fn the_header_has_the_ledger() {
        let folder = tempfile::TempDir::new().expect("a temporary folder");
        let header = |reasons: &[InvalidReason]| {
            let (path, render) = (folder.path().join("a.exr"), finished(reasons, Stop::Done));
            let sums = Sums::Compact(&render.film);
            write_exr(&path, &render.picture(), sums, &render.provenance()).expect("an EXR");
            PictureHeader::read(&path).expect("candor's own file")
        };
        let clean = header(&[]);
        assert_eq!((clean.invalid_samples, clean.invalid_records), (Some(0), None));
        let faulty = header(&REASONS);
        assert_eq!(faulty.invalid_samples, Some(5));
        let expected = "2,2 17592186044416 nan; 3,2 18691697672192 infinite; 4,2 19791209299968 \
                        negative; 5,2 20890720927744 above-bound; 6,2 21990232555520 unfinished";
        assert_eq!(faulty.invalid_records.as_deref(), Some(expected));
    }

    /// What is printed is a command that replays the sample as it was rendered.
    #[test]
    fn lines_are_commands() {
        let args =
            arguments("s.toml --seed 5 --bounces 3 --size 7x5 --estimator auto --device cpu");
        let render = finished(&REASONS[..1], Stop::Done);
        let [first, second] = &lines(&args, &render.scene, &render.ledger)[..] else {
            panic!("two lines")
        };
        assert_eq!(first, "1 invalid sample counts as zero; traced again by:");
        let command = "candor replay s.toml --estimator implicit --bounces 3 --seed 5 --size 7x5 \
                       --device cpu --pixel 2,2 --sample 17592186044416";
        assert_eq!(second, &format!("{command}  # NaN"));
        let Command::Replay(replay) = Cli::parse_from(command.split_whitespace()).command else {
            panic!("a replay")
        };
        assert_eq!((replay.pixel, replay.sample), ((2, 2), 16 << 40));
        let json = serde_json::to_value(records(&args, &render.scene, &render.ledger));
        let json = json.expect("plain values serialize");
        assert_eq!((&json[0]["reason"], &json[0]["pixel"][0]), (&"nan".into(), &2.into()));
        assert_eq!(json[0]["replay"], command);
    }

    #[test]
    fn words_are_quoted_for_a_shell() {
        for (word, expected) in
            [("a/b.toml", "a/b.toml"), ("a b", "'a b'"), ("it's", r"'it'\''s'"), ("", "''")]
        {
            assert_eq!(quoted(word), expected);
        }
    }
}
