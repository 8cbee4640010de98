//! The table for a figure: its own curves and points at a few abscissas.

use super::*;

/// A row for each point of the first series, or against time for each quarter of a period at which a series has a
/// value: free rods return every half period, so that whole and half periods alone would show no motion. One column for
/// each series.
pub(super) fn table(figure: &ReportFigure) -> ReportTable {
    let picture = &figure.figure;
    let series = series(picture);
    let quarters = (0..=24).map(|k| 0.25 * f64::from(k));
    let rows: Vec<f64> = match picture.points.first() {
        Some(points) if picture.x_span.is_none() => points.x.clone(),
        _ => quarters.filter(|t| series.iter().any(|curve| near(curve, *t).is_some())).collect(),
    };
    let mut columns: Vec<Column<f64>> = vec![field(&picture.x_name, |x: &f64| *x)];
    columns.extend(series.into_iter().map(column));
    ReportTable::new(
        [&figure.name, &picture.title],
        "Numbers of the picture, with half the width of their 95 % intervals; `–` where there is none within T/8.",
        rows,
        columns,
    )
}

/// Curves, and points as curves; measured points have abscissas of their own and are only in the CSV.
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

/// The point of a curve that is nearest to an abscissa, and at most T/8 from it.
fn near(curve: &Curve, wanted: f64) -> Option<usize> {
    let apart = |k: &usize| (curve.x[*k] - wanted).abs();
    let nearest = (0..curve.x.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
    nearest.filter(|k| apart(k) <= 0.125)
}

fn column<'a>(curve: Curve) -> Column<'a, f64> {
    let label = curve.label.clone();
    match curve.half_band.clone() {
        Some(half) => estimate(label, move |wanted: &f64| near(&curve, *wanted).map(|k| (curve.y[k], half[k]))),
        None => number(label, decimals(3), move |wanted: &f64| near(&curve, *wanted).map(|k| curve.y[k])),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_without_a_value_are_left_out() {
        let maxima = Curve::with_band("a", [0.0, 0.48, 1.02], |t| (t, 0.5 - 0.1 * t, 0.00123 * t));
        let figure = ReportFigure::new(["synthetic", "Synthetic"], "", ["t/T", "A₁"])
            .curves([maxima, Curve::of("b", [0.5], |t| (t, 0.25))])
            .spans(Some((0.0, 6.0)), None);
        let rows = [["0", "0.5", "–"], ["0.5", "0.45200 ± 0.00059", "0.250"], ["1", "0.3980 ± 0.0013", "–"]];
        assert_eq!(table(&figure).rows, rows.map(|row| row.map(String::from).to_vec()));
    }
}
