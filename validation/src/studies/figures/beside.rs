//! The numbers beside a figure: its own curves and points at a few abscissas.

use crate::present::plot::{Curve, Figure};
use crate::present::study::ReportFigure;
use crate::present::table::{Column, ReportTable, estimate, number};

/// Abscissas against time. Rods are where they were every half period, so whole and half periods alone would show free
/// ones as still.
const PERIODS: [f64; 17] =
    [0.0, 0.25, 0.5, 0.75, 1.0, 1.25, 1.5, 1.75, 2.0, 2.75, 3.0, 3.75, 4.0, 4.75, 5.0, 5.75, 6.0];

/// A row for each point of the first series, or against time for each of [`PERIODS`]; a column for each series.
pub(super) fn table(figure: &ReportFigure) -> ReportTable {
    let picture = &figure.figure;
    let rows: Vec<f64> = match picture.points.first() {
        Some(points) if picture.x_span.is_none() => points.x.clone(),
        _ => PERIODS.to_vec(),
    };
    let mut columns: Vec<Column<f64>> = vec![number(&picture.x_name, |x| x.to_string(), |x: &f64| *x)];
    columns.extend(series(picture).into_iter().map(column));
    ReportTable::new(
        [&figure.name, &picture.title],
        "Numbers of the picture, with half the width of their 95 % intervals; `–` where there is none within T/8.",
        rows,
        columns,
    )
}

/// Curves, and points as curves; measured points have abscissas of their own and are in the CSV alone.
fn series(figure: &Figure) -> Vec<Curve> {
    let curves = figure.curves.iter().cloned();
    let points = (figure.points.iter().filter(|_| figure.x_span.is_none())).map(|points| Curve {
        label: points.label.clone(),
        x: points.x.clone(),
        y: points.y.clone(),
        half_band: points.y_error.clone(),
    });
    points.chain(curves).collect()
}

fn column<'a>(curve: Curve) -> Column<'a, f64> {
    let Curve { label, x, y, half_band } = curve;
    let near = move |wanted: &f64| {
        let apart = |k: &usize| (x[*k] - wanted).abs();
        let nearest = (0..x.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
        nearest.filter(|k| apart(k) <= 0.125)
    };
    match half_band {
        Some(half) => estimate(
            label,
            |y, half| format!("{y:.3} ± {half:.3}"),
            move |wanted| near(wanted).map(|k| (y[k], half[k])),
        ),
        None => number(label, |y| format!("{y:.3}"), move |wanted| near(wanted).map(|k| y[k])),
    }
}
