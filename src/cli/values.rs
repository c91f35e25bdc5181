//! Values of single arguments, as typed.

use crate::cost::Plan;
use crate::film::SampleRanges;
use crate::scene::{Estimator, ImageSize, Invalid};
use std::num::NonZeroUsize;
use std::ops::Range;
use std::str::FromStr;
use std::time::Duration;

/// More threads than this are a typing mistake, and would take the machine down.
const MAX_THREADS: NonZeroUsize = NonZeroUsize::new(1024).unwrap();

/// How paths should be built.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum EstimatorChoice {
    /// The cheapest for this scene on this device.
    Auto,
    Named(Estimator),
}

/// What should render.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum DeviceChoice {
    Auto,
    Gpu,
    Cpu,
    Named(String),
}

impl FromStr for DeviceChoice {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        match text.to_lowercase().as_str() {
            "auto" => Ok(Self::Auto),
            "gpu" => Ok(Self::Gpu),
            "cpu" => Ok(Self::Cpu),
            "" => Err("expected auto, gpu, cpu or part of an adapter's name".to_owned()),
            _ => Ok(Self::Named(text.to_owned())),
        }
    }
}

pub(super) fn size(text: &str) -> Result<ImageSize, String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.parse().ok()?, h.parse().ok()?)));
    let (width, height) =
        sides.ok_or("expected WIDTHxHEIGHT in pixels, such as 640x480".to_owned())?;
    ImageSize::new(width, height).map_err(|error| format!("each side must be {error}"))
}

pub(super) fn pixel(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(',').and_then(|(x, y)| Some((x.parse().ok()?, y.parse().ok()?)));
    sides.ok_or("expected COLUMN,ROW in whole numbers, such as 12,34".to_owned())
}

pub(super) fn samples(text: &str) -> Result<Range<u64>, String> {
    let ends = text.split_once("..").and_then(|(a, b)| Some(a.parse().ok()?..b.parse().ok()?));
    match ends {
        Some(range) if range.start < range.end => {
            // Refused here, before the work: more than a film can hold.
            let fits = SampleRanges::default().insert(range.clone());
            fits.map(|()| range).map_err(|error| error.to_string())
        }
        Some(_) => Err("the range is empty; the end must be larger than the start".to_owned()),
        None => Err("expected A..B with whole numbers, such as 0..256".to_owned()),
    }
}

pub(super) fn estimator(text: &str) -> Result<EstimatorChoice, String> {
    if text == "auto" {
        return Ok(EstimatorChoice::Auto);
    }
    let named = text.parse().map(EstimatorChoice::Named);
    named.map_err(|allowed: Invalid| format!("expected {allowed}, or \"auto\""))
}

pub(super) fn threads(text: &str) -> Result<NonZeroUsize, String> {
    match text.parse() {
        Ok(threads) if threads <= MAX_THREADS => Ok(threads),
        _ => Err(format!("expected a whole number from 1 to {MAX_THREADS}")),
    }
}

pub(super) fn time(text: &str) -> Result<Duration, String> {
    match humantime::parse_duration(text) {
        Ok(time) if !time.is_zero() => Ok(time),
        Ok(_) => Err("expected a time longer than zero".to_owned()),
        Err(_) => Err("expected a time with its unit, such as 30s, 5m or 1h 30m".to_owned()),
    }
}

/// A fraction, or a percentage with its sign. More than the picture's whole mean is no error to
/// aim at, and a bare 5 would be one.
pub(super) fn target(text: &str) -> Result<f64, String> {
    let (number, unit) = text.strip_suffix('%').map_or((text, 1.0), |number| (number, 100.0));
    match number.trim().parse::<f64>().map(|number| number / unit) {
        Ok(error) if error > 0.0 && error <= 1.0 => Ok(error),
        _ => {
            Err("expected a percentage such as 1%, or a fraction above 0 and up to 1 such as 0.01"
                .to_owned())
        }
    }
}

pub(super) fn budget(text: &str) -> Result<Plan, String> {
    Plan::new(time(text)?).map_err(|allowed| format!("expected {allowed}"))
}

pub(super) fn exposure(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(stops) if stops.abs() <= 100.0 => Ok(stops),
        _ => Err("expected a number of stops from -100 to 100".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::{samples, size, target, time};

    #[test]
    fn sizes() {
        let picture = size("640x480").expect("a size");
        assert_eq!((picture.width(), picture.height()), (640, 480));
        for bad in ["640", "640x", "x480", "0x480", "640x65536", "-1x5", "6 x 5", "1x2x3"] {
            assert!(size(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn sample_ranges() {
        assert_eq!(samples("3..17"), Ok(3..17));
        for bad in ["3", "..17", "3..", "5..5", "7..5", "a..b", "-1..5", "3..=5", "0..4294967297"] {
            assert!(samples(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn times() {
        assert_eq!(time("90s").map(|t| t.as_secs()), Ok(90));
        for bad in ["30", "0s", "s", "-3s", "soon"] {
            assert!(time(bad).is_err(), "{bad}");
        }
    }

    #[test]
    fn targets() {
        for (text, error) in [("1%", 0.01), ("0.5 %", 0.005), ("0.01", 0.01), ("1", 1.0)] {
            assert_eq!(target(text), Ok(error), "{text}");
        }
        for bad in ["5", "0", "0%", "101%", "-1%", "nan", "NaN%", "inf%", "%", "", "1 percent"] {
            assert!(target(bad).is_err(), "{bad}");
        }
    }
}
