//! A fit as pictures: points with the best curve and its band, residuals, profiles, and the region of two parameters.

use super::data::{Datum, kinds};
use super::emulator::Model;
use super::profile::{contour, rise_of_several};
use super::report::{Report, levels};
use super::search::{Fit, Watch};
use crate::present::plot::{Curve, Figure, Points};
use rayon::prelude::*;

/// Times of a drawn curve.
const TIMES: usize = 200;

/// The most replicas behind a drawn curve.
const MOST_REPLICAS: u64 = 100;

/// 95 % of a Gaussian.
const WIDE: f64 = 1.96;

/// The places at which the curve of each data set and column is drawn, as points without a value.
pub fn places(data: &[Datum]) -> Vec<Datum> {
    let mut all = Vec::new();
    for (set, column) in kinds(data) {
        let here = data.iter().filter(|datum| (datum.set, &datum.column) == (set, &column));
        let last = here.map(|datum| datum.time).fold(0.0, f64::max);
        all.extend((0..=TIMES).map(|k| Datum::place(set, &column, last * k as f64 / TIMES as f64)));
    }
    all
}

/// Means over replicas at every place, and the square of their standard error.
type Mean = Vec<(f64, f64)>;

fn mean(model: &Model<'_>, values: &[f64], replicas: u64, watch: &Watch<'_>) -> Result<Mean, String> {
    let replica = model(values)?;
    (watch.planned)(replicas);
    let one = |k: u64| {
        let found = replica(k);
        (watch.done)();
        found
    };
    let rows: Vec<_> = (0..replicas).into_par_iter().map(one).collect::<Result<_, String>>()?;
    let n = rows.len() as f64;
    let of = |place: usize| {
        let mean = rows.iter().map(|row| row[place][0]).sum::<f64>() / n;
        let square: f64 = rows.iter().map(|row| (row[place][0] - mean).powi(2)).sum();
        (mean, square / (n * (n - 1.0)))
    };
    Ok((0..rows[0].len()).map(of).collect())
}

