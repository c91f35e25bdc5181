//! The tables of `candor cost` on the terminal.

use crate::cost::{Study, TARGETS};
use crate::report::cost::CostReport;
use crate::report::cost::cells::{efficiency, missing_light, relative, unpredicted, variance};
use crate::units::{rounded_percent, short_time, significant};

/// Width that answers are wrapped to.
const WIDTH: usize = 96;

/// Everything that a study found, as text.
pub(super) fn tables(report: &CostReport) -> String {
    let study = report.study;
    let mut parts = vec![title(report), estimators(study), predictions(study)];
    if !study.ladder.is_empty() {
        parts.push(ladder(study));
    }
    parts.extend(report.answers().iter().map(|answer| {
        let mark = if answer.warning { "WARNING: " } else { "" };
        format!("{}\n{}", answer.question, wrapped(&format!("{mark}{}", answer.text)))
    }));
    parts.extend(
        study
            .left_out
            .iter()
            .map(|left_out| wrapped(&format!("not measured: {}: {}", left_out.what, left_out.why))),
    );
    parts.join("\n\n")
}

fn title(report: &CostReport) -> String {
    let study = report.study;
    format!(
        "{}, {}x{}, {} bounces, on {}: {} of {}{}",
        report.scene,
        study.width,
        study.height,
        study.bounces,
        report.tracer.device,
        short_time(study.seconds),
        short_time(study.budget_seconds),
        if study.interrupted { ", interrupted" } else { "" },
    )
}

fn estimators(study: &Study) -> String {
    let head = ["estimator", "Msamples/s", "variance", "efficiency", "slope", "unproven pixels"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for cost in &study.estimators {
        let seconds = &cost.seconds_per_sample;
        rows.push(vec![
            cost.estimator.name().to_owned(),
            relative(seconds, &significant(1e-6 / seconds.value, 3)),
            variance(cost),
            efficiency(cost, "/s"),
            cost.slope.map_or("-".to_owned(), |slope| {
                format!("{:.3} .. {:.3}", slope.slope.low, slope.slope.high)
            }),
            cost.unproven_pixels.to_string(),
        ]);
    }
    aligned(&rows)
}

fn predictions(study: &Study) -> String {
    let mut head = vec!["time to (measured)".to_owned()];
    head.extend(TARGETS.map(|target| rounded_percent(target, 1)));
    let mut rows = vec![head];
    for cost in &study.estimators {
        let mut row = vec![cost.estimator.name().to_owned()];
        if cost.predictions.is_empty() {
            row.extend(TARGETS.map(|_| unpredicted(cost).to_owned()));
        }
        row.extend(cost.predictions.iter().map(|prediction| {
            let seconds = short_time(prediction.seconds.value);
            match prediction.measured {
                Some(measured) => format!("{seconds} ({})", short_time(measured)),
                None => seconds,
            }
        }));
        rows.push(row);
    }
    aligned(&rows)
}

fn ladder(study: &Study) -> String {
    let head = ["bounces", "ns/sample", "light missing", "time to 1 %"];
    let mut rows = vec![head.map(str::to_owned).to_vec()];
    for rung in &study.ladder {
        let seconds = &rung.seconds_per_sample;
        rows.push(vec![
            rung.bounces.to_string(),
            relative(seconds, &significant(1e9 * seconds.value, 3)),
            missing_light(rung, study),
            rung.seconds_to_one_percent.map_or("unproven".to_owned(), short_time),
        ]);
    }
    aligned(&rows)
}

/// Columns side by side, the first flush left, the others flush right.
fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| {
        rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max()
    };
    let widths: Vec<usize> = (0..columns).filter_map(width).collect();
    let line = |row: &Vec<String>| {
        let cells = row.iter().zip(&widths).enumerate().map(|(column, (cell, &width))| {
            if column == 0 { format!("{cell:<width$}") } else { format!("{cell:>width$}") }
        });
        cells.collect::<Vec<_>>().join("   ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

/// Text in lines of at most [`WIDTH`] characters, indented.
fn wrapped(text: &str) -> String {
    let mut lines = vec![String::new()];
    for word in text.split(' ') {
        let last = lines.last_mut().expect("starts with one line");
        if !last.is_empty() && last.chars().count() + 1 + word.chars().count() > WIDTH {
            lines.push(word.to_owned());
        } else {
            last.push_str(if last.is_empty() { "" } else { " " });
            last.push_str(word);
        }
    }
    lines.iter().map(|line| format!("  {line}")).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::{WIDTH, aligned, wrapped};

    #[test]
    fn columns_are_aligned() {
        let rows = [["a", "1 ± 2"], ["long", "3"]].map(|row| row.map(str::to_owned).to_vec());
        assert_eq!(aligned(&rows), "a      1 ± 2\nlong       3");
    }

    #[test]
    fn long_text_is_wrapped() {
        let text = "word ".repeat(50);
        let wrapped = wrapped(text.trim_end());
        assert!(wrapped.lines().all(|line| line.chars().count() <= WIDTH + 2), "{wrapped}");
        assert_eq!(wrapped.split_whitespace().count(), 50);
    }
}
