//! A fit as pictures: points with the best curve, its band and their residuals, profiles, and the region of two
//! parameters.

use super::data::kinds;
use super::report::{Report, levels};
use super::search::{Fit, Watch};
use crate::methods::least_squares::Datum;
use crate::methods::least_squares::emulator::Model;
use crate::methods::least_squares::likelihood::REPLICAS;
use crate::methods::least_squares::profile::{region, rise_of_several};
use crate::present::plot::{Curve, Figure, MEASURED, Panel, Points, names as letters};

/// Enough for flips of rods in six periods to have no corners at 170 mm.
const TIMES: usize = 1000;

/// The largest number of replicas behind a drawn curve.
pub const MOST_REPLICAS: u64 = 100;

/// Half the width of 95 % of a Gaussian, in standard deviations.
const WIDE: f64 = 1.96;

/// The places at which the curve of each data set and column is drawn, as points without a value.
pub fn places(data: &[Datum]) -> Vec<Datum> {
    let mut all = Vec::new();
    for (set, column) in kinds(data) {
        let here = data.iter().filter(|datum| (datum.set, &datum.column) == (set, &column));
        let last = crate::oracle::worst(here.map(|datum| datum.time));
        all.extend((0..=TIMES).map(|k| Datum::place(set, &column, last * k as f64 / TIMES as f64)));
    }
    all
}

/// Means over replicas at every place, and the square of their standard error.
type Mean = Vec<(f64, f64)>;

fn mean(model: &Model<'_>, values: &[f64], replicas: u64, watch: &Watch<'_>) -> Result<Mean, String> {
    let replica = model(values)?;
    let rows = watch.replicas(replicas, |k| replica.run(k))?;
    let n = rows.len() as f64;
    let of = |place: usize| {
        let mean = rows.iter().map(|row| row[place][0]).sum::<f64>() / n;
        let square: f64 = rows.iter().map(|row| (row[place][0] - mean).powi(2)).sum();
        (mean, square / (n * (n - 1.0).max(1.0)))
    };
    Ok((0..rows[0].len()).map(of).collect())
}

