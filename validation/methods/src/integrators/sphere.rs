//! Steps that stay on the sphere by construction (Hairer, Lubich & Wanner, Geometric Numerical Integration, IV).

use super::{Integrator, RodProblem};
use nalgebra::{Matrix3, Rotation3, Vector3};

/// Newton's iteration ends when the midpoint moves by less than this, in units of |p|: the next move would be the
/// square of this.
pub const NEWTON_TOLERANCE: f64 = 1e-12;

/// Newton steps before the iteration is given up: near the longest step that has one solution, it converges slowly.
const MOST_ITERATIONS: usize = 500;

/// Largest number of halvings of one Newton step.
const MOST_HALVINGS: usize = 20;

/// The implicit midpoint rule p′ = p + h f(m), m = ½(p + p′): as f(m) ⊥ m, |p′| = |p|. Newton's method, with each step
/// halved until the residual falls: plain Newton cycles at long steps that have a solution.
fn implicit_midpoint(problem: &RodProblem, p: Vector3<f64>, h: f64) -> Vector3<f64> {
    let half = 0.5 * h;
    let miss_at = |m: &Vector3<f64>| m - p - problem.tangent_rate(m) * half;
    let mut m = p;
    let mut miss = miss_at(&m);
    for _ in 0..MOST_ITERATIONS {
        let slope = Matrix3::identity() - problem.tangent_rate_slope(&m) * half;
        let Some(inverse) = slope.try_inverse() else {
            break;
        };
        let mut change = inverse * miss;
        if change.norm() <= NEWTON_TOLERANCE {
            m -= change;
            return m + m - p;
        }
        let mut next = miss_at(&(m - change));
        if !next.norm().is_finite() {
            break;
        }
        for _ in 0..MOST_HALVINGS {
            if next.norm() < miss.norm() {
                break;
            }
            change *= 0.5;
            next = miss_at(&(m - change));
        }
        m -= change;
        miss = next;
    }
    Vector3::repeat(f64::NAN)
}

/// The angular velocity p × ṗ of p, in units of G.
fn spin(problem: &RodProblem, p: &Vector3<f64>) -> Vector3<f64> {
    p.cross(&problem.tangent_rate(p))
}

/// The midpoint rule by rotations: p turns at the rate found half a step ahead. Order 2.
fn rotation_midpoint(problem: &RodProblem, p: Vector3<f64>, h: f64) -> Vector3<f64> {
    let half = Rotation3::new(spin(problem, &p) * (0.5 * h)) * p;
    Rotation3::new(spin(problem, &half) * h) * p
}

/// The classical Runge–Kutta step for the rotation vector u of p(t) = exp(u) p (Munthe-Kaas 1999). Order 4.
fn munthe_kaas_4(problem: &RodProblem, p: Vector3<f64>, h: f64) -> Vector3<f64> {
    let rate = |u: Vector3<f64>| dexp_inverse(&u, spin(problem, &(Rotation3::new(u) * p)));
    let k1 = spin(problem, &p) * h;
    let k2 = rate(0.5 * k1) * h;
    let k3 = rate(0.5 * k2) * h;
    let k4 = rate(k3) * h;
    Rotation3::new((k1 + 2.0 * (k2 + k3) + k4) / 6.0) * p
}

/// u̇ for exp(u)̇ = ω exp(u), to the terms that order 4 needs: ω − ½ u×ω + u×(u×ω)/12.
fn dexp_inverse(u: &Vector3<f64>, omega: Vector3<f64>) -> Vector3<f64> {
    let once = u.cross(&omega);
    omega - 0.5 * once + u.cross(&once) / 12.0
}

pub(super) fn all() -> [Integrator; 3] {
    [
        Integrator::in_p("implicit midpoint in p", 2, implicit_midpoint),
        Integrator::in_p("Lie-group midpoint", 2, rotation_midpoint),
        Integrator::in_p("Lie-group RKMK4", 4, munthe_kaas_4),
    ]
    .map(Integrator::keeping_length)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_rotation_vector_turns_at_the_rate_asked_for() {
        let (u, omega, dt) = (Vector3::new(0.02, -0.03, 0.01), Vector3::new(-0.5, 0.2, 0.7), 1e-5);
        let rate = dexp_inverse(&u, omega) * dt;
        let turned = |u| Rotation3::new(u).into_inner();
        let found = (turned(u + rate) - turned(u - rate)) * turned(-u) / (2.0 * dt);
        // The next term of the series is |u|⁴/720.
        assert!((found - omega.cross_matrix()).norm() < 1e-8);
    }

    #[test]
    fn a_long_step_solves_the_equation_and_one_that_overflows_gives_no_number() {
        let (problem, start) = RodProblem::mid_flip(11.6);
        let p = start.into_inner();
        for h in [10.0, 100.0] {
            let end = implicit_midpoint(&problem, p, h);
            let miss = end - p - problem.tangent_rate(&(0.5 * (p + end))) * h;
            // m has an error of 10⁻¹² at most, and h f(m) h times that.
            assert!(miss.norm() <= 1e-12 * (2.0 + 2.0 * h), "{h}: {miss:?}");
            assert!((end.norm() - 1.0).abs() <= 1e-12);
        }
        // The square of the residual overflows, so that no change can reduce it.
        for h in [1e300, f64::INFINITY] {
            let end = implicit_midpoint(&problem, p, h);
            assert!(end.iter().all(|component| component.is_nan()), "{h}: {end:?}");
        }
    }
}
