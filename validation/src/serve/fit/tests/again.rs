//! Fits that begin again at a lower minimum, models that draw nothing, and points beside a model that is not fitted.

use super::*;
use crate::methods::least_squares::direct::Direct;
use crate::serve::fit::elsewhere::best_fit;
use crate::serve::fit::report::as_written;

/// χ² along a frequency has many minima, and a search that begins over the whole range often ends in a false one.
#[test]
fn the_lowest_of_many_minima_is_taken() {
    let (data, of_two) = (points(0.3, 1.0, 0.002, 1), model(1, 0.0));
    let of_frequency = |values: &[f64]| -> Result<Replica, String> { of_two(&[0.3, values[0]]) };
    let (mut refused, mut astray) = (0, 0);
    for (from, to) in (1..10).flat_map(|from| (11..49).step_by(3).map(move |to| (from, to))) {
        let ranges = ranges(&[&format!("a.f={}:{}", f64::from(from) / 10.0, f64::from(to) / 10.0)]);
        let (ranges, rods) = (&ranges, &Rods::none(1));
        let problem = FitProblem { data: &data, ranges, rods, model: &of_frequency, most_replicas: 1 };
        let at = |fit: Fit| (fit.values(&fit.best.place)[0] - 1.0).abs() < 0.02;
        astray += usize::from(!search(&problem, &Watch::SILENT).is_ok_and(at));
        match best_fit(&problem, &Watch::SILENT) {
            Ok((fit, _)) => assert!(at(fit), "{ranges:?}"),
            Err(_) => refused += 1,
        }
    }
    assert!(astray > 5 * refused && astray > 10, "{refused} refused, {astray} astray at first");
}

/// Replicas of a model that draws nothing are alike: one says what many do.
#[test]
fn one_run_is_enough_for_a_model_that_draws_nothing() {
    let (data, model) = (points(0.3, 1.0, 0.01, 1), model(1, 0.0));
    let of = |most_replicas| {
        let ranges = ranges(&["a.rate=0.05:5", "a.frequency=0.8:1.25"]);
        let problem = FitProblem { data: &data, ranges: &ranges, rods: &Rods::none(1), model: &model, most_replicas };
        let (fit, _) = best_fit(&problem, &Watch::SILENT).unwrap();
        let ends = [0, 1].map(|axis| [0.68, 0.95].map(|confidence| fit.interval(axis, confidence)));
        (fit.values(&fit.best.place), ends.as_flattened().iter().map(|i| [i.low, i.high]).collect::<Vec<_>>(), fit.runs)
    };
    let ((one, narrow, few), (many, wide, runs)) = (of(1), of(30));
    assert_eq!(30 * few, runs);
    let pairs = one.iter().zip(&many).chain(narrow.as_flattened().iter().zip(wide.as_flattened()));
    pairs.for_each(|(one, many)| assert!((one - many).abs() < 1e-6, "{one} {many}"));
}

/// χ² of points beside a model that is not fitted, by hand: one degree of freedom for each.
#[test]
fn points_beside_a_scene_as_it_is() {
    let (data, rods) = (points(0.3, 1.0, 0.01, 1), Rods::none(1));
    let of = |rate: f64, scatter: f64, replicas: u64| {
        let replica = model(7, scatter)(&[rate, 1.0]).unwrap();
        let rows: Vec<_> = (0..replicas).map(|k| replica.run(k).unwrap()).collect();
        as_written(&data, &Direct::of(&data, &rows, &rods).unwrap(), &rods, rows.len()).unwrap()
    };
    let exact = of(0.3, 0.0, 1);
    let by_hand: f64 = exact.residuals.iter().map(|r| ((r.measured - r.simulated) / 0.01).powi(2)).sum();
    assert!((exact.chi2 - by_hand).abs() < 1e-9 * by_hand && exact.degrees_of_freedom == data.len());
    assert!(exact.p_value > 0.01 && exact.warnings.is_empty(), "{}", exact.p_value);
    // The noise of 40 replicas is in u, and its covariance is known from few: χ² is near the exact one.
    let noisy = of(0.3, 0.01, 40);
    assert!(noisy.residuals[0].u > 0.01 && (0.3..3.0).contains(&(noisy.chi2 / exact.chi2)), "{}", noisy.chi2);
    let wrong = of(0.5, 0.0, 1);
    assert!(wrong.p_value < 1e-6 && wrong.warnings[0].to_string().contains("as it is does not describe"));
}
