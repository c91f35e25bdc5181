//! `cost.csv`: every number of a study, one in each row.

use super::{CostReport, MARK};
use crate::cost::{EstimatorCost, Measured, Study};
use csv::Writer;

/// A table of (part, subject, at, quantity, unit, value, low, high): `at` is the target of a
/// prediction, the samples of a convergence point or a picture, or the bounces of a rung;
/// low and high are the ends of the 95 % interval.
pub(super) fn table(report: &CostReport) -> Result<Vec<u8>, String> {
    let mut rows = Rows(Writer::from_writer(Vec::new()));
    let columns = ["part", "subject", "at", "quantity", "unit", "value", "low", "high"];
    rows.0.write_record(columns).map_err(|error| error.to_string())?;
    let about = [
        ("report", format!("{MARK} {}", env!("CARGO_PKG_VERSION"))),
        ("scene", report.scene.to_owned()),
        ("device", report.tracer.device.clone()),
        ("driver", report.tracer.driver.clone()),
    ];
    for (name, value) in about {
        rows.text(["study", "", "", name, ""], &value)?;
    }
    study(&mut rows, report.study)?;
    rows.0.into_inner().map_err(|error| error.to_string())
}

struct Rows(Writer<Vec<u8>>);

impl Rows {
    fn text(&mut self, labels: [&str; 5], value: &str) -> Result<(), String> {
        let record = labels.into_iter().chain([value, "", ""]);
        self.0.write_record(record).map_err(|error| error.to_string())
    }

    fn number(&mut self, labels: [&str; 5], value: f64) -> Result<(), String> {
        self.text(labels, &value.to_string())
    }

    fn measured(&mut self, labels: [&str; 5], m: &Measured) -> Result<(), String> {
        let numbers = [m.value, m.low, m.high].map(|x| x.to_string());
        let record = labels.into_iter().chain(numbers.iter().map(String::as_str));
        self.0.write_record(record).map_err(|error| error.to_string())
    }
}

fn study(rows: &mut Rows, study: &Study) -> Result<(), String> {
    let about = [
        ("width", "pixels", f64::from(study.width)),
        ("height", "pixels", f64::from(study.height)),
        ("bounces", "", f64::from(study.bounces)),
        ("seed", "", f64::from(study.seed)),
        ("budget", "s", study.budget_seconds),
        ("spent", "s", study.seconds),
    ];
    for (name, unit, value) in about {
        rows.number(["study", "", "", name, unit], value)?;
    }
    for cost in &study.estimators {
        estimator(rows, cost)?;
    }
    for rung in &study.ladder {
        let labels = |quantity, unit| ["ladder", rung.estimator.name(), "", quantity, unit];
        let at = rung.bounces.to_string();
        let at = |quantity, unit| with_at(labels(quantity, unit), &at);
        rows.measured(at("seconds_per_sample", "s"), &rung.seconds_per_sample)?;
        if let Some(missing) = &rung.missing {
            rows.measured(at("missing_light", "1"), missing)?;
        }
        if let Some(seconds) = rung.seconds_to_one_percent {
            rows.number(at("seconds_to_one_percent", "s"), seconds)?;
        }
    }
    if let Some(twin) = &study.twin {
        let at = |quantity, unit| ["twin", twin.estimator.name(), "", quantity, unit];
        rows.measured(at("device_seconds_per_sample", "s"), &twin.device_seconds_per_sample)?;
        rows.measured(at("twin_seconds_per_sample", "s"), &twin.twin_seconds_per_sample)?;
        rows.measured(at("slowdown", "1"), &twin.slowdown)?;
        let channels = ["bias_r", "bias_g", "bias_b"].into_iter();
        let biases = twin.bias.into_iter().flatten().zip(twin.bias_error.into_iter().flatten());
        for (name, (bias, error)) in channels.zip(biases) {
            rows.measured(at(name, "1"), &Measured::around(bias, 1.96 * error))?;
        }
    }
    for strip in &study.strips {
        for picture in &strip.pictures {
            let at = picture.samples.to_string();
            let labels = |quantity, unit| ["strip", strip.estimator.name(), &at, quantity, unit];
            rows.number(labels("seconds", "s"), picture.seconds)?;
            if let Some(error) = picture.relative_error {
                rows.number(labels("relative_error", "1"), error)?;
            }
        }
    }
    for left_out in &study.left_out {
        rows.text(["left_out", &left_out.what, "", "reason", ""], &left_out.why)?;
    }
    Ok(())
}

fn with_at<'a>(mut labels: [&'a str; 5], at: &'a str) -> [&'a str; 5] {
    labels[2] = at;
    labels
}

#[expect(clippy::cast_precision_loss, reason = "counts of samples and pixels")]
fn estimator(rows: &mut Rows, cost: &EstimatorCost) -> Result<(), String> {
    let name = cost.estimator.name();
    let labels = |quantity, unit| ["estimator", name, "", quantity, unit];
    rows.number(labels("samples_per_pixel", "1"), cost.samples as f64)?;
    rows.measured(labels("seconds_per_sample", "s"), &cost.seconds_per_sample)?;
    rows.number(labels("unproven_pixels", "1"), cost.unproven_pixels as f64)?;
    rows.number(labels("varying_pixels", "1"), cost.varying_pixels)?;
    if let Some(noise) = &cost.noise {
        rows.measured(labels("relative_variance", "1"), &noise.variance)?;
        if let Some(efficiency) = &noise.efficiency {
            rows.measured(labels("efficiency", "1/s"), efficiency)?;
        }
    }
    if let Some(slope) = &cost.slope {
        rows.measured(labels("slope", "1"), &slope.slope)?;
    }
    if let Some(agreement) = &cost.agreement {
        rows.measured(labels("realised_over_stated_error", "1"), &agreement.ratio)?;
    }
    if let Some(ratio) = &cost.beside_cheapest {
        rows.measured(labels("time_beside_cheapest", "1"), ratio)?;
    }
    for point in &cost.convergence {
        let at = point.samples.to_string();
        let labels = ["convergence", name, &at, "relative_error", "1"];
        rows.measured(labels, &point.interval())?;
    }
    for prediction in &cost.predictions {
        let at = prediction.target.to_string();
        let labels = |quantity| ["prediction", name, &at, quantity, "s"];
        rows.measured(labels("predicted_seconds"), &prediction.seconds)?;
        if let Some(seconds) = prediction.measured {
            rows.number(labels("measured_seconds"), seconds)?;
        }
    }
    Ok(())
}
