use serde::Serialize;
use shearbed::observable::Channel;
use shearbed_validation::judge::lab::{changed, free_scene, per_replica};
use shearbed_validation::judge::statistics::covariance;
use shearbed_validation::present::plot::Curve;
use shearbed_validation::present::study::{Exhibit, Findings, ReportFigure, Request, Study};
use shearbed_validation::present::table::{ReportTable, decimals, field, number, rows_csv};

pub const STUDY: Study = Study {
    name: "rods-and-scatter",
    title: "How X̄₁ scatters with the number of rods",
    question: "How many rods does a mean need?",
    cases: &["free-isotropic"],
    command: "cargo run --release -- bench --case rods-and-scatter",
    parts: &["rods-and-scatter"],
    shared: false,
    run,
};

#[derive(Clone, Copy, Default, Serialize)]
struct Scatter {
    rods: usize,
    sd: f64,
}

fn run(request: &Request) -> Result<Option<Findings>, String> {
    let rows = [10, 100, 1000].map(|rods| {
        let scene = changed(free_scene(request.effort), |scene| scene.particles.count = rods);
        let x1 = per_replica(&scene, 400, |mean| mean(Channel::X[0], 0));
        Scatter { rods, sd: covariance(&x1, &x1).sqrt() }
    });
    let table = ReportTable::new(
        [STUDY.name, STUDY.title],
        "Standard deviation of X̄₁ at the start, over 400 replicas of free rods.",
        rows,
        vec![
            field("rods", |row: &Scatter| row.rods),
            number("standard deviation", decimals(4), |row: &Scatter| row.sd),
            number("times √rods", decimals(3), |row: &Scatter| row.sd * (row.rods as f64).sqrt()),
        ],
    );
    let figure = ReportFigure::new(
        [STUDY.name, STUDY.title],
        "It falls as one over the root of the number of rods.",
        ["log rods", "log standard deviation of X̄_1"],
    )
    .curves([Curve::of("free rods", rows, |row| (row.rods as f64, row.sd))])
    .judged("eq. 4", STUDY.cases);
    let answer = format!("A mean over 100 rods scatters by {:.3}.", rows[1].sd);
    let files = [("rods-and-scatter.csv", rows_csv(rows)?)];
    Ok(Some(Findings::new(answer, vec![Exhibit::both(figure, table)], files)))
}