/// The best curve at the `places` of [`places`], of which `model` is the model, and half its 95 % band: the replicas' error,
/// and what one standard deviation along each axis of the parameters' covariance changes.
pub fn best_curves(
    fit: &Fit,
    places: &[Datum],
    model: &Model<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<(f64, f64)>, String> {
    let replicas = (fit.emulator.replicas() as u64).min(MOST_REPLICAS);
    let best = mean(model, &fit.values(&fit.best.place), replicas, watch)?;
    let mut variance: Vec<f64> = best.iter().map(|(_, square)| *square).collect();
    let axes = fit.best.covariance().symmetric_eigen();
    for (length, way) in axes.eigenvalues.iter().zip(axes.eigenvectors.column_iter()) {
        let side = |sign: f64| {
            let step = sign * length.max(0.0).sqrt();
            let place: Vec<f64> =
                fit.best.place.iter().zip(way.iter()).map(|(p, way)| p + step * way).collect();
            mean(model, &fit.values(&place), replicas, watch)
        };
        let (above, below) = (side(1.0)?, side(-1.0)?);
        for ((variance, above), below) in variance.iter_mut().zip(above).zip(below) {
            *variance += (0.5 * (above.0 - below.0)).powi(2);
        }
    }
    Ok((best.iter().zip(variance).take(places.len()))
        .map(|((mean, _), variance)| (*mean, WIDE * variance.sqrt()))
        .collect())
}

/// Every picture with the stem of its file's name. `names` are those of the data sets, `times` of their time columns.
pub fn figures(
    fit: &Fit,
    report: &Report,
    data: &[Datum],
    (places, curves): (&[Datum], &[(f64, f64)]),
    names: &[String],
    times: &[&str],
) -> Vec<(String, Figure)> {
    let mut all = Vec::new();
    for (set, name) in names.iter().enumerate() {
        let of_set: Vec<_> =
            kinds(data).into_iter().filter(|kind| kind.0 == set).map(|kind| kind.1).collect();
        let here = |datum: &Datum, column: &String| datum.set == set && datum.column == *column;
        let curve = |column: &String| {
            let own: Vec<_> = places.iter().zip(curves).filter(|(place, _)| here(place, column)).collect();
            Curve {
                label: format!("{column}, best fit"),
                x: own.iter().map(|(place, _)| place.time).collect(),
                y: own.iter().map(|(_, curve)| curve.0).collect(),
                half_band: Some(own.iter().map(|(_, curve)| curve.1).collect()),
            }
        };
        let points = |column: &String, value: &dyn Fn(usize) -> f64, label: String| {
            let own: Vec<usize> = (0..data.len()).filter(|k| here(&data[*k], column)).collect();
            let each = |value: &dyn Fn(usize) -> f64| own.iter().map(|k| value(*k)).collect::<Vec<f64>>();
            Points {
                label,
                x: each(&|k| data[k].time),
                y: each(value),
                x_error: (own.iter().any(|k| data[*k].u_time > 0.0)).then(|| each(&|k| data[k].u_time)),
                y_error: Some(each(&|k| data[k].u)),
            }
        };
        let stem = if names.len() == 1 { String::new() } else { format!("_{}", set + 1) };
        all.push((
            format!("points{stem}"),
            Figure {
                title: format!("{name}: points and best fit"),
                x_name: times[set].to_owned(),
                y_name: of_set.join(", "),
                curves: of_set.iter().map(curve).collect(),
                points: of_set
                    .iter()
                    .map(|c| points(c, &|k| data[k].value, format!("{c}, measured")))
                    .collect(),
                ..Figure::default()
            },
        ));
        let residual = |k: usize| report.residuals[k].residual;
        all.push((
            format!("residuals{stem}"),
            Figure {
                title: format!("{name}: measured less best fit"),
                x_name: times[set].to_owned(),
                y_name: "residual".into(),
                points: of_set.iter().map(|c| points(c, &residual, c.clone())).collect(),
                y_span: Some((-0.001, 0.001)),
                ..Figure::default()
            },
        ));
    }
    all.extend((0..fit.ranges.len()).map(|axis| profile_of(fit, axis)));
    for b in 1..fit.ranges.len() {
        all.extend((0..b).map(|a| region_of(fit, [a, b])));
    }
    all
}

fn profile_of(fit: &Fit, axis: usize) -> (String, Figure) {
    let (range, profile) = (&fit.ranges[axis], &fit.profiles[axis]);
    let [(_, inner), (_, outer)] = levels();
    // Far beyond the 95 % interval there is nothing to see.
    let near: Vec<usize> = (0..profile.place.len()).filter(|k| profile.rise[*k] <= 3.0 * outer).collect();
    let x: Vec<f64> = near.iter().map(|k| fit.value(axis, profile.place[*k])).collect();
    let ends = [x.first(), x.last()].map(|end| end.copied().unwrap_or(f64::NAN));
    let level = |name: &str, level: f64| Curve {
        label: name.to_owned(),
        x: ends.to_vec(),
        y: vec![level; 2],
        half_band: None,
    };
    let curves = vec![
        Curve {
            label: "profile".into(),
            y: near.iter().map(|k| profile.rise[*k]).collect(),
            x,
            half_band: None,
        },
        level("68 %", inner),
        level("95 %", outer),
    ];
    let figure = Figure {
        title: format!("How far {} can go", range.label()),
        x_name: range.label(),
        y_name: "χ² above its least".into(),
        curves,
        ..Figure::default()
    };
    (format!("profile_{}", range.name()), figure)
}

fn region_of(fit: &Fit, axes: [usize; 2]) -> (String, Figure) {
    let [a, b] = axes;
    let curves = [0.68, 0.95].map(|confidence| {
        let ring = contour(&fit.best, axes, rise_of_several(confidence, 2));
        Curve {
            label: format!("{:.0} %", 100.0 * confidence),
            x: ring.iter().map(|point| fit.value(a, point[0])).collect(),
            y: ring.iter().map(|point| fit.value(b, point[1])).collect(),
            half_band: None,
        }
    });
    let best = fit.values(&fit.best.place);
    let figure = Figure {
        title: format!("{} and {} together", fit.ranges[a].label(), fit.ranges[b].label()),
        x_name: fit.ranges[a].label(),
        y_name: fit.ranges[b].label(),
        curves: curves.into(),
        points: vec![Points {
            label: "best".into(),
            x: vec![best[a]],
            y: vec![best[b]],
            ..Points::default()
        }],
        ..Figure::default()
    };
    (format!("region_{}_{}", fit.ranges[a].name(), fit.ranges[b].name()), figure)
}