/// The best curve at `places`, which [`places`] returned, by `model`, and half its 95 % band: the replicas' standard
/// error, and the change by one standard deviation along each axis of the parameters' covariance.
pub fn best_curves(
    fit: &Fit,
    places: &[Datum],
    model: &Model<'_>,
    watch: &Watch<'_>,
) -> Result<Vec<(f64, f64)>, String> {
    let replicas = (fit.emulator.behind_covariance() as u64).min(MOST_REPLICAS);
    (watch.stage)("curves");
    let best = mean(model, &fit.values(&fit.best.place), replicas, watch)?;
    let mut variance: Vec<f64> = best.iter().map(|(_, square)| *square).collect();
    let axes = fit.best.covariance().symmetric_eigen();
    for (length, way) in axes.eigenvalues.iter().zip(axes.eigenvectors.column_iter()) {
        let side = |sign: f64| {
            let step = sign * length.max(0.0).sqrt();
            let place: Vec<f64> = fit.best.place.iter().zip(way.iter()).map(|(p, way)| p + step * way).collect();
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

/// The curves of a scene as it is at `places`, by its replicas, and half their 95 % bands.
pub fn own_curves(model: &Model<'_>, replicas: u64, watch: &Watch<'_>) -> Result<Vec<(f64, f64)>, String> {
    let mean = mean(model, &[], replicas.min(MOST_REPLICAS), watch)?;
    Ok(mean.into_iter().map(|(mean, square)| (mean, WIDE * square.sqrt())).collect())
}

/// The uncertainty of each point alone: reading in y and in time, and the measured rods.
pub fn u_of_points(fit: &Fit) -> Vec<f64> {
    let of = |k: usize| fit.best.causes[..REPLICAS].iter().map(|cause| cause[(k, k)]).sum::<f64>().sqrt();
    (0..fit.best.causes[0].nrows()).map(of).collect()
}

/// The profiles of a fit and the regions of its pairs of parameters, each with the stem of its file name.
pub fn of_parameters(fit: &Fit) -> Vec<(String, Figure)> {
    let mut all: Vec<_> = (0..fit.ranges.len()).map(|axis| profile_of(fit, axis)).collect();
    for b in 1..fit.ranges.len() {
        all.extend((0..b).map(|a| region_of(fit, [a, b])));
    }
    all
}

/// A picture of each data set, with the stem of its file name: the points with `u`, the curves at `places`, which
/// `kind` describes, and residuals. `names` are the names of the data sets, `times` those of their time columns.
pub fn of_points(
    report: &Report,
    (data, u): (&[Datum], &[f64]),
    (places, curves, kind): (&[Datum], &[(f64, f64)], &str),
    names: &[String],
    times: &[&str],
) -> Vec<(String, Figure)> {
    let of_set = |(set, name): (usize, &String)| {
        let of_set: Vec<_> = kinds(data).into_iter().filter(|kind| kind.0 == set).map(|kind| kind.1).collect();
        let here = |datum: &Datum, column: &String| datum.set == set && datum.column == *column;
        let curve = |column: &String| {
            let own = places.iter().zip(curves).filter(|(place, _)| here(place, column));
            Curve::with_band(letters::channel(column) + kind, own, |(place, (y, half))| (place.time, *y, *half))
        };
        let zero = |column: &String| {
            let best = curve(column);
            Curve { y: vec![0.0; best.x.len()], ..best }
        };
        let points = |column: &String, value: &dyn Fn(usize) -> f64| {
            let own: Vec<usize> = (0..data.len()).filter(|k| here(&data[*k], column)).collect();
            let each = |value: &dyn Fn(usize) -> f64| own.iter().map(|k| value(*k)).collect::<Vec<f64>>();
            Points {
                label: letters::channel(column) + MEASURED,
                x: each(&|k| data[k].time),
                y: each(value),
                x_error: (own.iter().any(|k| data[*k].u_time > 0.0)).then(|| each(&|k| data[k].u_time)),
                y_error: Some(each(&|k| u[k])),
            }
        };
        let stem = if names.len() == 1 { String::new() } else { format!("_{}", set + 1) };
        let residuals = Panel {
            y_name: "residual".into(),
            curves: of_set.iter().map(zero).collect(),
            points: of_set.iter().map(|c| points(c, &|k| report.residuals[k].residual)).collect(),
        };
        let figure = Figure {
            title: name.clone(),
            x_name: letters::time(times[set]),
            y_name: of_set.iter().map(|c| letters::channel(c)).collect::<Vec<_>>().join(", "),
            curves: of_set.iter().map(curve).collect(),
            points: of_set.iter().map(|c| points(c, &|k| data[k].value)).collect(),
            below: Some(residuals),
            ..Figure::default()
        };
        (format!("points{stem}"), figure)
    };
    names.iter().enumerate().map(of_set).collect()
}

fn profile_of(fit: &Fit, axis: usize) -> (String, Figure) {
    let (range, profile) = (&fit.ranges[axis], &fit.profiles[axis]);
    let [(_, inner), (_, outer)] = levels();
    // The profile far beyond the 95 % interval is not drawn.
    let near: Vec<usize> = (0..profile.place.len()).filter(|k| profile.rise[*k] <= 3.0 * outer).collect();
    let x: Vec<f64> = near.iter().map(|k| fit.value(axis, profile.place[*k])).collect();
    let ends = [x.first(), x.last()].map(|end| end.copied().unwrap_or(f64::NAN));
    let level = |name: &str, level: f64| Curve::of(name, ends, |x| (x, level));
    let rises = x.into_iter().zip(near.iter().map(|k| profile.rise[*k]));
    let curves = vec![Curve::of("profile", rises, |point| point), level("68 %", inner), level("95 %", outer)];
    let figure = Figure {
        title: format!("Profile of χ² along {}", letters::key(&range.label())),
        x_name: letters::key(&range.label()),
        y_name: "χ² − χ²_min".into(),
        curves,
        ..Figure::default()
    };
    (format!("profile_{}", range.name()), figure)
}

fn region_of(fit: &Fit, axes: [usize; 2]) -> (String, Figure) {
    let [a, b] = axes;
    let curves = [0.68, 0.95].map(|confidence| {
        let islands = region(&fit.best, &fit.profiles[a], axes, rise_of_several(confidence, 2));
        // The curve is interrupted between two islands.
        let ring = islands.join(&[[f64::NAN; 2]][..]);
        let edge = if is_open(&ring) { ", open: cut at the end of a range" } else { "" };
        let label = format!("{:.0} %{edge}", 100.0 * confidence);
        Curve::of(label, ring, |[x, y]| (fit.value(a, x), fit.value(b, y)))
    });
    let best = fit.values(&fit.best.place);
    let [x_name, y_name] = axes.map(|axis| letters::key(&fit.ranges[axis].label()));
    let figure = Figure {
        title: format!("{x_name} and {y_name} together"),
        x_name,
        y_name,
        curves: curves.into(),
        points: vec![Points::of("best", [(best[a], best[b])], |best| best)],
        ..Figure::default()
    };
    (format!("region_{}_{}", fit.ranges[a].name(), fit.ranges[b].name()), figure)
}

/// True if the outline of a region runs along an edge of the box: the points do not say where it ends there.
fn is_open(ring: &[[f64; 2]]) -> bool {
    ring.iter().flatten().any(|place| place.abs() >= 1.0 - 1e-9)
}

#[cfg(test)]
mod tests {
    use super::is_open;

    #[test]
    fn a_region_at_the_edge_of_the_box_is_open() {
        let ring = |reach: f64| -> Vec<[f64; 2]> {
            let angle = |k: usize| (std::f64::consts::TAU * k as f64 / 144.0).sin_cos();
            (0..=144).map(|k| [0.4 + reach * angle(k).1, 0.5 * angle(k).0].map(|v| v.clamp(-1.0, 1.0))).collect()
        };
        assert!(!is_open(&ring(0.5)) && is_open(&ring(0.7)));
    }
}
