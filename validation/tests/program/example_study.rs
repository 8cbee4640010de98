use validation::judge::lab::{changed, free_scene, per_replica};
use validation::present::plot::{Curve, Figure};
use validation::judge::statistics::covariance;
use validation::present::study::{Exhibit, Extent, Found, ReportFigure, Study};
use validation::present::table::{ReportTable, field, number};

pub const STUDY: Study = Study {
    name: "rods-and-scatter",
    title: "How X̄₁ scatters with the number of rods",
    question: "How many rods does a mean need?",
    cases: &["free-isotropic"],
    command: "cargo run --release -- bench --case rods-and-scatter",
    benches: || vec!["rods-and-scatter".to_owned()],
    shared: false,
    run,
};

struct Row {
    rods: usize,
    sd: f64,
}

fn run(extent: &Extent) -> Result<Option<Found>, String> {
    if !(extent.wanted)(STUDY.name) {
        return Ok(None);
    }
    let sd = |rods| {
        let scene = changed(free_scene(extent.effort), |scene| scene.particles.count = rods);
        let x1 = per_replica(&scene, 400, |mean| mean(shearbed::observable::Channel::X[0], 0));
        covariance(&x1, &x1).sqrt()
    };
    let rows = [10, 100, 1000].map(|rods| Row { rods, sd: sd(rods) });
    let table = ReportTable::new(
        [STUDY.name, STUDY.title],
        "Standard deviation of X̄₁ at the start, over 400 replicas of free rods.",
        &rows,
        vec![
            field("rods", |row: &&Row| row.rods),
            number("standard deviation", |sd| format!("{sd:.4}"), |row: &&Row| row.sd),
            number("times √rods", |x| format!("{x:.3}"), |row: &&Row| row.sd * (row.rods as f64).sqrt()),
        ],
    );
    let of = |value: fn(&Row) -> f64| rows.iter().map(value).collect();
    let figure = ReportFigure {
        name: STUDY.name.into(),
        caption: "It falls as one over the root of the number of rods.".into(),
        figure: Figure {
            x_name: "rods".into(),
            y_name: "standard deviation of X̄_1".into(),
            x_log: true, y_log: true,
            curves: vec![Curve { x: of(|row| row.rods as f64), y: of(|row| row.sd), ..Default::default() }],
            ..Default::default()
        },
        ..Default::default()
    };
    let files = vec![(format!("{}.csv", STUDY.name), table.csv()?)];
    let answer = format!("A mean over 100 rods scatters by {:.3}.", rows[1].sd);
    Ok(Some(Found { answer, exhibits: vec![Exhibit::both(figure, table)], files, ..Default::default() }))
}
