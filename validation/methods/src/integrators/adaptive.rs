//! Methods with step control, from libraries of other authors.

use super::{Failure, Integrator, RodProblem, Theory};
use differential_equations::linalg::Matrix;
use differential_equations::prelude::{IVP, ImplicitRungeKutta, ODE};
use nalgebra::Vector3;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};

/// Number of steps after which a method gives up; they take about a tenth of a second.
const MOST_STEPS: usize = 100_000;

impl System<f64, Vector3<f64>> for RodProblem {
    fn system(&self, _: f64, p: &Vector3<f64>, rate: &mut Vector3<f64>) {
        *rate = self.rate(p);
    }
}

/// Explicit Runge–Kutta of order 8 with step control (Dormand & Prince 8(5,3), Hairer's DOP853) from `ode_solvers`.
pub fn dormand_prince() -> Integrator {
    Integrator::new("Dormand–Prince 8(5,3)", Theory::Adaptive, |problem, start, setting| {
        let (tolerance, end) = (setting.tolerance()?, problem.strain());
        let mut solver = Dop853::new(*problem, 0.0, end, end, start.into_inner(), tolerance, tolerance);
        // Output at steps, not dense: the last step ends at `end`.
        solver.set_output(OutputType::Sparse);
        solver.integrate().map_err(|error| Failure::Gave(error.to_string()))?;
        solver.y_out().last().copied().ok_or(Failure::NotFinite)
    })
}

impl ODE<f64, [f64; 3]> for RodProblem {
    fn diff(&self, _: f64, p: &[f64; 3], rate: &mut [f64; 3]) {
        *rate = self.rate(&Vector3::from(*p)).into();
    }

    fn jacobian(&self, _: f64, p: &[f64; 3], slope: &mut Matrix<f64>) {
        let found = self.rate_slope(&Vector3::from(*p));
        (0..9).map(|k| (k / 3, k % 3)).for_each(|at| slope[at] = found[at]);
    }
}

/// Implicit Runge–Kutta of order 5 for stiff equations with step control (Radau IIA, Hairer's RADAU5) from
/// `differential-equations`.
pub fn radau() -> Integrator {
    Integrator::new("Radau IIA 5", Theory::Adaptive, |problem, start, setting| {
        let (tolerance, end) = (setting.tolerance()?, problem.strain());
        // One tolerance per component: version 0.7 rescales a single tolerance once per component.
        let method = ImplicitRungeKutta::radau5().rtol([tolerance; 3]).atol([tolerance; 3]).max_steps(MOST_STEPS);
        let solution = IVP::ode(problem, 0.0, end, start.into_inner().into())
            .method(method)
            .solve()
            .map_err(|error| Failure::Gave(format!("{error:?}")))?;
        match solution.t.last().zip(solution.y.last()) {
            Some((t, p)) if *t == end => Ok((*p).into()),
            _ => Err(Failure::Gave("stopped early".into())),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Radau would converge with a wrong Jacobian too, in more steps.
    #[test]
    fn the_slope_that_radau_is_given_is_the_problems() {
        let (problem, start) = RodProblem::mid_flip(5.0);
        let mut slope = Matrix::full(3, 3);
        problem.jacobian(0.0, &start.into_inner().into(), &mut slope);
        let expected = problem.rate_slope(&start);
        (0..9).map(|k| (k / 3, k % 3)).for_each(|at| assert_eq!(slope[at], expected[at]));
        assert!(expected.norm() > 0.1);
    }
}
