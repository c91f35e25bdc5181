//! `candor verify --hard`: the scale sweep on this machine's device.

use super::args::{EstimatorChoice, VerifyArgs};
use super::progress::bar;
use super::{DONE, FAILED, INTERRUPTED, Refusal, interrupt, on_terminal, streams, verify};
use crate::cpu::CpuTracer;
use crate::scene::{Estimator, Scene};
use crate::sweep::{Case, RESOLVED, Row, cases, measure};
use crate::tracer::{Description, TraceError, Tracer};
use crate::verify::MAX_BIAS;
use indicatif::ProgressBar;
use serde::Serialize;

/// The estimators that are swept where none is named: the source's, and the one that
/// samples lights and surfaces.
const SWEPT: [Estimator; 2] = [Estimator::Implicit, Estimator::Mis];

/// One row of the table.
struct Line<'a> {
    case: &'a Case,
    estimator: Estimator,
    row: Row,
}

pub(super) fn run(args: &VerifyArgs) -> Result<u8, Refusal> {
    // `verify` has refused `auto` before.
    let estimators = match args.sampling.estimator {
        Some(EstimatorChoice::Named(estimator)) => vec![estimator],
        Some(EstimatorChoice::Auto) | None => SWEPT.to_vec(),
    };
    let common = &args.common;
    let (chosen, device) = verify::device(common)?;
    let interrupt = interrupt::watch()?;
    let on_device = |scene: &Scene| chosen.tracer(scene);
    let on_twin = |scene: &Scene| -> Result<Box<dyn Tracer>, TraceError> {
        Ok(Box::new(CpuTracer::new(scene, common.threads)?))
    };
    let cases = cases()?;
    let suited = |case| estimators.iter().filter(move |e| Case::suits(case, **e));
    let rows: Vec<(&Case, Estimator)> =
        cases.iter().flat_map(|case| suited(case).map(move |&e| (case, e))).collect();
    let shown = Shown::new(common.quiet, rows.len());
    let mut table = Table { lines: Vec::new(), interrupted: false };
    for (case, estimator) in rows {
        shown.tell(case, estimator);
        let Some(row) = measure(case, estimator, &on_device, &on_twin, interrupt)? else {
            table.interrupted = true;
            break;
        };
        table.lines.push(Line { case, estimator, row });
    }
    shown.finish();
    let report = if common.json { json(&table, &device) } else { text(&table, &device) };
    streams::results(&report)?;
    Ok(match table {
        Table { interrupted: true, .. } => INTERRUPTED,
        _ if table.agrees() => DONE,
        _ => FAILED,
    })
}

/// What was measured.
struct Table<'a> {
    lines: Vec<Line<'a>>,
    /// Whether rows are missing.
    interrupted: bool,
}

impl Table<'_> {
    fn agrees(&self) -> bool {
        !self.interrupted && self.lines.iter().all(|line| line.row.is_right())
    }
}

/// Progress: a bar on a terminal, nothing elsewhere.
struct Shown {
    bar: Option<ProgressBar>,
}

impl Shown {
    fn new(quiet: bool, rows: usize) -> Self {
        let bar = (!quiet && on_terminal()).then(bar);
        if let Some(bar) = &bar {
            bar.set_length(rows as u64);
        }
        Self { bar }
    }

    fn tell(&self, case: &Case, estimator: Estimator) {
        if let Some(bar) = &self.bar {
            bar.inc(1);
            bar.set_message(format!("{} {}, {}", case.group, case.value, estimator.name()));
        }
    }

    fn finish(&self) {
        if let Some(bar) = &self.bar {
            bar.finish_and_clear();
        }
    }
}

fn verdict(row: &Row) -> &'static str {
    if row.is_right() {
        "ok"
    } else if row.invalid > 0 {
        "INVALID SAMPLES"
    } else if row.is_wrong() {
        "WRONG"
    } else {
        "not resolved"
    }
}

fn text(table: &Table<'_>, device: &Description) -> String {
    let lines = &table.lines;
    let mut out = vec![
        format!("device    {} ({})", device.device, device.driver),
        "bias of the image mean against the f64 twin, (device - twin)/twin; same random numbers,"
            .to_owned(),
        "± one standard error; the channel that is off most".to_owned(),
        String::new(),
        format!("{:<14}{:<9}{:<10}{:>12}{:>11}{:>10}", "", "", "estimator", "samples", "bias", "±"),
    ];
    let mut group = "";
    for line in lines {
        let (bias, error) = line.row.worst();
        let shown = if line.case.group == group { "" } else { line.case.group };
        group = line.case.group;
        out.push(format!(
            "{shown:<14}{:<9}{:<10}{:>12}{:>+11.1e}{:>10.0e}   {}",
            line.case.value,
            line.estimator.name(),
            line.row.paths(),
            bias,
            error,
            verdict(&line.row)
        ));
    }
    let right = lines.iter().filter(|line| line.row.is_right()).count();
    let reading = if table.interrupted {
        format!("interrupted; the device agrees with the twin in {right} of {} rows", lines.len())
    } else if right == lines.len() {
        format!("the device agrees with the twin in all {right} rows")
    } else {
        format!("THE DEVICE FAILS in {} of {} rows", lines.len() - right, lines.len())
    };
    out.push(String::new());
    out.push(format!(
        "verdict   {reading} (bias limit {:.1} %, known to {:.3} %)",
        100.0 * MAX_BIAS,
        100.0 * RESOLVED
    ));
    out.join("\n")
}

/// The `--json` object.
#[derive(Serialize)]
struct Json<'a> {
    device: &'a str,
    driver: &'a str,
    agrees: bool,
    interrupted: bool,
    bias_limit: f64,
    rows: Vec<JsonRow<'a>>,
}

#[derive(Serialize)]
struct JsonRow<'a> {
    group: &'a str,
    value: &'a str,
    estimator: &'static str,
    samples: u64,
    bias: [f64; 3],
    bias_error: [f64; 3],
    invalid_samples: u64,
    verdict: &'static str,
}

impl<'a> JsonRow<'a> {
    fn of(line: &Line<'a>) -> Self {
        Self {
            group: line.case.group,
            value: &line.case.value,
            estimator: line.estimator.name(),
            samples: line.row.paths(),
            bias: line.row.paired.bias,
            bias_error: line.row.paired.error,
            invalid_samples: line.row.invalid,
            verdict: verdict(&line.row),
        }
    }
}

fn json(table: &Table<'_>, device: &Description) -> String {
    let json = Json {
        device: &device.device,
        driver: &device.driver,
        agrees: table.agrees(),
        interrupted: table.interrupted,
        bias_limit: MAX_BIAS,
        rows: table.lines.iter().map(JsonRow::of).collect(),
    };
    serde_json::to_string(&json).expect("plain values serialize")
}
