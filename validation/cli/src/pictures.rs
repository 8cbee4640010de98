//! Results as pictures: each observable's means against time with 95 % bands, or bars where outputs are far apart.

use super::derived::FLIP;
use shearbed::run::ensemble::{Column, Series};
use shearbed::{Observable, Plan, Results, Scene};
use shearbed_validation::judge::statistics::student;
use shearbed_validation::present::plot::{BARS, Curve, Figure, Points, names};

/// The stems of the names of an observable's pictures.
pub(super) fn stems(observable: Observable) -> Vec<String> {
    let stem = observable.name().to_owned();
    if observable.is_density() { vec![stem.clone(), format!("{stem}_density")] } else { vec![stem] }
}

/// The pictures of an observable, each with the stem of its file's name.
pub(super) fn figures(plan: &Plan, results: &Results, series: &Series) -> Vec<(String, Figure)> {
    let (scene, stem, apart) = (plan.scene(), series.observable.name(), are_apart(plan));
    let figure = |x_name: &str, y_name: &str, curves| Figure {
        title: scene.title.clone(),
        x_name: x_name.to_owned(),
        y_name: y_name.to_owned(),
        curves,
        ..Figure::default()
    };
    let time_name = names::time(results.time_name);
    let against_time = |channels: &[Column]| {
        let curve = |channel: &Column| Curve {
            label: names::channel(&channel.name),
            x: results.times.clone(),
            y: channel.mean.clone(),
            half_band: band(scene, channel.se.iter().copied()),
        };
        let mut figure = figure(&time_name, series.observable.label(), channels.iter().map(curve).collect());
        part(&mut figure, |_| apart);
        figure
    };
    match (series.observable.is_density(), series.columns.split_first()) {
        (true, Some((mean, density))) => {
            let ends = [0, results.times.len().saturating_sub(1)];
            let curves = ends.map(|output| Curve {
                label: format!("{time_name} = {}", results.times[output]),
                x: (0..density.len()).map(|bin| (bin as f64 + 0.5) / density.len() as f64).collect(),
                y: density.iter().map(|channel| channel.mean[output]).collect(),
                half_band: band(scene, density.iter().map(|channel| channel.se[output])),
            });
            let density = figure("C_b = C/(1 + C)", "density", curves.into());
            vec![(stem.to_owned(), against_time(std::slice::from_ref(mean))), (format!("{stem}_density"), density)]
        }
        _ => vec![(stem.to_owned(), against_time(&series.columns))],
    }
}

/// A line through more outputs than these is dense enough on a page.
pub(super) const MANY: usize = 100;

/// True if a line through a plan's outputs would cut peaks, or there is one alone.
pub(super) fn are_apart(plan: &Plan) -> bool {
    plan.outputs() == 1 || plan.outputs() <= MANY && plan.strain_between_outputs() > FLIP
}

/// Makes the chosen curves points with bars, before the other points.
pub(super) fn part(figure: &mut Figure, chosen: impl Fn(usize) -> bool) {
    let curves = std::mem::take(&mut figure.curves).into_iter().enumerate();
    let (apart, joined): (Vec<_>, Vec<_>) = curves.partition(|(k, _)| chosen(*k));
    figure.curves = joined.into_iter().map(|(_, curve)| curve).collect();
    let points = |(_, Curve { label, x, y, half_band: y_error })| {
        let bars = if y_error.is_some() { BARS } else { "" };
        Points { label: label + bars, x, y, y_error, x_error: None }
    };
    figure.points = apart.into_iter().map(points).chain(std::mem::take(&mut figure.points)).collect();
}

/// Half the width of a 95 % band: the standard errors times Student's t for the number of replicas, or of rods for a
/// single replica. `None` if there is only one value, which has no standard error.
pub(super) fn band(scene: &Scene, se: impl Iterator<Item = f64>) -> Option<Vec<f64>> {
    let samples = match scene.ensemble.replicas {
        1 => scene.particles.count as u64,
        replicas => replicas,
    };
    let factor = (samples > 1).then(|| student(0.05, samples))?;
    Some(se.map(|se| factor * se).collect())
}
