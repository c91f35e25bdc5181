//! What `candor explain` says on the terminal, in lines of at most 80 characters.

use super::explain::{Explained, Measurement};
use crate::cost;
use crate::explain::{Account, Agreement, Explanation, Facts, Measured, Saving};
use crate::tracer::Description;
use crate::units::{bytes, rounded_percent, significant};

/// Longest line.
const WIDTH: usize = 80;

/// Width of the column of labels, the space before and after it included.
const LABEL: usize = 26;

/// Width of a column of the two kernels.
const COLUMN: usize = 26;

pub(super) fn text(explained: &Explained) -> String {
    let Explanation { effects, specialised, general } = &explained.explanation;
    let measured = match &explained.measurement {
        Measurement::Made(_, measured) => Some(measured.as_ref()),
        Measurement::None(_) => None,
    };
    let mut sections = vec![
        title(explained),
        section("effects called for", effects.iter().filter(|effect| effect.called_for)),
        section("effects left out", effects.iter().filter(|effect| !effect.called_for)),
        choices(specialised, general),
        kernels(specialised, general, measured),
    ];
    sections.push(match &explained.measurement {
        Measurement::Made(device, measured) => findings(device, measured),
        Measurement::None(why) => wrapped(&format!("not timed: {why}"), 0),
    });
    sections.join("\n\n")
}

fn title(explained: &Explained) -> String {
    let (size, settings) = (explained.scene.size(), explained.scene.settings());
    wrapped(
        &format!(
            "{}: {}, {}, bounces: {}, spheres: {}",
            explained.file,
            size,
            settings.estimator().name(),
            settings.bounces(),
            explained.scene.spheres().len()
        ),
        0,
    )
}

fn section<'a>(heading: &str, accounts: impl Iterator<Item = &'a Account>) -> String {
    let rows = accounts.map(|account| row(account.effect, &account.sentence()));
    let rows: Vec<String> = rows.collect();
    if rows.is_empty() {
        return format!("{heading}: none");
    }
    format!("{heading}\n{}", rows.join("\n"))
}

/// A label, and a text beside it that goes on under its own beginning.
fn row(label: &str, text: &str) -> String {
    let text = wrapped(text, LABEL);
    format!("{:LABEL$}{}", format!("  {label}"), text.trim_start())
}

fn choices(specialised: &Facts, general: &Facts) -> String {
    let pair = |label: &str, ours: &str, theirs: &str| {
        [row(label, ours), row("  general kernel", theirs)].join("\n")
    };
    [
        "choices".to_owned(),
        pair("search for a hit", &specialised.search, &general.search),
        pair("paths", &specialised.paths, &general.paths),
        pair("buffers of the spheres", &specialised.buffers, &general.buffers),
    ]
    .join("\n")
}

fn kernels(specialised: &Facts, general: &Facts, measured: Option<&Measured>) -> String {
    let columns = |label: &str, [ours, theirs]: [String; 2]| {
        format!("{:LABEL$}{ours:>COLUMN$}{theirs:>COLUMN$}", format!("  {label}"))
    };
    let both = [specialised, general];
    let mut lines = vec![
        format!("{:LABEL$}{:>COLUMN$}{:>COLUMN$}", "kernel", "specialised", "general"),
        columns("WGSL", both.map(|facts| bytes(facts.wgsl_bytes as u64))),
        columns("functions", both.map(|facts| facts.functions.to_string())),
        columns("SPIR-V", both.map(|facts| bytes(facts.spirv_bytes as u64))),
    ];
    if let Some(measured) = measured {
        lines.push(columns("compile time", measured.compile_seconds.map(time)));
        lines.push(columns("time per sample", measured.seconds_per_sample.map(time)));
    }
    lines.push("on the device".to_owned());
    lines.extend(parts(both).into_iter().map(|(label, pair)| columns(label, pair)));
    lines.push(columns("in all", both.map(|facts| bytes(facts.total_device_bytes()))));
    lines.join("\n")
}

/// Every buffer that either kernel needs.
fn parts(both: [&Facts; 2]) -> Vec<(&'static str, [String; 2])> {
    let mut labels: Vec<&'static str> = Vec::new();
    for (label, _) in both.iter().rev().flat_map(|facts| &facts.device_bytes) {
        if !labels.contains(label) {
            labels.push(label);
        }
    }
    let of = |facts: &Facts, label| {
        let found = facts.device_bytes.iter().find(|(other, _)| *other == label);
        found.map_or("-".to_owned(), |&(_, count)| bytes(count))
    };
    labels.into_iter().map(|label| (label, both.map(|facts| of(facts, label)))).collect()
}

