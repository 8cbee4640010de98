//! The time of a step against the number of rods and their concentration.

use super::{Speed, Step};
use crate::present::plot::{Curve, Figure};
use crate::present::study::ReportFigure;

/// Both pictures.
pub fn figures(speed: &Speed) -> Vec<ReportFigure> {
    let y = |steps: &[Step], of: fn(&Step) -> Option<f64>| -> Vec<f64> {
        steps.iter().map(|step| of(step).unwrap_or(f64::NAN)).collect()
    };
    let curve = |label: &str, x: Vec<f64>, y| Curve { label: label.into(), x, y, half_band: None };
    let rods: Vec<_> = speed.by_rods.iter().map(|step| step.rods as f64).collect();
    let concentrations: Vec<_> =
        (speed.by_concentration.iter()).map(|step| step.concentration_per_cm3).collect();
    let figure = |name: &str, title: &str, x_name: &str, curves, caption: &str| ReportFigure {
        name: name.into(),
        figure: Figure {
            title: title.into(),
            x_name: x_name.into(),
            y_name: "time per rod and step (ns)".into(),
            curves,
            x_log: true,
            y_log: true,
            ..Figure::default()
        },
        caption: caption.into(),
        source: "eqs 5–14".into(),
        cases: vec!["naive-reference".into()],
    };
    vec![
        figure(
            "speed-rods",
            "Time of a step against the number of rods, 50 per cm³",
            "rods",
            vec![
                curve("core", rods.clone(), y(&speed.by_rods, |step| Some(step.core_ns))),
                curve("naive reference", rods, y(&speed.by_rods, |step| step.naive_ns)),
            ],
            "One core. Up to 256 rods the core looks at all pairs; beyond, it sorts the rods into cells.",
        ),
        figure(
            "speed-concentration",
            "Time of a step against the concentration, 1000 rods",
            "n (per cm³)",
            vec![curve("core", concentrations, y(&speed.by_concentration, |step| Some(step.core_ns)))],
            "One core. Dilute, nobody is near; dense, most rods make a candidate and the contacts cost.",
        ),
    ]
}
