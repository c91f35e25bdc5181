//! `cost.html`: the report to read, in one file without scripts.

use super::cells::{efficiency, missing_light, relative, unpredicted, variance};
use super::{CostReport, MARK, reading};
use crate::cost::{EstimatorCost, Measured, Strip, Study, TARGETS};
use crate::report::{Picture, png};
use crate::units::{rounded_percent, short_time, significant};
use base64::Engine;
use base64::prelude::BASE64_STANDARD;
use maud::{DOCTYPE, Markup, PreEscaped, html};

/// Colours for a light and a dark screen; the plot takes part through its attributes.
const STYLE: &str = include_str!("style.css");

pub(super) fn page(report: &CostReport, plot: &str) -> Result<String, String> {
    let study = report.study;
    let strips = study.strips.iter().map(strip).collect::<Result<Vec<Markup>, String>>()?;
    let generator = format!("{MARK} {}", env!("CARGO_PKG_VERSION"));
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="generator" content=(generator);
                meta name="viewport" content="width=device-width, initial-scale=1";
                title { "What accuracy costs: " (report.scene) }
                style { (PreEscaped(STYLE)) }
            }
            body {
                h1 { "What accuracy costs: " (report.scene) }
                p class="about" { (about(report)) }
                @if study.interrupted {
                    p class="warning" { "Interrupted: what was not measured by then is missing." }
                }
                dl {
                    @for answer in report.answers() {
                        dt { (answer.question) }
                        dd class=[answer.warning.then_some("warning")] { (answer.text) }
                    }
                }
                figure { (PreEscaped(plot)) (caption()) }
                h2 { "Estimators" }
                div class="wide" { (estimators(study)) }
                h2 { "Seconds to an error" }
                div class="wide" { (predictions(study)) }
                @if !study.ladder.is_empty() {
                    h2 { "Bounces" }
                    div class="wide" { (ladder(study)) }
                }
                @if study.twin.is_some() {
                    h2 { "This device and f64" }
                    div class="wide" { (twin(study)) }
                }
                @if !strips.is_empty() {
                    h2 { "What it looks like" }
                    @for strip in strips { (strip) }
                    p class="note" { "Small pictures; the errors are theirs." }
                }
                (left_out(study))
                h2 { "How to read this" }
                @for note in reading::notes() { p class="note" { (note) } }
                footer { "Made by " (generator) ", " (significant(study.seconds, 2)) " s." }
            }
        }
    };
    Ok(page.into_string())
}

fn about(report: &CostReport) -> String {
    let study = report.study;
    format!(
        "{} × {} pixels, {} bounces, seed {}, on {} ({}); a budget of {}.",
        study.width,
        study.height,
        study.bounces,
        study.seed,
        report.tracer.device,
        report.tracer.driver,
        short_time(study.budget_seconds),
    )
}

fn caption() -> Markup {
    html! {
        figcaption {
            "Left: points with bars are realised errors, lines are predicted from the variance, \
             dashed beyond what was traced; rings are times measured in a race with other random \
             numbers. Right: the numbers beside the points are bounces; the \
             dashed line is the deepest limit measured, and a bar that ends at the axis includes \
             zero."
        }
    }
}

fn table_of(head: &[&str], rows: &[Vec<String>]) -> Markup {
    html! {
        table {
            thead { tr { @for cell in head { th { (cell) } } } }
            tbody { @for row in rows { tr { @for cell in row { td { (cell) } } } } }
        }
    }
}

fn estimators(study: &Study) -> Markup {
    let pixels = u64::from(study.width) * u64::from(study.height);
    let rows = study.estimators.iter().map(|cost| {
        let seconds = &cost.seconds_per_sample;
        vec![
            cost.estimator.name().to_owned(),
            relative(seconds, &significant(1e-6 / seconds.value, 3)),
            variance(cost),
            efficiency(cost, ""),
            cost.beside_cheapest.map_or("—".to_owned(), |ratio| {
                relative(&ratio, &format!("×{}", significant(ratio.value, 3)))
            }),
            cost.slope.map_or("—".to_owned(), |slope| {
                format!("{:.3} … {:.3}", slope.slope.low, slope.slope.high)
            }),
            format!("{} of {pixels}", cost.unproven_pixels),
            cost.samples.to_string(),
        ]
    });
    let head = [
        "estimator",
        "Msamples/s",
        "relative variance",
        "efficiency in 1/s",
        "time beside cheapest",
        "slope (must be −½)",
        "unproven pixels",
        "samples per pixel",
    ];
    table_of(&head, &rows.collect::<Vec<_>>())
}

