//! A made-up report with one element of each kind.

use super::*;

pub fn synthetic() -> Report {
    let caught = [("sign of the spin", true), ("factor 2", true)];
    let within = |error| Rule::within(error, 1e-12, "synthetic: 10⁴ round-offs");
    let supply = "Put the points of Fig. 3 into a file, and call with --data DIR.";
    let outcomes = vec![
        outcome(
            "synthetic-pass",
            Verdict::Pass,
            vec![Rule::exact(0.0), mean(0.001), within(-2.5e-13), p_value(0.31)],
            &caught,
        ),
        outcome("synthetic-p-value", Verdict::Pass, vec![p_value(0.31)], &caught),
        outcome("synthetic-fail", Verdict::Fail, vec![within(0.9e-12), within(f64::NAN), within(3e-12)], &caught),
        outcome(
            "synthetic-blind",
            Verdict::Fail,
            vec![Rule::exact(0.0)],
            &[("sign of the spin", true), ("factor < 2", false)],
        ),
        outcome("synthetic-empty", Verdict::Fail, vec![], &[]),
        outcome("synthetic-underpowered", Verdict::Underpowered, vec![mean(0.02)], &caught),
        outcome("synthetic-no-data", Verdict::NoData, vec![Rule::NoData { supply: supply.into() }], &[]),
    ];
    let figure = ReportFigure {
        name: "synthetic".into(),
        figure: Figure {
            title: "Synthetic curve".into(),
            x_name: "t/T (periods)".into(),
            y_name: "mean axial projection (–)".into(),
            curves: vec![Curve::of("synthetic", (0..=60).map(|k| 0.1 * f64::from(k)), |x| (x, x.sin()))],
            ..Default::default()
        },
        caption: "What to see: a wave & nothing else.".into(),
        source: "Fig. 4".into(),
        cases: vec!["synthetic-pass".into()],
    };
    let table = ReportTable::new(
        ["synthetic", "Synthetic numbers"],
        "What to see: `synthetic-pass`.",
        [1.0, 2.5],
        vec![number("x (s)", |x| format!("{x:.1}"), |x: &f64| *x), words("in words", |x: &f64| format!("<{x}>"))],
    );
    let mut study = ReportStudy::default();
    for (field, text) in [
        (&mut study.name, "synthetic"),
        (&mut study.title, "A synthetic study"),
        (&mut study.question, "Is it synthetic?"),
        (&mut study.answer, "It is, 1 < 2 & so on."),
        (&mut study.command, "shearbed bench --case synthetic"),
    ] {
        *field = text.into();
    }
    study.cases = vec!["synthetic-fail".into()];
    study.exhibits = vec![Exhibit::both(figure, table)];
    let mut report = build(
        outcomes,
        Sections {
            studies: vec![study],
            equations: vec![ReportEquation {
                number: "A.4".into(),
                says: "a synthetic equation".into(),
                code: vec!["nothing::at_all".into()],
                cases: vec!["synthetic-pass".into()],
            }],
            ..Default::default()
        },
        &EFFORT,
        "shearbed validate --out 'a<b'".into(),
    );
    report.origin = Origin {
        command: "shearbed validate --out 'a<b'".into(),
        version: "0.0.0".into(),
        commit: "0123456789ab".into(),
        sources: "fedcba9876543210".into(),
        rustc: "rustc 0.0.0".into(),
        build: "release".into(),
        processor: "a synthetic processor".into(),
        threads: 2,
        system: "none".into(),
        date: "2000-01-01T00:00:00Z".into(),
        seeds: "none".into(),
        points: vec![Stated {
            file: "a.toml".into(),
            paper: "synthetic <points>, not a measurement".into(),
            figure: "Fig. S".into(),
            digitised_by: "nobody".into(),
            tool: "none".into(),
            date: "2000-01-01".into(),
        }],
    };
    report
}
