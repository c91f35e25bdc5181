//! Amounts as people read them.

use std::time::Duration;

/// A number of bytes, such as "2.3 GB".
#[expect(clippy::cast_precision_loss, reason = "shown with one decimal")]
pub(super) fn bytes(count: u64) -> String {
    format!("{}B", scaled(count as f64))
}

/// Samples per second, such as "14.2 Msamples/s".
pub(super) fn rate(samples_per_second: f64) -> String {
    format!("{}samples/s", scaled(samples_per_second))
}

/// A time in its two largest units, such as "3.2 s" or "1h 19m".
pub(super) fn time(seconds: f64) -> String {
    if seconds < 10.0 {
        return format!("{seconds:.1} s");
    }
    if seconds < 60.0 {
        return format!("{seconds:.0} s");
    }
    let whole = Duration::from_secs_f64(seconds.min(1e15).round());
    let text = humantime::format_duration(whole).to_string();
    text.split(' ').take(2).collect::<Vec<_>>().join(" ")
}

/// A fraction as a percentage, with the digits that it was given with: "0.5 %".
#[expect(clippy::cast_possible_truncation, reason = "the digits that f64 adds to 100·0.07 go")]
pub(super) fn percent(fraction: f64) -> String {
    format!("{} %", (100.0 * fraction) as f32)
}

/// One decimal, and the prefix of the unit that follows.
fn scaled(amount: f64) -> String {
    let (scale, prefix) = match amount {
        a if a < 1e6 => (1e3, "k"),
        a if a < 1e9 => (1e6, "M"),
        _ => (1e9, "G"),
    };
    format!("{:.1} {prefix}", amount / scale)
}

#[cfg(test)]
mod tests {
    use super::{bytes, percent, rate, time};

    #[test]
    fn amounts() {
        assert_eq!(bytes(22_272), "22.3 kB");
        assert_eq!(bytes(596_980_000_000), "597.0 GB");
        assert_eq!(rate(14_234_567.0), "14.2 Msamples/s");
    }

    #[test]
    fn percentages() {
        let table = [(0.01, "1 %"), (0.07, "7 %"), (0.005, "0.5 %"), (1.0, "100 %")];
        for (fraction, text) in table {
            assert_eq!(percent(fraction), text);
        }
    }

    #[test]
    fn times() {
        let table = [
            (0.06, "0.1 s"),
            (59.4, "59 s"),
            (60.2, "1m"),
            (4761.0, "1h 19m"),
            (1e9, "31years 8months"),
            (f64::INFINITY, "31688087years 9months"),
        ];
        for (seconds, text) in table {
            assert_eq!(time(seconds), text);
        }
    }
}
