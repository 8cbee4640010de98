//! Formats of numbers, times and names in the report.

use super::Line;
use crate::judge::accept::{Rule, Verdict};
use crate::present::markup::powers;

pub(super) fn number(value: f64) -> String {
    digits(value, 3)
}

pub(crate) fn digits(value: f64, digits: i32) -> String {
    let sign = if value < 0.0 { "−" } else { "" };
    let size = value.abs();
    if value.is_nan() {
        "not a number".into()
    } else if size.is_infinite() {
        format!("{sign}∞")
    } else if size == 0.0 {
        "0".into()
    } else {
        // Rounded first: 9.999 is 10.0, with an exponent of 1.
        let rounded = format!("{size:.*e}", digits as usize - 1);
        let (mantissa, exponent) = rounded.split_once('e').unwrap_or((&rounded, "0"));
        match exponent.parse::<i32>().unwrap_or(0) {
            exponent @ -3..5 => {
                let decimals = (digits - 1 - exponent).max(0) as usize;
                let plain = format!("{size:.decimals$}");
                format!("{sign}{}", trimmed(&plain))
            }
            exponent => format!("{sign}{}", powers(&format!("{}e{exponent}", trimmed(mantissa)))),
        }
    }
}

fn trimmed(number: &str) -> &str {
    if number.contains('.') { number.trim_end_matches('0').trim_end_matches('.') } else { number }
}

/// The error and the tolerance of a line.
pub(super) fn bounds(line: &Line) -> (String, String) {
    match line.judged_by {
        Rule::NoData { .. } => ("–".into(), "–".into()),
        Rule::PValue { .. } => (format!("p = {}", number(line.error)), format!("p ≥ {}", number(line.tolerance))),
        Rule::Above { .. } => (format!("mean {}", number(line.error)), format!("> {}", number(line.tolerance))),
        _ => (number(line.error), number(line.tolerance)),
    }
}

pub(super) fn share(used: f64) -> String {
    match used {
        used if used.is_nan() => "not a number".into(),
        0.0 => "0 %".into(),
        used if used < 1e-3 => "< 0.1 %".into(),
        used if used < 0.1 => format!("{:.1} %", 100.0 * used),
        used if used < 10.0 => format!("{:.0} %", 100.0 * used),
        _ => "> 1000 %".into(),
    }
}

/// The numbers behind a rule, if there are more than its error and tolerance.
pub(super) fn detail(rule: &Rule) -> String {
    match rule {
        Rule::Mean { mean, se, samples, reference, allowance, effect, .. } => {
            let allowance = match *allowance {
                0.0 => String::new(),
                allowance => format!(", allowance {}", number(allowance)),
            };
            format!(
                "mean {} ± {} (standard error of {samples}), reference {}{allowance}; sized to show {}",
                digits(*mean, 6),
                number(*se),
                digits(*reference, 6),
                number(*effect)
            )
        }
        Rule::Above { mean, se, samples, bound, effect, .. } => format!(
            "mean {} ± {} (standard error of {samples}), must exceed {}, and does so by {} or more",
            digits(*mean, 6),
            number(*se),
            digits(*bound, 6),
            number(*effect)
        ),
        Rule::PValue { samples, enough, .. } => format!("{samples} samples, at least {enough} needed"),
        Rule::Within { .. } | Rule::NoData { .. } => String::new(),
    }
}

pub(super) fn seconds(seconds: f64) -> String {
    match seconds {
        s if s < 0.01 => "< 0.01 s".into(),
        s if s < 10.0 => format!("{s:.2} s"),
        s if s < 600.0 => format!("{s:.0} s"),
        s => format!("{:.0} min", s / 60.0),
    }
}

/// A verdict as a symbol and a word, so that it never depends on colour.
pub(super) fn verdict(verdict: Verdict) -> (&'static str, &'static str) {
    match verdict {
        Verdict::Pass => ("✓", "pass"),
        Verdict::Fail => ("✗", "fail"),
        Verdict::Underpowered => ("△", "under-powered"),
        Verdict::NoData => ("○", "no data"),
    }
}

/// Seconds since 1970 as RFC 3339, in UTC. Days to dates after Hinnant, "chrono-compatible low-level date
/// algorithms".
pub(super) fn utc(since_1970: u64) -> String {
    let (day, second) = (since_1970 / 86_400, since_1970 % 86_400);
    // Years from March 0000, so that the leap day is the last of its year; 400 of them are an era.
    let from_march = day + 719_468;
    let (era, day) = (from_march / 146_097, from_march % 146_097);
    let year = (day - day / 1460 + day / 36_524 - day / 146_096) / 365;
    let day = day - (365 * year + year / 4 - year / 100);
    let month = (5 * day + 2) / 153;
    let date = day - (153 * month + 2) / 5 + 1;
    let month = if month < 10 { month + 3 } else { month - 9 };
    let year = 400 * era + year + u64::from(month <= 2);
    format!("{year:04}-{month:02}-{date:02}T{:02}:{:02}:{:02}Z", second / 3600, second / 60 % 60, second % 60)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_three_digits() {
        for (value, text) in [
            (0.0, "0"),
            (0.5, "0.5"),
            (-0.012345, "−0.0123"),
            (9.999, "10"),
            (1234.5, "1234"),
            (1e-12, "10⁻¹²"),
            (-2.5e-13, "−2.5·10⁻¹³"),
            (99_999.0, "10⁵"),
            (f64::NAN, "not a number"),
            (f64::NEG_INFINITY, "−∞"),
            (5e-324, "4.94·10⁻³²⁴"),
        ] {
            assert_eq!(number(value), text);
        }
    }

    #[test]
    fn shares_have_the_digits_that_they_need() {
        for (used, text) in [
            (0.0, "0 %"),
            (0.0009, "< 0.1 %"),
            (0.0123, "1.2 %"),
            (0.123, "12 %"),
            (9.87, "987 %"),
            (f64::INFINITY, "> 1000 %"),
            (f64::NAN, "not a number"),
        ] {
            assert_eq!(share(used), text);
        }
    }

    #[test]
    fn dates_are_civil() {
        for (seconds, date) in [
            (0, "1970-01-01T00:00:00Z"),
            (951_782_399, "2000-02-28T23:59:59Z"),
            (951_782_400, "2000-02-29T00:00:00Z"),
            (4_107_542_400, "2100-03-01T00:00:00Z"),
            (1_234_567_890, "2009-02-13T23:31:30Z"),
        ] {
            assert_eq!(utc(seconds), date);
        }
    }
}
