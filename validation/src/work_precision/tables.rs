//! The studies as tables.

use super::order::{Found, Orders, Study};
use super::{Bench, Curve, Point, TARGETS_RAD};
use crate::report::ReportTable;
use crate::subject::Theory;

/// What is cheapest at each aspect ratio, then every subject for each bench.
pub fn tables(benches: &[Bench]) -> Vec<ReportTable> {
    let each = benches.iter().map(every_subject);
    [cheapest(benches), ratio(benches)]
        .into_iter()
        .chain(each)
        .collect()
}

/// A table.
pub(crate) fn table(
    name: &str,
    title: &str,
    caption: &str,
    columns: &[&str],
    rows: Vec<Vec<String>>,
) -> ReportTable {
    ReportTable {
        name: name.into(),
        title: title.into(),
        caption: caption.into(),
        columns: columns.iter().map(|column| (*column).into()).collect(),
        rows,
    }
}

fn cheapest(benches: &[Bench]) -> ReportTable {
    let named = |found: Option<(&Curve, &Point)>| match found {
        Some((curve, point)) => [curve.subject.clone(), time(point.seconds.least)],
        None => [NOT_REACHED.into(), String::new()],
    };
    let row = |bench: &Bench, target: f64| {
        let mut row = vec![bench.aspect_ratio.to_string(), format!("{target:.0e}")];
        row.extend(named(bench.cheapest(target, |_| true)));
        row.extend(named(bench.cheapest(target, |theory| theory != Theory::Exact)));
        row
    };
    let rows = benches
        .iter()
        .flat_map(|bench| TARGETS_RAD.map(|target| row(bench, target)));
    table(
        "work-precision",
        "For an error: the cheapest subject and its time",
        "One rod into the middle of its third flip. A point counts where the next finer one reaches the error too.",
        &[
            "r_e",
            "error (rad)",
            "cheapest",
            "time",
            "cheapest that takes steps",
            "time of that",
        ],
        rows.collect(),
    )
}

fn ratio(benches: &[Bench]) -> ReportTable {
    let row = |bench: &Bench| {
        let exact = bench.curves.iter().find(|curve| curve.theory == Theory::Exact);
        let point = exact.and_then(|curve| curve.points.first());
        let adaptive = bench.cheapest(1e-6, |theory| theory == Theory::Adaptive);
        vec![
            bench.aspect_ratio.to_string(),
            point.map_or(NOT_REACHED.into(), |point| format!("{:.1e}", point.error_rad())),
            point.map_or(NOT_REACHED.into(), |point| time(point.seconds.least)),
            adaptive.map_or(NOT_REACHED.into(), |(curve, _)| curve.subject.clone()),
            adaptive.map_or(NOT_REACHED.into(), |(_, point)| time(point.seconds.least)),
            bench
                .exact_over_adaptive()
                .map_or("–".into(), |ratio| format!("1/{:.0}", 1.0 / ratio)),
        ]
    };
    table(
        "exact-against-adaptive",
        "The exact propagator against the cheapest adaptive subject",
        "The propagator's time for round-off error over the cheapest adaptive subject's for 10⁻⁶ rad.",
        &[
            "r_e",
            "error of the propagator (rad)",
            "its time",
            "adaptive, for 1e-6",
            "its time for 1e-6",
            "ratio",
        ],
        benches.iter().map(row).collect(),
    )
}

fn every_subject(bench: &Bench) -> ReportTable {
    let row = |curve: &Curve| {
        let mut row = vec![curve.subject.clone()];
        row.extend(TARGETS_RAD.map(|target| match curve.cheapest(target) {
            Some(point) => time(point.seconds.least),
            None => NOT_REACHED.into(),
        }));
        let best = curve.best().and_then(|point| Some((point, point.errors?)));
        row.extend(match best {
            Some((point, errors)) => [
                format!("{:.1e}", errors.orientation_rad),
                format!("{:.1e}", errors.orbit_constant),
                format!("{:.1e}", errors.phase_turns),
                point.setting.to_string(),
                format!("{} to {}", time(point.seconds.least), time(point.seconds.most)),
            ],
            None => ["failed", "", "", "", ""].map(String::from),
        });
        row.push(format!("{} of {}", curve.failures(), curve.points.len()));
        row
    };
    table(
        &format!("work-precision-{}", bench.name),
        &format!("Every subject at r_e = {}", bench.aspect_ratio),
        "Times for an error, then the smallest error found: the angle, C_b and the phase at one setting.",
        &[
            "subject",
            "1e-3 rad",
            "1e-6 rad",
            "1e-9 rad",
            "best (rad)",
            "C_b",
            "t/T",
            "setting",
            "time",
            "failed",
        ],
        bench.curves.iter().map(row).collect(),
    )
}

/// Observed orders.
pub fn orders(orders: &Orders) -> ReportTable {
    let row = |study: &Study| {
        let judged: Vec<_> = study.judged.iter().map(|order| format!("{order:+.3}")).collect();
        let found = match study.found {
            Found::AsTheory => "as theory",
            Found::Not => "NOT as theory",
            Found::RoundOff => "at round-off",
        };
        let mut row = vec![
            study.subject.clone(),
            study.theory.to_string(),
            judged.join(" "),
            found.into(),
        ];
        row.extend(match &study.richardson {
            Some(found) => [
                found.steps.to_string(),
                format!("{:+.3}", found.order),
                format!("{:.12}", found.value),
                format!("{:.1e}", found.error),
                format!("{:.1e}", found.index),
                format!("{:.1e}", found.true_error),
            ],
            None => ["–"; 6].map(String::from),
        });
        row
    };
    table(
        "orders",
        "Observed order, Richardson's value and grid convergence index",
        &format!(
            "{}. The core itself takes no step for a free rod: these are the orders of integrators that do. Orders of the \
             angle's error on the last two pairs above round-off, negative where it grows; the rest is of |p_1|, from \
             three grids: its index is to bound its error.",
            orders.problem
        ),
        &[
            "subject",
            "theory",
            "observed",
            "verdict",
            "steps",
            "order of |p_1|",
            "at Δt = 0",
            "off by",
            "index",
            "error",
        ],
        orders.studies.iter().map(row).collect(),
    )
}

/// Where no setting reaches an error.
pub(crate) const NOT_REACHED: &str = "not reached";

/// Seconds in a unit that leaves three digits.
pub(crate) fn time(seconds: f64) -> String {
    let (scale, unit) = match seconds {
        s if s < 1e-6 => (1e9, "ns"),
        s if s < 1e-3 => (1e6, "µs"),
        s if s < 1.0 => (1e3, "ms"),
        _ => (1.0, "s"),
    };
    let number = seconds * scale;
    let digits = if number < 9.995 {
        2
    } else {
        usize::from(number < 99.95)
    };
    format!("{number:.digits$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_three_digits() {
        let expected = [
            (4.31e-8, "43.1 ns"),
            (9.999e-6, "10.0 µs"),
            (0.1234, "123 ms"),
            (2.5, "2.50 s"),
        ];
        for (seconds, text) in expected {
            assert_eq!(time(seconds), text);
        }
    }
}
