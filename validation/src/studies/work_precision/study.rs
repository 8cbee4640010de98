//! The study of integrators of one rod: error against run time, and observed orders.

use super::order::{self, Convergence, OrderVerdict, Orders, Richardson};
use super::rows::bench_csv;
use super::*;
use crate::present::table::NONE;
use crate::studies::integrators;

/// The study of every integrator at every aspect ratio.
pub const STUDY: Study = Study {
    name: "work-precision",
    title: "Integrators: error against run time",
    question: "Which integrator of one free rod reaches an error soonest, and does each converge at its order?",
    cases: &[
        "integrator-orders",
        "exact-propagator-round-off",
        "integrator-lengths",
        "adaptive-integrators",
        "grid-convergence-index",
        "where-errors-show",
        "flip-not-stiff",
        "coarse-steps",
        "who-loses-length",
        "right-hand-side-digits",
    ],
    command: "cargo run --release -- bench --case re2 --case re11.6 --case re100 --case re10000",
    parts: &PARTS,
    shared: false,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let chosen = super::ASPECT_RATIOS.into_iter().filter(|r| (request.wanted)(&super::name(*r)));
    let budget = request.effort.pick(Budget::QUICK, Budget::FULL);
    let integrators = integrators::all();
    let benches: Vec<_> = chosen.map(|r| super::run(r, &integrators, budget)).collect();
    let orders = order::of_rod(11.6);
    let both = |bench| Exhibit::both(figure(bench), every_integrator(bench));
    let mut exhibits: Vec<Exhibit> = benches.iter().map(both).collect();
    exhibits.extend([
        Exhibit::both(orders_figure(&orders), orders_table(&orders)),
        cheapest(&benches).into(),
        ratio(&benches).into(),
    ]);
    let files =
        [("bench.csv", bench_csv(&benches)?), ("bench.json", build::json(&BTreeMap::from([("benches", &benches)]))?)];
    Ok(Some(Findings::new(answer(&benches, &orders), exhibits, files)))
}

fn answer(benches: &[Bench], orders: &order::Orders) -> String {
    let wins = (benches.iter()).filter(|bench| {
        let cheapest = bench.cheapest(1e-6, |_| true);
        cheapest.is_some_and(|(curve, _)| curve.theory == Theory::Exact)
    });
    let kept = (orders.studies.iter()).filter(|study| study.found == OrderVerdict::AsTheory);
    format!(
        "An exact propagator is the cheapest for 10⁻⁶ rad at {} of {} aspect ratios, and {} of {} methods with steps \
         converge at the order of theory.",
        wins.count(),
        benches.len(),
        kept.count(),
        orders.studies.len()
    )
}

/// The ordinate of failed runs: above every error, which is π/2 at most.
const FAILED: f64 = 10.0;

/// The ordinate of an error of 0 on a logarithmic axis.
const LEAST: f64 = 1e-17;

fn drawn(errors: Option<Errors>) -> f64 {
    errors.map_or(f64::NAN, |errors| errors.orientation_rad.max(LEAST))
}

/// Error against run time: curves of methods with steps, points of exact methods and of failed runs.
pub(super) fn figure(bench: &Bench) -> ReportFigure {
    let place = |point: &Point| (point.seconds.least, drawn(point.errors));
    let (exact, stepped): (Vec<_>, Vec<_>) = (bench.curves.iter()).partition(|curve| curve.theory == Theory::Exact);
    let runs = bench.curves.iter().flat_map(|curve| &curve.points);
    let failed = runs.filter(|point| point.errors.is_none());
    let failed = Points::of("failed", failed, |point| (point.seconds.least, FAILED));
    ReportFigure::new(
        [
            &format!("work-precision-{}", bench.name),
            &format!("Error against run time, one rod, r_e = {}", bench.aspect_ratio),
        ],
        format!(
            "One rod over {:.5} periods, into a flip; the least of repeated runs, on one core. An error of 0 is drawn \
             at {LEAST:.0e}, a run that failed at {FAILED}.",
            bench.turns
        ),
        ["log run time (s)", "log angle to the closed form (rad)"],
    )
    .curves(stepped.iter().map(|curve| Curve::of(&curve.integrator, &curve.points, place)))
    .points(exact.iter().map(|curve| Points::of(&curve.integrator, &curve.points, place)))
    .points((!failed.x.is_empty()).then_some(failed))
    .spans(Some((1e-8, 0.1)), Some((LEAST, FAILED)))
    .judged("A.1 to A.5, eq. 20", &["integrator-orders", "exact-propagator-round-off"])
}

