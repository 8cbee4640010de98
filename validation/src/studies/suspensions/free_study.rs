//! The study of free suspensions: how to choose their initial directions.

use super::free::{Amount, Bench, Point, SCENES, StartCurve, TARGETS};
use super::*;
use crate::studies::work_precision::Budget;
use crate::studies::work_precision::rows::seconds;
use crate::studies::work_precision::study::{NOT_REACHED, time};

pub const STUDY: Study = Study {
    name: "free-suspensions",
    title: "Free suspensions: error against run time",
    question: "Which sampling of free rods reaches an error of X̄₁ soonest?",
    cases: &["free-suspension-rates", "free-isotropic", "free-polydisperse", "replicas-are-independent"],
    command: "cargo run --release -- bench --case fig6-uniform --case fig6-polydisperse",
    parts: &[SCENES[0].scene, SCENES[1].scene],
    shared: false,
    run,
};

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let amount = request.effort.pick(Amount::QUICK, Amount::FULL);
    let budget = request.effort.pick(Budget::QUICK, Budget::FULL);
    let chosen = SCENES.into_iter().filter(|free| (request.wanted)(free.scene));
    let benches: Vec<_> = chosen.map(|free| free.bench(amount, budget)).collect();
    let curves = benches.first().map_or(&[][..], |bench| &bench.curves);
    let steepest = curves.iter().min_by(|a, b| a.exponent.total_cmp(&b.exponent));
    let answer = steepest.map_or(String::new(), |curve| {
        format!(
            "Of {} ways the error falls fastest with {}: with the slope {:+.2} ± {:.2} against N.",
            curves.len(),
            curve.start,
            curve.exponent,
            curve.exponent_se
        )
    });
    let mut exhibits: Vec<Exhibit> = benches.iter().map(|bench| figure(bench).into()).collect();
    exhibits[0].table = Some(table(&benches));
    let files = [
        ("suspensions.csv", points_csv(&benches)?),
        ("suspensions.json", build::json(&BTreeMap::from([("benches", &benches)]))?),
    ];
    Ok(Some(Findings::new(answer, exhibits, files)))
}

fn points_csv(benches: &[Bench]) -> Result<String, String> {
    type Row<'a> = (&'a Bench, &'a StartCurve, &'a Point);
    let points = benches.iter().flat_map(|bench| {
        let curves = bench.curves.iter();
        curves.flat_map(move |curve| curve.points.iter().map(move |point| (bench, curve, point)))
    });
    let mut columns = vec![
        words("scene", |r: &Row| r.0.free.scene),
        field("t_over_t", |r: &Row| r.0.free.turns),
        words("start", |r: &Row| r.1.start),
        field("rods", |r: &Row| r.2.rods),
        field("x1_rms_error", |r: &Row| r.2.error),
        field("trials", |r: &Row| r.2.trials),
    ];
    columns.extend(seconds(|r: &Row| r.2.seconds));
    columns_csv(points, columns)
}

fn table(benches: &[Bench]) -> ReportTable {
    type Of<'a> = (&'a Bench, &'a StartCurve);
    let rows = benches.iter().flat_map(|bench| bench.curves.iter().map(move |c| (bench, c)));
    let mut columns: Vec<Column<Of>> = vec![
        words("scene", |r: &Of| r.0.free.scene),
        words("start", |r: &Of| r.1.start),
        number("theory", |x| format!("{x:+.2}"), |r: &Of| r.1.theory),
        difference("exponent", |r: &Of| (r.1.exponent, r.1.exponent_se)),
    ];
    columns.extend(TARGETS.map(|target| {
        words(format!("error {target:.0e}"), move |r: &Of| match r.1.cheapest(target) {
            Some(point) => format!("{} ({} rods)", time(point.seconds.least), point.rods),
            None => NOT_REACHED.into(),
        })
    }));
    ReportTable::new(
        ["suspension-starts", "Free suspensions: the time for an error of X̄₁, by the sampling of the rods"],
        "Isotropic rods without collisions at t/T = 0.95, against the closed form; root mean square over trials. The \
         exponent is of the number of rods in the error, over 10³ rods and more. No time step is taken: the whole \
         error is that of the sample (`free-suspension-rates`). Strata of unequal rods resolve the flips, and reach \
         the exponent of theory, from 10⁵ rods on only.",
        rows,
        columns,
    )
}

fn figure(bench: &Bench) -> ReportFigure {
    let free = &bench.free;
    let curve = |curve: &StartCurve| {
        let label = format!("{}: slope {:+.2} ± {:.2}", curve.start, curve.exponent, curve.exponent_se);
        Curve::of(label, &curve.points, |point| (point.seconds.least, point.error))
    };
    let title = format!("Free rods, r_e = {}, σ = {} %: error against run time", free.aspect_ratio, free.sd_percent);
    ReportFigure::new(
        [&format!("suspension-starts-{}", free.scene), &title],
        format!(
            "Scene {} at t/T = {}, from 100 rods on; sampling and moving the rods once, on one core.",
            free.scene, free.turns
        ),
        ["log run time (s)", "log rms error of X̄₁"],
    )
    .curves(bench.curves.iter().map(curve))
    .judged("eqs 4, 11, 12", &["free-suspension-rates", "free-isotropic"])
}