/// Seconds with the ends of their interval, in the smallest unit of which they are not many.
fn time(seconds: cost::Measured) -> String {
    const UNITS: [(f64, &str); 3] = [(1e9, "ns"), (1e6, "µs"), (1e3, "ms")];
    let fits = |&&(scale, _): &&(f64, &str)| seconds.high * scale < 1e4;
    let &(scale, unit) = UNITS.iter().find(fits).unwrap_or(&(1.0, "s"));
    interval(seconds.scaled(scale), unit)
}

/// A value with the ends of its interval.
fn interval(measured: cost::Measured, unit: &str) -> String {
    let [value, low, high] =
        [measured.value, measured.low, measured.high].map(|value| significant(value, 3));
    format!("{value} ({low} .. {high}) {unit}")
}

fn findings(device: &Description, measured: &Measured) -> String {
    let Measured { width, height, spp, rounds, compilations, .. } = measured;
    [
        row_of_finding("device", &format!("{} ({})", device.device, device.driver)),
        row_of_finding(
            "measured",
            &format!(
                "{rounds} rounds in turns at {width}x{height}, {spp} samples per pixel: medians \
                 with 95\u{a0}% intervals; fresh compilations of each up to the end \
                 of the first dispatch, {compilations} in all: medians with extremes"
            ),
        ),
        row_of_finding("films", &films(measured)),
        row_of_finding("saving", &saving(measured)),
    ]
    .join("\n")
}

fn row_of_finding(label: &str, text: &str) -> String {
    const LABEL: usize = 10;
    format!("{label:LABEL$}{}", wrapped(text, LABEL).trim_start())
}

fn films(measured: &Measured) -> String {
    let found = match measured.films {
        Agreement::SameBits => "the same bits",
        Agreement::UpToRounding => "the same up to rounding, not the same bits",
        Agreement::Differ => "THEY DIFFER: one of the kernels is wrong",
    };
    match measured.invalid_samples {
        [0, 0] => found.to_owned(),
        [ours, general] => format!("{found}; INVALID SAMPLES: {ours} and {general}"),
    }
}

fn saving(measured: &Measured) -> String {
    let share = |share: cost::Measured| {
        let [value, low, high] =
            [share.value, share.low, share.high].map(|share| rounded_percent(share, 2));
        format!("{value} ({low} .. {high})")
    };
    match measured.saving {
        Saving::Saves(of) => format!("{} of the general kernel's time", share(of)),
        Saving::Costs(of) => {
            format!("none: it takes longer than the general one, by {}", share(of))
        }
        Saving::None => {
            let ratio = interval(measured.ratio, "");
            format!("none (inside the noise: specialised/general {})", ratio.trim_end())
        }
    }
}

/// Text in lines that begin after `indent` characters; no line ends at a no-break space.
fn wrapped(text: &str, indent: usize) -> String {
    let mut lines: Vec<String> = vec![" ".repeat(indent)];
    for word in text.split(' ') {
        let line = lines.last_mut().expect("starts with one line");
        let length = line.chars().count();
        if length > indent && length + 1 + word.chars().count() > WIDTH {
            lines.push(format!("{}{word}", " ".repeat(indent)));
        } else {
            line.push_str(if length > indent { " " } else { "" });
            line.push_str(word);
        }
    }
    lines.join("\n").replace('\u{a0}', " ")
}

#[cfg(test)]
mod tests {
    use super::{COLUMN, time, wrapped};
    use crate::cost::Measured;

    #[test]
    fn times_fit_their_column() {
        let table = [
            (82.4e-9, "82.4 (80.3 .. 84.5) ns"),
            (1.33e-3, "1330 (1297 .. 1363) µs"),
            (2.677, "2677 (2610 .. 2744) ms"),
            (75.0, "75.0 (73.1 .. 76.9) s"),
        ];
        for (seconds, text) in table {
            let shown = time(Measured::around(seconds, 0.025 * seconds));
            assert_eq!(shown, text);
            assert!(shown.chars().count() < COLUMN);
        }
    }

    #[test]
    fn lines_do_not_end_at_a_no_break_space() {
        let text = format!("{} 95\u{a0}%", "x".repeat(76));
        assert_eq!(wrapped(&text, 0), format!("{}\n95 %", "x".repeat(76)));
    }
}
