//! The table for a figure: its own curves and points at a few abscissas.

use super::*;

/// A row for each abscissa of a result with an error, or against time for each quarter of a period at which a series
/// has a value: free rods return every half period, so that whole and half periods alone would show no motion. One
/// column for each series.
pub(super) fn table(figure: &ReportFigure) -> ReportTable {
    let picture = &figure.figure;
    let series = series(picture);
    let quarters = (0..=24).map(|k| 0.25 * f64::from(k));
    let (rows, within) = if picture.x_span.is_none() {
        let results = series.iter().filter(|curve| curve.half_band.is_some());
        let mut rows: Vec<f64> = results.flat_map(|curve| curve.x.iter().copied()).collect();
        rows.sort_by(f64::total_cmp);
        rows.dedup();
        (rows, 0.0)
    } else {
        let value = |t: &f64| series.iter().any(|curve| near(curve, *t, EIGHTH).is_some());
        (quarters.filter(value).collect(), EIGHTH)
    };
    let short = |x: f64| ((1e4 * x).round() / 1e4).to_string();
    let mut columns: Vec<Column<f64>> = vec![number(&picture.x_name, short, |x: &f64| *x)];
    columns.extend(series.into_iter().map(|curve| column(curve, within)));
    let rule = if within > 0.0 { "; `–` where there is none within T/8" } else { "" };
    ReportTable::new(
        [&figure.name, &picture.title],
        format!("Numbers of the picture, ± their standard errors{rule}."),
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

/// An eighth of a period.
pub(super) const EIGHTH: f64 = 0.125;

/// The point of a curve that is nearest to an abscissa, and at most `within` from it: its ordinate and ±.
pub(super) fn near(curve: &Curve, wanted: f64, within: f64) -> Option<[f64; 2]> {
    let apart = |k: &usize| (curve.x[*k] - wanted).abs();
    let nearest = (0..curve.x.len()).min_by(|a, b| apart(a).total_cmp(&apart(b)));
    let half = |k: usize| curve.half_band.as_ref().map_or(f64::NAN, |half| half[k]);
    nearest.filter(|k| apart(k) <= within).map(|k| [curve.y[k], half(k)])
}

fn column<'a>(curve: Curve, within: f64) -> Column<'a, f64> {
    let (label, has_error) = (curve.label.clone(), curve.half_band.is_some());
    let near = move |wanted: &f64| near(&curve, *wanted, within);
    if has_error {
        estimate(label, move |wanted: &f64| near(wanted).map(<(f64, f64)>::from))
    } else {
        number(label, decimals(3), move |wanted: &f64| near(wanted).map(|[y, _]| y))
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

    #[test]
    fn beside_points_stands_the_curve_at_their_place_alone() {
        let figure = ReportFigure::new(["synthetic", "Synthetic"], "", ["r_e", "φ"])
            .curves([Curve::of("theory", [5.0, 11.5, 11.6], |r| (r, r / 8.0)), Curve::of("other", [5.1], |r| (r, r))])
            .points([Points::with_bars("measured", [5.0, 11.6], |r| (r, 1.0, 0.25))]);
        let rows = [["5", "1.00 ± 0.25", "0.625", "–"], ["11.6", "1.00 ± 0.25", "1.450", "–"]];
        assert_eq!(table(&figure).rows, rows.map(|row| row.map(String::from).to_vec()));
    }
}