fn predictions(study: &Study) -> Markup {
    let row = |cost: &EstimatorCost| {
        html! {
            tr {
                td { (cost.estimator.name()) }
                @if cost.predictions.is_empty() { td colspan=(TARGETS.len()) { (unpredicted(cost)) } }
                @for prediction in &cost.predictions {
                    td {
                        (short_time(prediction.seconds.value))
                        @if let Some(seconds) = prediction.measured {
                            br;
                            small {
                                "measured " (short_time(seconds))
                                ", ×" (format!("{:.2}", seconds / prediction.seconds.value))
                            }
                        }
                    }
                }
            }
        }
    };
    html! {
        table {
            thead {
                tr { th { "estimator" } @for target in TARGETS { th { (rounded_percent(target, 1)) } } }
            }
            tbody { @for cost in &study.estimators { (row(cost)) } }
        }
    }
}

fn ladder(study: &Study) -> Markup {
    let rows = study.ladder.iter().map(|rung| {
        let seconds = &rung.seconds_per_sample;
        vec![
            rung.bounces.to_string(),
            relative(seconds, &significant(1e9 * seconds.value, 3)),
            missing_light(rung, study),
            rung.seconds_to_one_percent.map_or("unproven".to_owned(), short_time),
        ]
    });
    let head = ["bounces", "ns per sample", "light missing", "time to 1 %"];
    html! {
        (table_of(&head, &rows.collect::<Vec<_>>()))
        p class="note" { "With the " (study.used.name()) " estimator." }
    }
}

fn twin(study: &Study) -> Markup {
    let Some(twin) = &study.twin else { return html! {} };
    let (ours, theirs) = (&twin.device_seconds_per_sample, &twin.twin_seconds_per_sample);
    let rate = |m: &Measured| relative(m, &significant(1e-6 / m.value, 3));
    let mut rows = vec![
        vec!["device, Msamples/s".to_owned(), rate(ours)],
        vec!["f64 twin, Msamples/s".to_owned(), rate(theirs)],
        vec![
            "f64 takes longer by".to_owned(),
            relative(&twin.slowdown, &format!("×{}", significant(twin.slowdown.value, 3))),
        ],
    ];
    for (c, name) in ["red", "green", "blue"].into_iter().enumerate() {
        let bias = twin.bias.zip(twin.bias_error).map_or("unproven".to_owned(), |(bias, error)| {
            format!("{:+.1e} ± {:.1e}", bias[c], error[c])
        });
        rows.push(vec![format!("bias of {name}"), bias]);
    }
    html! {
        (table_of(&["", "the same samples"], &rows))
        p class="note" {
            "With the " (study.used.name()) " estimator, " (twin.samples) " samples per pixel; \
             the bias is device minus f64 over the image mean, ± its standard error."
        }
    }
}

fn strip(strip: &Strip) -> Result<Markup, String> {
    let mut cells = Vec::new();
    for picture in &strip.pictures {
        let developed = Picture::develop(&picture.film, false);
        let data = BASE64_STANDARD.encode(png::encode_picture(&developed, 0.0)?);
        let error = picture.relative_error;
        let error = error.map_or("error unknown".to_owned(), |error| rounded_percent(error, 2));
        let alt = format!("{} at {} samples per pixel", strip.estimator.name(), picture.samples);
        cells.push(html! {
            figure {
                img src=(format!("data:image/png;base64,{data}")) alt=(alt);
                figcaption { b { (picture.samples) " spp" } br; (error) }
            }
        });
    }
    Ok(html! {
        h3 { (strip.estimator.name()) }
        div class="strip" { @for cell in cells { (cell) } }
    })
}

fn left_out(study: &Study) -> Markup {
    html! {
        @if !study.left_out.is_empty() {
            h2 { "Not measured" }
            ul { @for left_out in &study.left_out { li { (left_out.what) ": " (left_out.why) } } }
        }
    }
}
