use super::super::isotropic::tests::{COUETTE, SPIRAL, at};
use super::super::motion::Unit;
use super::*;
use crate::quadrature::spread;

#[test]
fn pairs_of_doubles_settle_the_nearest_double_nearly_everywhere() {
    fn settles<const N: usize>(found: Option<[f64; N]>, exact: [Big; N]) -> bool {
        let expected = exact.each_ref().map(number);
        assert!(found.is_none_or(|found| found == expected), "{found:?} {expected:?}");
        found.is_some()
    }
    let mut settled = Vec::new();
    for (u, v) in spread(40) {
        for (gradient, time, unit) in [(COUETTE, 3.0 * v, Unit::Period), (SPIRAL, 9.0 * v, Unit::Second)] {
            let covariance = at(gradient, 1e3f64.powf(2.0 * u - 1.0), time, unit);
            let matrices = Matrices::new(&covariance).unwrap();
            settled.push(settles(matrices.projections(), covariance.projections()));
            settled.push(settles(matrices.second(), covariance.second()));
            settled.push(settles(matrices.fourth(), covariance.fourth()));
        }
    }
    let count = settled.iter().filter(|settled| **settled).count();
    assert!(settled.len() == 240 && count > 220, "{count} of {}", settled.len());
    // Out of their range, and so near the tie of two doubles that more bits decide.
    assert!(Matrices::new(&at(COUETTE, 1e100, 0.2, Unit::Period)).is_none());
    assert_eq!(at(COUETTE, 1e100, 0.2, Unit::Period).nearest().len(), 9);
    // tr Σ is e^2000 here.
    let far = at([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0; 3]], 1e3, 1000.0, Unit::Second);
    assert_eq!(far.nearest()[3..5], [1.0, 0.0]);
}

#[test]
fn a_number_beside_the_tie_of_two_doubles_is_left_to_more_bits() {
    let beside = |bits: isize| PRECISION.of(1.0) + (PRECISION.of(1.0) >> 53) + (PRECISION.of(1.0) >> bits);
    assert_eq!(nearest([beside(90), PRECISION.of(0.5)]), None);
    assert_eq!(nearest([beside(70), PRECISION.of(0.0)]), Some([1.0 + f64::EPSILON, 0.0]));
    // The bound is that of the largest entry.
    assert_eq!(nearest([beside(70), PRECISION.of(1e3)]), None);
}
