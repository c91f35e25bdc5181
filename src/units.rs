//! Amounts as people read them.

use std::time::Duration;

/// A number of bytes, such as "512 B" or "2.3 GB".
#[expect(clippy::cast_precision_loss, reason = "shown with one decimal")]
pub(crate) fn bytes(count: u64) -> String {
    if count < 1000 {
        return format!("{count} B");
    }
    format!("{}B", scaled(count as f64))
}

/// Samples per second, such as "14.2 Msamples/s".
pub(crate) fn rate(samples_per_second: f64) -> String {
    format!("{}samples/s", scaled(samples_per_second))
}

/// A time in its two largest units, such as "3.2 s" or "1h 19m".
pub(crate) fn time(seconds: f64) -> String {
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
pub(crate) fn percent(fraction: f64) -> String {
    format!("{} %", (100.0 * fraction) as f32)
}

/// A time of which the first two digits count, such as "0.042 s", "3.2 s" or "1h 19m".
pub(crate) fn short_time(seconds: f64) -> String {
    if seconds >= 1.0 {
        return time(seconds);
    }
    format!("{} s", significant(seconds, 2))
}

/// A share in per cent with so many significant digits, such as "0.042 %".
pub(crate) fn rounded_percent(share: f64, digits: i32) -> String {
    format!("{} %", significant(100.0 * share, digits))
}

/// A number in decimal notation with so many significant digits; zeros behind them are kept.
pub(crate) fn significant(number: f64, digits: i32) -> String {
    if number == 0.0 || !number.is_finite() {
        return format!("{number}");
    }
    #[expect(clippy::cast_possible_truncation, reason = "a decimal exponent")]
    let exponent = number.abs().log10().floor() as i32;
    let places = (digits - 1 - exponent).clamp(0, 12).unsigned_abs() as usize;
    format!("{number:.places$}")
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
    use super::{bytes, percent, rate, rounded_percent, short_time, significant, time};

    #[test]
    fn amounts() {
        assert_eq!(bytes(999), "999 B");
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
    fn digits() {
        assert_eq!(significant(0.012_345, 2), "0.012");
        assert_eq!(significant(-1.5, 3), "-1.50");
        assert_eq!(significant(12_345.0, 2), "12345");
        assert_eq!(rounded_percent(0.1, 2), "10 %");
        assert_eq!(short_time(0.0421), "0.042 s");
        assert_eq!(short_time(75.0), "1m 15s");
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