/// The error of every method with steps against the number of steps.
pub fn orders_figure(orders: &Orders) -> ReportFigure {
    let curve = |study: &Convergence| {
        Curve::of(&study.integrator, &study.halvings, |halving| (halving.steps as f64, drawn(halving.errors)))
    };
    ReportFigure::new(
        ["orders", "Error against the number of steps"],
        "Twice the steps divide the error by 2, 4 or 16 for methods of order 1, 2 or 4, down to round-off.",
        ["log steps", "log angle to the closed form (rad)"],
    )
    .curves(orders.studies.iter().map(curve))
    .judged("A.1 to A.5", &["integrator-orders", "grid-convergence-index"])
}

/// A curve of a bench and one of its points.
type Chosen<'a> = Option<(&'a IntegratorCurve, &'a Point)>;

fn named(chosen: Chosen) -> String {
    chosen.map_or(NOT_REACHED.into(), |(curve, _)| curve.integrator.clone())
}

fn timed(chosen: Chosen) -> Option<f64> {
    chosen.map(|(_, point)| point.seconds.least)
}

/// The cheapest integrator for each error and aspect ratio.
pub(super) fn cheapest(benches: &[Bench]) -> ReportTable {
    type Row<'a> = (&'a Bench, f64, Chosen<'a>, Chosen<'a>);
    let row = |bench, target| -> Row {
        let steps = |theory| theory != Theory::Exact;
        (bench, target, Bench::cheapest(bench, target, |_| true), Bench::cheapest(bench, target, steps))
    };
    ReportTable::new(
        ["work-precision", "For an error: the cheapest integrator and its time"],
        "One rod into the middle of its third flip. A point counts where the next finer one reaches the error too.",
        (benches.iter()).flat_map(|bench| TARGETS_RAD.map(|target| row(bench, target))),
        vec![
            field("r_e", |r: &Row| r.0.aspect_ratio),
            number("error (rad)", powers(0), |r: &Row| r.1),
            words("cheapest", |r: &Row| named(r.2)),
            number("time", time, |r: &Row| timed(r.2)).or(""),
            words("cheapest that takes steps", |r: &Row| named(r.3)),
            number("time of that", time, |r: &Row| timed(r.3)).or(""),
        ],
    )
}

/// The exact propagator's time over the cheapest adaptive integrator's.
fn ratio(benches: &[Bench]) -> ReportTable {
    type Row<'a> = (&'a Bench, Chosen<'a>, Chosen<'a>);
    fn row(bench: &Bench) -> Row<'_> {
        let exact = bench.curves.iter().find(|curve| curve.theory == Theory::Exact);
        let exact = exact.and_then(|curve| Some((curve, curve.points.first()?)));
        (bench, exact, bench.cheapest(1e-6, |theory| theory == Theory::Adaptive))
    }
    ReportTable::new(
        ["exact-against-adaptive", "The exact propagator against the cheapest adaptive integrator"],
        "The propagator's time for round-off error over the cheapest adaptive integrator's for 10⁻⁶ rad.",
        benches.iter().map(row),
        vec![
            field("r_e", |r: &Row| r.0.aspect_ratio),
            number("error of the propagator (rad)", powers(1), |r: &Row| Some(r.1?.1.error_rad())).or(NOT_REACHED),
            number("its time", time, |r: &Row| timed(r.1)).or(NOT_REACHED),
            words("adaptive, for 1e-6", |r: &Row| named(r.2)),
            number("its time for 1e-6", time, |r: &Row| timed(r.2)).or(NOT_REACHED),
            number("ratio", |x| format!("1/{:.0}", 1.0 / x), |r: &Row| Some(timed(r.1)? / timed(r.2)?)),
        ],
    )
}

