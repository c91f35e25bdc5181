//! The bounce ladder: light that is missing against the time for a sample.

use super::{Axis, Failure, Pen, colour};
use crate::cost::{Rung, Study};
use crate::units::rounded_percent;
use plotters::coord::Shift;
use plotters::prelude::{
    Circle, Color, DashedLineSeries, DrawingArea, DrawingBackend, EmptyElement, LineSeries,
    PathElement, Text,
};

/// The axis of missing light reaches at least down to this share.
const SMALLEST: f64 = 0.05;

/// One rung where it is drawn: nanoseconds per sample, and decimal logarithms of the missing
/// share and of its interval.
struct Place {
    bounces: u32,
    nanoseconds: f64,
    missing: f64,
    low: f64,
    high: f64,
}

pub(super) fn draw<DB: DrawingBackend>(
    area: &DrawingArea<DB, Shift>,
    study: &Study,
    pen: Pen,
) -> Result<(), Failure<DB>> {
    let places: Vec<Place> = study.ladder.iter().filter_map(Place::of).collect();
    let (x, y) = axes(study, &places);
    let mut chart = pen.chart(area, "What the bounce limit costs", [&x, &y])?;
    let colour = colour(study.used);
    let within = |y_at: f64| y_at.clamp(y.ends.0, y.ends.1);
    let line = places.iter().map(|place| (place.nanoseconds, within(place.missing)));
    chart.draw_series(LineSeries::new(line, colour.mix(0.5).stroke_width(pen.length(2))))?;
    for place in &places {
        let at = (place.nanoseconds, within(place.missing));
        let bar = [place.low, place.high].map(|end| (place.nanoseconds, within(end)));
        chart.draw_series([PathElement::new(bar.to_vec(), colour.stroke_width(pen.length(2)))])?;
        if place.missing >= y.ends.0 {
            chart.draw_series([Circle::new(at, pen.length(4), colour.filled())])?;
        }
        let text = Text::new(place.bounces.to_string(), beside(pen), pen.text(17));
        chart.draw_series([EmptyElement::at(at) + text])?;
    }
    if let Some(deepest) = study.ladder.last() {
        // It misses nothing of itself, which no logarithmic axis shows.
        let at = |y| (1e9 * deepest.seconds_per_sample.value, y);
        let line = [at(y.ends.0), at(y.ends.1)];
        let dash = pen.length(6);
        let style = colour.stroke_width(pen.length(2));
        chart.draw_series(DashedLineSeries::new(line, dash, dash, style))?;
        let text = Text::new(deepest.bounces.to_string(), beside(pen), pen.text(17));
        chart.draw_series([EmptyElement::at(at(y.ends.0 + 0.1)) + text])?;
    }
    Ok(())
}

/// Where a label stands beside its point.
fn beside(pen: Pen) -> (i32, i32) {
    (pen.offset(9), pen.offset(pen.drop - 20))
}

impl Place {
    fn of(rung: &Rung) -> Option<Self> {
        let missing = rung.missing?;
        // A share that may be zero reaches down to the end of a logarithmic axis.
        let log = |share: f64| if share > 0.0 { share.log10() } else { f64::NEG_INFINITY };
        Some(Self {
            bounces: rung.bounces,
            nanoseconds: 1e9 * rung.seconds_per_sample.value,
            missing: log(missing.value),
            low: log(missing.low),
            high: log(missing.high),
        })
    }
}

fn axes(study: &Study, places: &[Place]) -> (Axis, Axis) {
    let finite = places.iter().flat_map(|place| [place.missing, place.low]);
    let lowest = finite.filter(|log| log.is_finite()).fold(SMALLEST.log10(), f64::min);
    let times = study.ladder.iter().map(|rung| 1e9 * rung.seconds_per_sample.value);
    let longest = places.iter().map(|place| place.nanoseconds).fold(0.0, f64::max);
    let longest = times.fold(longest, f64::max) * 1.1;
    let x = Axis {
        name: "nanoseconds per sample".to_owned(),
        ends: (0.0, longest),
        ticks: round_steps(longest),
        label: |ns| format!("{ns}"),
    };
    let deepest = study.ladder.last().map_or(0, |rung| rung.bounces);
    let name = format!("light missing beside {deepest} bounces");
    let y = Axis::of_logs(&name, (lowest.max(-6.0) - 0.3, 0.1), true, |y| {
        rounded_percent(10_f64.powf(y), 1)
    });
    (x, y)
}

/// Multiples of 1, 2 or 5 times a power of ten, four to eight of them.
fn round_steps(end: f64) -> Vec<f64> {
    let power = 10_f64.powf((end / 8.0).log10().floor());
    let steps = [1.0, 2.0, 5.0, 10.0].map(|step| step * power);
    let step = steps.into_iter().find(|step| end / step <= 8.0).unwrap_or(end);
    std::iter::successors(Some(0.0), |at| Some(at + step)).take_while(|at| *at <= end).collect()
}

#[cfg(test)]
mod tests {
    use super::round_steps;

    #[test]
    fn steps_are_round() {
        assert_eq!(round_steps(105.0), [0.0, 20.0, 40.0, 60.0, 80.0, 100.0]);
        assert_eq!(round_steps(8.0), [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0]);
        assert_eq!(round_steps(270.0).len(), 6);
    }
}
