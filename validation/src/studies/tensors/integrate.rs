//! a_ij in time.

use super::models::Equation;
use nalgebra::{Matrix3, Vector6};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};

const PAIRS: [(usize, usize); 6] = super::closures::PAIRS;

struct Rate<'a>(&'a Equation);

impl System<f64, Vector6<f64>> for Rate<'_> {
    fn system(&self, _: f64, a: &Vector6<f64>, rate: &mut Vector6<f64>) {
        let found = self.0.rate(&matrix(a));
        *rate = Vector6::from_fn(|n, _| found[PAIRS[n]]);
    }
}

fn matrix(a: &Vector6<f64>) -> Matrix3<f64> {
    Matrix3::new(a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2])
}

/// a_ij at `times_s` ≥ 0, which ascend, from `start`; by Dormand & Prince's method of order 8 with this relative and absolute
/// tolerance a step. `None` where it gives up or a is not finite.
pub fn at(
    equation: &Equation,
    start: &Matrix3<f64>,
    times_s: &[f64],
    tolerance: f64,
) -> Option<Vec<Matrix3<f64>>> {
    let mut now = 0.0;
    let mut a = Vector6::from_fn(|n, _| start[PAIRS[n]]);
    let mut all = Vec::new();
    for time in times_s {
        if *time > now {
            let span = time - now;
            let mut solver = Dop853::new(Rate(equation), 0.0, span, span, a, tolerance, tolerance);
            solver.set_output(OutputType::Sparse);
            solver.integrate().ok()?;
            a = *solver.y_out().last()?;
            now = *time;
        }
        all.push(matrix(&a));
    }
    all.iter().all(|a| a.iter().all(|x| x.is_finite())).then_some(all)
}

/// a_ij once it no longer changes. `None` where it does not settle within a strain of about 4000.
pub fn steady(equation: &Equation, start: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    // Short stretches: a step at the edge of stability is no stiffness.
    let span = 20.0 / equation.gradient_per_s.norm();
    let mut a = *start;
    for _ in 0..200 {
        a = *at(equation, &a, &[span], 1e-13)?.first()?;
        if equation.rate(&a).amax() <= 1e-12 * equation.gradient_per_s.norm() {
            return Some(a);
        }
    }
    None
}
