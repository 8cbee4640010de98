//! Integrates a_ij in time.

use super::fourth::PAIRS;
use super::models::Equation;
use nalgebra::{Matrix3, Matrix6, Vector6};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};

/// Number of steps up to an output time after which the method gives up: a hundred times what the problems take.
const MOST_STEPS: u32 = 20_000;

/// The rate of a_ij in 1/s.
pub type Rate<'a> = &'a dyn Fn(&Matrix3<f64>) -> Matrix3<f64>;

/// A rate in 1/s that depends on the time in s.
pub type RateInTime<'a> = &'a dyn Fn(f64, &Matrix3<f64>) -> Matrix3<f64>;

/// A rate, and the time at which its own begins.
struct Ode<'a>(RateInTime<'a>, f64);

impl System<f64, Vector6<f64>> for Ode<'_> {
    fn system(&self, time: f64, a: &Vector6<f64>, rate: &mut Vector6<f64>) {
        let found = self.0(self.1 + time, &matrix(a));
        *rate = Vector6::from_fn(|n, _| found[PAIRS[n]]);
    }
}

fn matrix(a: &Vector6<f64>) -> Matrix3<f64> {
    Matrix3::new(a[0], a[3], a[4], a[3], a[1], a[5], a[4], a[5], a[2])
}

/// a_ij at `times_s` ≥ 0 in ascending order, from `start`, by Dormand & Prince's method of order 8 with `tolerance` as
/// relative and absolute tolerance of a step. `None` if the method gives up or a is not finite.
pub fn at(equation: &Equation, start: &Matrix3<f64>, times_s: &[f64], tolerance: f64) -> Option<Vec<Matrix3<f64>>> {
    at_rate(&|_, a| equation.rate(a), start, times_s, tolerance)
}

/// As [`at`], for any rate.
pub fn at_rate(rate: RateInTime, start: &Matrix3<f64>, times_s: &[f64], tolerance: f64) -> Option<Vec<Matrix3<f64>>> {
    let mut now = 0.0;
    let mut a = Vector6::from_fn(|n, _| start[PAIRS[n]]);
    let mut all = Vec::new();
    for time in times_s {
        if *time > now {
            let span = time - now;
            // The library's defaults, except for the number of steps: at kinks of a closure the method may not get
            // through.
            let (ode, out) = (Ode(rate, now), OutputType::Sparse);
            let mut solver = Dop853::from_param(
                ode, 0.0, span, span, a, tolerance, tolerance, 0.9, 0.0, 0.333, 6.0, span, 0.0, MOST_STEPS, 1000, out,
            );
            solver.integrate().ok()?;
            a = *solver.y_out().last()?;
            now = *time;
        }
        all.push(matrix(&a));
    }
    all.iter().all(|a| a.iter().all(|x| x.is_finite())).then_some(all)
}

/// The longest strain after which a steady state is looked for, about.
const MOST_STRAIN: f64 = 10_000.0;

/// The tolerance of the way to a steady state where polynomials of high degree, as IBOF's near alignment, are known no
/// better; and how far the result may be off a state of rods.
const ROUGH: f64 = 1e-6;

/// A state with an eigenvalue this far below 0 does not come back to one of rods.
const FAR_OFF: f64 = 0.2;

/// A steady a_ij: that to which Newton's method leads from where a is after some strain, close by. `None` where a comes
/// near none.
pub fn steady(equation: &Equation, start: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    steady_of(&|a| equation.rate(a), equation.gradient_per_s.norm(), start)
}

/// As [`steady`], for any rate in a flow with the norm |L| in 1/s.
pub fn steady_of(rate: Rate, norm: f64, start: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    // Short stretches: a step at the edge of stability is no stiffness.
    let (mut a, mut strain, mut stretch) = (*start, 0.0, 10.0);
    while strain < MOST_STRAIN {
        for tolerance in [1e-9, ROUGH] {
            if let Some(found) = at_rate(&|_, a| rate(a), &a, &[stretch / norm], tolerance) {
                a = found[0];
                break;
            }
        }
        if a.symmetric_eigenvalues().min() < -FAR_OFF {
            return None;
        }
        strain += stretch;
        if strain >= 100.0 {
            if let Some(found) = newton(rate, norm, &a) {
                return Some(found);
            }
            stretch = strain;
        }
    }
    None
}

/// The steady a_ij to which Newton's method leads from `settled`; `None` where it leads farther than 0.05, or to no
/// state of rods.
fn newton(rate: Rate, norm: f64, settled: &Matrix3<f64>) -> Option<Matrix3<f64>> {
    let rate = |a: &Matrix3<f64>| {
        let found = rate(a) / norm;
        Vector6::from_fn(|n, _| found[PAIRS[n]])
    };
    let mut a = *settled;
    for _ in 0..50 {
        let here = rate(&a);
        // The trace is constant: its equation is added to that of a_33.
        let slope = Matrix6::from_fn(|row, column| {
            const STEP: f64 = 1e-6;
            let away = |sign: f64| {
                let mut off = Vector6::zeros();
                off[column] = sign * STEP;
                rate(&(a + matrix(&off)))[row]
            };
            let trace = if row == 2 && column < 3 { 1.0 } else { 0.0 };
            (away(1.0) - away(-1.0)) / (2.0 * STEP) + trace
        });
        let step = slope.lu().solve(&here)?;
        a -= matrix(&step);
        if step.amax() < 1e-11 {
            // Another root is no state that is settled into.
            let near = (a - settled).amax() < 0.05 && (a.trace() - 1.0).abs() < ROUGH;
            return (near && a.symmetric_eigenvalues().min() >= -ROUGH).then_some(a);
        }
    }
    None
}
