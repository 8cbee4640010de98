use super::*;
use crate::input::experiment::{Axis, Layout, Measured, Projection, Provenance, Stated, Time};
use approx::assert_relative_eq;

/// Three synthetic points for the scene of Fig. 4 at n = 100, with the values `y` at early times, in seconds.
fn synthetic(y: [f64; 3]) -> MeasuredCurve {
    let axis_s = Axis {
        quantity: Time::Seconds { shear_rate_per_s: 0.5 },
        calibration: vec![0.0, 100.0],
        standard_uncertainty: 0.5,
    };
    let axis_y = Axis { quantity: Projection::Fraction, calibration: vec![0.0, 1.0], standard_uncertainty: 0.005 };
    let point =
        |(x, y): (f64, f64)| Measured { label: "synthetic".to_owned(), observable: "x2", x, y, u_x: 0.003, u_y: 0.005 };
    MeasuredCurve {
        scene: "fig4-n100",
        channel: 1,
        points: [0.1, 0.2, 0.5].into_iter().zip(y).map(point).collect(),
        provenance: Provenance {
            stated: Stated::default(),
            csv: Layout::Columns,
            rods: None,
            x: axis_s,
            y: axis_y,
            curves: Vec::new(),
            inputs: Vec::new(),
            unread: Vec::new(),
        },
    }
}

fn compared(curve: &MeasuredCurve) -> Comparison {
    compare(curve.scene, std::slice::from_ref(curve), |_| {}, Runs { replicas: 20, seed: 1 }).unwrap()
}

/// The index of the input `name`.
fn input(name: &str) -> usize {
    INPUTS.iter().position(|(found, _)| *found == name).unwrap()
}

#[test]
fn a_goodness_of_fit_by_hand() {
    // V = [2 1; 1 2], V⁻¹ = [2 −1; −1 2]/3: χ² = (2 − 4 + 8)/3 = 2, and for two points P(χ² > 2) = exp(−1).
    let v = Covariance { own: DVector::from_vec(vec![1.0, 1.0]), shared: DMatrix::from_row_slice(1, 2, &[1.0, 1.0]) };
    let (chi_square, p) = goodness_of_fit(&DVector::from_vec(vec![1.0, 2.0]), v.solver().as_ref());
    assert_relative_eq!(chi_square, 2.0, max_relative = 1e-12);
    assert_relative_eq!(p, (-1.0_f64).exp(), max_relative = 1e-12);
    assert!(goodness_of_fit(&DVector::zeros(2), None).1.is_nan());
}

#[test]
fn the_terms_add_up() {
    let mut curve = synthetic([0.6, 0.5, 0.7]);
    curve.provenance.rods = Some(500.0);
    curve.provenance.inputs = vec![(input("aspect_ratio"), 0.3), (input("alpha"), 0.1)];
    let comparison = compared(&curve);
    assert!(comparison.inputs_stated);
    for (point, measured) in comparison.points.iter().zip(&curve.points) {
        assert_eq!((point.measured, point.t_over_t), (measured.y, measured.x));
        assert_eq!(point.error, point.simulated - point.measured);
        let sum = point.u_d.powi(2) + point.u_num.powi(2) + point.u_input.powi(2);
        assert_relative_eq!(point.u_val, sum.sqrt(), max_relative = 1e-12);
        assert!(point.u_d > 0.005 && point.u_num > 0.0 && point.u_input > 0.0);
    }
    let errors: Vec<_> = comparison.points.iter().map(|point| point.error).collect();
    assert_relative_eq!(comparison.mean_error, errors.iter().sum::<f64>() / 3.0, max_relative = 1e-12);
    let squares = errors.iter().map(|error| error * error).sum::<f64>();
    assert_relative_eq!(comparison.rms_error, (squares / 3.0).sqrt(), max_relative = 1e-12);
    let within = comparison.points.iter().filter(|point| point.error.abs() <= 2.0 * point.u_val).count();
    assert_relative_eq!(comparison.within_two_u_val, within as f64 / 3.0, max_relative = 1e-12);
}

#[test]
fn each_source_of_uncertainty_counts() {
    let plain = synthetic([0.6, 0.5, 0.7]);
    let u = |change: &dyn Fn(&mut MeasuredCurve), term: fn(&Point) -> f64| {
        let mut curve = plain.clone();
        change(&mut curve);
        term(&compared(&curve).points[2])
    };
    let u_d = |change: &dyn Fn(&mut MeasuredCurve)| u(change, |point| point.u_d).powi(2);
    let none = u_d(&|_| {});
    // Four times as many rods have a quarter of the variance.
    let few = u_d(&|curve| curve.provenance.rods = Some(100.0)) - none;
    let many = u_d(&|curve| curve.provenance.rods = Some(400.0)) - none;
    assert!(few > 0.0);
    assert_relative_eq!(few, 4.0 * many, max_relative = 1e-9);
    let sharp_in_time = u_d(&|curve| curve.points[2].u_x = 1e-9);
    assert_relative_eq!(sharp_in_time, 0.005_f64.powi(2), max_relative = 1e-6);
    let sharp_in_y = u_d(&|curve| curve.points[2].u_y = 1e-9);
    assert_relative_eq!(none, sharp_in_time + sharp_in_y, max_relative = 1e-6);
    assert_eq!(u(&|_| {}, |point| point.u_input), 0.0);
    let u_input = |sd: f64| u(&|curve| curve.provenance.inputs = vec![(input("alpha"), sd)], |point| point.u_input);
    assert_relative_eq!(u_input(0.2), 2.0 * u_input(0.1), max_relative = 1e-9);
}

#[test]
fn the_early_motion_of_slender_rods_knows_the_strain_only() {
    // So a wrong r_e moves an early point given in seconds less than one given in t/T.
    let u_input = |quantity: Time| {
        let mut curve = synthetic([0.6, 0.5, 0.7]);
        curve.provenance.x.quantity = quantity;
        curve.provenance.inputs = vec![(input("aspect_ratio"), 1.0)];
        compared(&curve).points[0].u_input
    };
    let seconds = Time::Seconds { shear_rate_per_s: 0.5 };
    let (in_seconds, in_periods) = (u_input(seconds), u_input(Time::Periods));
    assert!(in_seconds < 0.5 * in_periods, "{in_seconds} {in_periods}");
}

#[test]
fn on_a_peak_the_time_counts_though_the_slope_is_zero() {
    let mut curve = synthetic([0.6, 0.5, 0.7]);
    curve.points[2].u_x = 0.01;
    let u_d = compared(&curve).points[2].u_d;
    assert!(u_d > 0.01, "{u_d}");
}

#[test]
fn on_a_straight_stretch_the_time_counts_by_its_slope() {
    let slope_of = |u_x: f64| {
        let mut curve = synthetic([0.6, 0.5, 0.7]);
        curve.points[1].u_x = u_x;
        let point = &compared(&curve).points[1];
        (point.u_d.powi(2) - 0.005_f64.powi(2)).sqrt() / u_x
    };
    assert_relative_eq!(slope_of(0.001), slope_of(0.002), max_relative = 0.05);
}

#[test]
fn a_point_is_where_the_model_is() {
    let mut curve = synthetic([0.6, 0.5, 0.7]);
    let first = compared(&curve);
    for (measured, point) in curve.points.iter_mut().zip(&first.points) {
        measured.y = point.simulated;
    }
    let again = compared(&curve);
    assert_eq!((again.chi_square, again.p, again.rms_error), (0.0, 1.0, 0.0));
}
