//! The studies as tables.

use super::order::{Convergence, Found, Orders};
use super::{Bench, IntegratorCurve, Point, TARGETS_RAD};
use crate::present::table::{Column, NONE, ReportTable, number, words};
use crate::studies::integrators::Theory;

/// A curve and one of its points, of a bench.
type Chosen<'a> = Option<(&'a IntegratorCurve, &'a Point)>;

fn named(chosen: Chosen) -> String {
    chosen.map_or(NOT_REACHED.into(), |(curve, _)| curve.subject.clone())
}

fn timed(chosen: Chosen) -> Option<f64> {
    chosen.map(|(_, point)| point.seconds.least)
}

/// For each error and aspect ratio the cheapest subject.
pub(super) fn cheapest(benches: &[Bench]) -> ReportTable {
    type Row<'a> = (&'a Bench, f64, Chosen<'a>, Chosen<'a>);
    let row = |bench, target| -> Row {
        let steps = |theory| theory != Theory::Exact;
        (bench, target, Bench::cheapest(bench, target, |_| true), Bench::cheapest(bench, target, steps))
    };
    ReportTable::new(
        ["work-precision", "For an error: the cheapest subject and its time"],
        "One rod into the middle of its third flip. A point counts where the next finer one reaches the error too.",
        (benches.iter()).flat_map(|bench| TARGETS_RAD.map(|target| row(bench, target))),
        vec![
            number("r_e", |r| r.to_string(), |r: &Row| r.0.aspect_ratio),
            number("error (rad)", |e| format!("{e:.0e}"), |r: &Row| r.1),
            words("cheapest", |r: &Row| named(r.2)),
            number("time", time, |r: &Row| timed(r.2)).or(""),
            words("cheapest that takes steps", |r: &Row| named(r.3)),
            number("time of that", time, |r: &Row| timed(r.3)).or(""),
        ],
    )
}

/// The exact propagator's time against the cheapest adaptive subject's.
pub(super) fn ratio(benches: &[Bench]) -> ReportTable {
    let exact = |bench: &Bench| {
        let exact = bench.curves.iter().find(|curve| curve.theory == Theory::Exact);
        exact.and_then(|curve| curve.points.first().cloned())
    };
    let adaptive = |bench: &Bench| {
        let found = bench.cheapest(1e-6, |theory| theory == Theory::Adaptive);
        (named(found), timed(found))
    };
    ReportTable::new(
        ["exact-against-adaptive", "The exact propagator against the cheapest adaptive subject"],
        "The propagator's time for round-off error over the cheapest adaptive subject's for 10⁻⁶ rad.",
        benches.iter(),
        vec![
            number("r_e", |r| r.to_string(), |b: &&Bench| b.aspect_ratio),
            number(
                "error of the propagator (rad)",
                |e| format!("{e:.1e}"),
                move |b: &&Bench| exact(b).map(|point| point.error_rad()),
            )
            .or(NOT_REACHED),
            number("its time", time, move |b: &&Bench| exact(b).map(|point| point.seconds.least))
                .or(NOT_REACHED),
            words("adaptive, for 1e-6", move |b: &&Bench| adaptive(b).0),
            number("its time for 1e-6", time, move |b: &&Bench| adaptive(b).1).or(NOT_REACHED),
            number("ratio", |ratio| format!("1/{:.0}", 1.0 / ratio), |b: &&Bench| b.exact_over_adaptive()),
        ],
    )
}

/// Every subject of a bench: the time for each error, then the best it can do.
pub(super) fn every_subject(bench: &Bench) -> ReportTable {
    let best = |curve: &IntegratorCurve| Some((curve.best()?.clone(), curve.best()?.errors?));
    let e = |error: f64| format!("{error:.1e}");
    let mut columns: Vec<Column<&IntegratorCurve>> =
        vec![words("subject", |c: &&IntegratorCurve| c.subject.as_str())];
    columns.extend(TARGETS_RAD.map(|target| {
        number(format!("{target:.0e} rad"), time, move |c: &&IntegratorCurve| {
            c.cheapest(target).map(|point| point.seconds.least)
        })
        .or(NOT_REACHED)
    }));
    columns.extend([
        number("best (rad)", e, move |c: &&IntegratorCurve| best(c).map(|b| b.1.orientation_rad)),
        number("C_b", e, move |c: &&IntegratorCurve| best(c).map(|b| b.1.orbit_constant)),
        number("t/T", e, move |c: &&IntegratorCurve| best(c).map(|b| b.1.phase_turns)),
        words("setting", move |c: &&IntegratorCurve| {
            best(c).map_or("failed".into(), |b| b.0.setting.to_string())
        }),
        words("time", move |c: &&IntegratorCurve| {
            let seconds = best(c).map(|b| b.0.seconds);
            seconds.map_or(NONE.into(), |s| format!("{} to {}", time(s.least), time(s.most)))
        }),
        words("failed", |c: &&IntegratorCurve| format!("{} of {}", c.failures(), c.points.len())),
    ]);
    ReportTable::new(
        [
            &format!("work-precision-{}", bench.name),
            &format!("Every subject at r_e = {}", bench.aspect_ratio),
        ],
        "Times for an error, then the smallest error found: the angle, C_b and the phase at one setting.",
        &bench.curves,
        columns,
    )
}

/// Observed orders.
pub fn orders(orders: &Orders) -> ReportTable {
    let found = |study: &&Convergence| match study.found {
        Found::AsTheory => "as theory",
        Found::Not => "NOT as theory",
        Found::RoundOff => "at round-off",
    };
    let judged = |study: &&Convergence| {
        let judged: Vec<_> = study.judged.iter().map(|order| format!("{order:+.3}")).collect();
        judged.join(" ")
    };
    let e = |error: f64| format!("{error:.1e}");
    ReportTable::new(
        ["orders", "Observed order, Richardson's value and grid convergence index"],
        format!(
            "{}. The core itself takes no step for a free rod: these are the orders of integrators that do. Orders of the \
             angle's error on the last two pairs above round-off, negative where it grows; the rest is of |p_1|, from \
             three grids: its index is to bound its error.",
            orders.problem
        ),
        &orders.studies,
        vec![
            words("subject", |s: &&Convergence| s.subject.as_str()),
            words("theory", |s: &&Convergence| s.theory.to_string()),
            words("observed", judged),
            words("verdict", found),
            number(
                "steps",
                |steps| steps.to_string(),
                |s: &&Convergence| s.richardson.map(|r| r.steps as f64),
            ),
            number(
                "order of |p_1|",
                |o| format!("{o:+.3}"),
                |s: &&Convergence| s.richardson.map(|r| r.order),
            ),
            number("at Δt = 0", |v| format!("{v:.12}"), |s: &&Convergence| s.richardson.map(|r| r.value)),
            number("off by", e, |s: &&Convergence| s.richardson.map(|r| r.error)),
            number("index", e, |s: &&Convergence| s.richardson.map(|r| r.index)),
            number("error", e, |s: &&Convergence| s.richardson.map(|r| r.true_error)),
        ],
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
    let digits = if number < 9.995 { 2 } else { usize::from(number < 99.95) };
    format!("{number:.digits$} {unit}")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn times_have_three_digits() {
        let expected = [(4.31e-8, "43.1 ns"), (9.999e-6, "10.0 µs"), (0.1234, "123 ms"), (2.5, "2.50 s")];
        for (seconds, text) in expected {
            assert_eq!(time(seconds), text);
        }
    }
}
