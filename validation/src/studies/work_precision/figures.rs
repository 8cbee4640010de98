//! Error against run time as pictures.

use super::order::Orders;
use super::{Bench, IntegratorCurve};
use crate::present::plot;
use crate::present::study::ReportFigure;
use crate::studies::integrators::Theory;

/// Where failed runs are drawn: above every error, which is π/2 at most.
const FAILED: f64 = 10.0;

/// An error of 0 has no place on a logarithmic axis; it is drawn here.
const LEAST: f64 = 1e-17;

/// A picture for each bench.
pub fn figures(benches: &[Bench]) -> Vec<ReportFigure> {
    benches.iter().map(figure).collect()
}

fn figure(bench: &Bench) -> ReportFigure {
    let (exact, stepped): (Vec<_>, Vec<_>) =
        (bench.curves.iter()).partition(|curve| curve.theory == Theory::Exact);
    let mut points: Vec<_> = exact.into_iter().map(single).collect();
    let failed = failed(&bench.curves);
    if !failed.x.is_empty() {
        points.push(failed);
    }
    ReportFigure {
        name: format!("work-precision-{}", bench.name),
        figure: plot::Figure {
            title: format!("Error against run time, one rod, r_e = {}", bench.aspect_ratio),
            x_name: "run time (s)".into(),
            y_name: "angle to the closed form (rad)".into(),
            curves: stepped.into_iter().map(line).collect(),
            points,
            x_log: true,
            y_log: true,
            x_span: Some((1e-8, 0.1)),
            y_span: Some((LEAST, FAILED)),
            grid: None,
        },
        caption: format!(
            "One rod over {:.5} periods, into a flip; the least of repeated runs, on one core. \
             An error of 0 is drawn at {LEAST:.0e}, a run that failed at {FAILED}.",
            bench.turns
        ),
        source: "A.1 to A.5, eq. 20".into(),
        cases: vec!["subject-orders".into(), "exact-propagator-round-off".into()],
    }
}

/// The error of every method with steps against the step.
pub fn orders(orders: &Orders) -> ReportFigure {
    let curve = |study: &super::order::Convergence| plot::Curve {
        label: study.subject.clone(),
        x: study.halvings.iter().map(|h| h.steps as f64).collect(),
        y: (study.halvings.iter())
            .map(|h| h.errors.map_or(f64::NAN, |errors| errors.orientation_rad.max(LEAST)))
            .collect(),
        half_band: None,
    };
    ReportFigure {
        name: "orders".into(),
        figure: plot::Figure {
            title: "Error against the number of steps".into(),
            x_name: "steps".into(),
            y_name: "angle to the closed form (rad)".into(),
            curves: orders.studies.iter().map(curve).collect(),
            x_log: true,
            y_log: true,
            ..Default::default()
        },
        caption: "Twice the steps divide the error by 2, 4 or 16 for methods of order 1, 2 or 4, down to round-off.".into(),
        source: "A.1 to A.5".into(),
        cases: vec!["subject-orders".into(), "grid-convergence-index".into()],
    }
}

fn line(curve: &IntegratorCurve) -> plot::Curve {
    plot::Curve {
        label: curve.subject.clone(),
        x: curve.points.iter().map(|point| point.seconds.least).collect(),
        y: (curve.points.iter())
            .map(|point| point.errors.map_or(f64::NAN, |errors| errors.orientation_rad.max(LEAST)))
            .collect(),
        half_band: None,
    }
}

fn single(curve: &IntegratorCurve) -> plot::Points {
    let line = line(curve);
    plot::Points { label: line.label, x: line.x, y: line.y, ..Default::default() }
}

fn failed(curves: &[IntegratorCurve]) -> plot::Points {
    let points = curves.iter().flat_map(|curve| &curve.points);
    let x: Vec<_> =
        (points.filter(|point| point.errors.is_none())).map(|point| point.seconds.least).collect();
    plot::Points { label: "failed".into(), y: vec![FAILED; x.len()], x, ..Default::default() }
}
