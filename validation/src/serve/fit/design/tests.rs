//! The design against closed forms for a straight line.

use super::*;
use crate::serve::fit::tests::points;

/// Candidate points of the line a + b t, and the state of knowledge if a and b are Gaussian with this covariance.
fn line_known(covariance: &DMatrix<f64>, times: &[f64], u: f64) -> (Vec<Candidate>, Known) {
    let candidate = |time: &f64| Candidate {
        set: 0,
        concentration_per_cm3: None,
        column: "x1".into(),
        time: *time,
        u,
        spread: f64::NAN,
        leaves: Vec::new(),
    };
    let half = covariance.clone().cholesky().unwrap().l();
    // Evenly over eight standard deviations to each side: the trapezium rule is exact to 14 digits.
    let (mut places, mut weights) = (Vec::new(), Vec::new());
    for (x, y) in (-40..=40).flat_map(|i| (-40..=40).map(move |j| (0.2 * f64::from(i), 0.2 * f64::from(j)))) {
        let place = &half * DVector::from_vec(vec![x, y]);
        places.push(vec![1.0 + place[0], 0.5 + place[1]]);
        weights.push((-0.5 * (x * x + y * y)).exp());
    }
    let all: f64 = weights.iter().sum();
    weights.iter_mut().for_each(|weight| *weight /= all);
    let column = |time: &f64| {
        let values = places.iter().map(|place| place[0] + place[1] * time);
        DVector::from_iterator(places.len(), values)
    };
    let columns: Vec<_> = times.iter().map(column).collect();
    let known = Known::new(&places, &columns, &weights);
    (times.iter().map(candidate).collect(), known)
}

#[test]
fn further_points_leave_what_the_textbook_says_and_the_best_are_the_ends() {
    let (mut data, u) = (points(0.8, 1.0, 0.05, 3), 0.05);
    data.truncate(10);
    let row = |time: &f64| DVector::from_vec(vec![1.0, *time]) / u;
    let information = |times: &[f64]| {
        times.iter().map(|time| row(time) * row(time).transpose()).fold(DMatrix::zeros(2, 2), |sum, one| sum + one)
    };
    let inverse = |matrix: DMatrix<f64>| matrix.try_inverse().unwrap();
    let times: Vec<f64> = (0..=20).map(|k| 0.1 * f64::from(k)).collect();
    let measured = information(&times[..10]);
    let (candidates, known) = line_known(&inverse(measured.clone()), &times, u);
    let steps = steps(&known, &candidates, &data);
    let is = |step: &Step, added: &[f64]| {
        let expected = inverse(&measured + information(added));
        for axis in 0..2 {
            let expected = expected[(axis, axis)].sqrt();
            assert!((step.u[axis] / expected - 1.0).abs() < 1e-10, "{step:?} {expected}");
        }
        let r = expected[(0, 1)] / (expected[(0, 0)] * expected[(1, 1)]).sqrt();
        assert!((step.correlation.unwrap() - r).abs() < 1e-10, "{step:?} {r}");
    };
    is(&steps[0], &[]);
    // Ten more points, evenly over 21 times.
    let evenly: Vec<f64> = [1, 3, 5, 7, 9, 11, 13, 15, 17, 19].map(|k: usize| times[k]).to_vec();
    is(&steps[1], &evenly);
    // The measured points are near one end; the best next ones are at the other end.
    let time_of = |step: &Step| match &step.added {
        Added::Point { time, .. } => *time,
        other => panic!("{other:?}"),
    };
    let best: Vec<f64> = steps[2..].iter().map(time_of).collect();
    assert_eq!(best, [2.0; 6]);
    for (k, step) in steps[2..].iter().enumerate() {
        is(step, &best[..=k]);
    }
    // For a line of which next to nothing is known, the textbook's points are the two ends, in turn.
    let (candidates, known) = line_known(&(DMatrix::identity(2, 2) * 1e4), &times, u);
    let unknown = super::steps(&known, &candidates, &data);
    let mut best: Vec<f64> = unknown[2..].iter().map(time_of).collect();
    best.sort_by(f64::total_cmp);
    assert_eq!(best, [0.0, 0.0, 0.0, 2.0, 2.0, 2.0]);
}