/// The time of every integrator of a bench for each error, then its smallest error.
pub(super) fn every_integrator(bench: &Bench) -> ReportTable {
    let best = |curve: &IntegratorCurve| Some((curve.best()?.clone(), curve.best()?.errors?));
    let mut columns: Vec<Column<IntegratorCurve>> =
        vec![words("integrator", |c: &IntegratorCurve| c.integrator.clone())];
    columns.extend(TARGETS_RAD.map(|target| {
        number(format!("{target:.0e} rad"), time, move |c: &IntegratorCurve| {
            c.cheapest(target).map(|point| point.seconds.least)
        })
        .or(NOT_REACHED)
    }));
    columns.extend([
        number("best (rad)", powers(1), move |c: &IntegratorCurve| best(c).map(|b| b.1.orientation_rad)),
        number("C_b", powers(1), move |c: &IntegratorCurve| best(c).map(|b| b.1.orbit_constant)),
        number("t/T", powers(1), move |c: &IntegratorCurve| best(c).map(|b| b.1.phase_turns)),
        words("setting", move |c: &IntegratorCurve| best(c).map_or("failed".into(), |b| b.0.setting.to_string())),
        words("time", move |c: &IntegratorCurve| {
            let seconds = best(c).map(|b| b.0.seconds);
            seconds.map_or(NONE.into(), |s| format!("{} to {}", time(s.least), time(s.most)))
        }),
        words("failed", |c: &IntegratorCurve| format!("{} of {}", c.failures(), c.points.len())),
    ]);
    ReportTable::new(
        [&format!("work-precision-{}", bench.name), &format!("Every integrator at r_e = {}", bench.aspect_ratio)],
        "Times for an error, then the smallest error found: the angle, C_b and the phase at one setting.",
        &bench.curves,
        columns,
    )
}

/// The table of observed orders.
pub fn orders_table(orders: &Orders) -> ReportTable {
    let verdict = |study: &Convergence| match study.found {
        OrderVerdict::AsTheory => "as theory",
        OrderVerdict::Not => "NOT as theory",
        OrderVerdict::Unsettled => "still changing",
        OrderVerdict::RoundOff => "at round-off",
        OrderVerdict::TooCoarse => "too coarse",
    };
    let observed = |study: &Convergence| {
        let observed: Vec<_> = study.observed.iter().map(|order| format!("{order:+.3}")).collect();
        observed.join(" ")
    };
    type Format<'a> = &'a dyn Fn(f64) -> String;
    fn extrapolated<'a>(name: &str, format: Format<'a>, value: fn(&Richardson) -> f64) -> Column<'a, Convergence> {
        number(name, format, move |study: &Convergence| study.richardson.as_ref().map(value))
    }
    ReportTable::new(
        ["orders", "Observed order, Richardson's value and grid convergence index"],
        format!(
            "{}. The core itself takes no step for a free rod: these are the orders of integrators that do. Orders of \
             the angle's error on the last two pairs before round-off, negative where it grows; the rest is of |p_1|, \
             from three grids: its index is to bound its error.",
            orders.problem
        ),
        &orders.studies,
        vec![
            words("integrator", |s: &Convergence| s.integrator.clone()),
            words("theory", |s: &Convergence| s.theory.to_string()),
            words("observed", observed),
            words("verdict", verdict),
            extrapolated("steps", &|steps| steps.to_string(), |r| r.steps as f64),
            extrapolated("order of |p_1|", &|order| format!("{order:+.3}"), |r| r.order),
            extrapolated("at Δt = 0", &decimals(12), |r| r.value),
            extrapolated("off by", &powers(1), |r| r.error),
            extrapolated("index", &powers(1), |r| r.index),
            extrapolated("error", &powers(1), |r| r.true_error),
        ],
    )
}

/// The text for an error that no setting reaches.
pub(crate) const NOT_REACHED: &str = "not reached";

/// Seconds as a text with a suitable unit.
pub fn time(seconds: f64) -> String {
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
