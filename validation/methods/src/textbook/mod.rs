//! Methods for ṗ = Ap − p(p·Ap) in double precision, and a code for tensors, by which the grader is tested. They share
//! no code with it.

pub mod tableaus;
pub mod tensors;

use crate::integrators::{Setting, rk4};
use nalgebra::{Matrix3, Rotation3, Vector3};
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};
use tableaus::Tableau;

/// The vector p or q, or angles and 0.
type Vector = Vector3<f64>;
type Matrix = Matrix3<f64>;

/// The variable that is stepped.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Form {
    /// p, without normalisation.
    Raw,
    /// p, divided by |p| after each step.
    Normalised,
    /// q with q̇ = Aq, divided by |q| after each step.
    Linear,
    /// The angles φ and θ, by A.13.
    Angles,
}

/// A method with its coefficients.
#[derive(Clone)]
pub enum Method {
    /// An explicit Runge–Kutta method.
    RungeKutta(Tableau),
    /// Adams–Bashforth, with weights from the newest rate to the oldest, and a method for the first steps.
    Adams {
        /// Weights of the rates.
        b: Vec<f64>,
        /// Method for the first steps.
        starter: Tableau,
    },
    /// Adams–Bashforth, then Adams–Moulton once (PECE).
    PredictorCorrector {
        /// Weights of the predictor.
        b: Vec<f64>,
        /// Weights of the corrector.
        moulton: Vec<f64>,
        /// Method for the first steps.
        starter: Tableau,
    },
    /// Implicit Runge–Kutta by fixed-point iteration.
    Implicit {
        /// Weights of the stages.
        a: Vec<Vec<f64>>,
        /// Weights of the stages in the step.
        b: Vec<f64>,
    },
    /// Implicit midpoint steps of these relative lengths, one after the other.
    Composed(Vec<f64>),
    /// Rotations about ω = p × Ap, with the commutators of order 4 if `rkmk`.
    LieGroup {
        /// Stages and weights.
        tableau: Tableau,
        /// True for the method with commutators.
        rkmk: bool,
    },
    /// Exact steps of W and of ΛD in turn, with these relative lengths.
    Splitting {
        /// Lengths of the steps of W.
        turning: Vec<f64>,
        /// Lengths of the steps of ΛD.
        stretching: Vec<f64>,
    },
    /// An embedded pair with step control by a tolerance.
    Adaptive {
        /// Stages and weights.
        tableau: Tableau,
        /// Weights of the other method, for the error estimate.
        other: Vec<f64>,
    },
    /// Dormand and Prince's 8(5,3) with step control, from `ode_solvers`.
    DormandPrince8,
}

/// The vector x + h Σ w k.
fn sum(x: &Vector, h: f64, weights: &[f64], k: &[Vector]) -> Vector {
    x + weights.iter().zip(k).map(|(w, k)| k * *w).sum::<Vector>() * h
}

/// A = W + ΛD for L with L_ij = ∂u_i/∂x_j and the aspect ratio `ratio`, without the cancellation of Λ near 1.
pub fn rate_matrix(l: &[[f64; 3]; 3], ratio: f64) -> Matrix3<f64> {
    let square = ratio * ratio;
    let (long, short) = (square / (square + 1.0), 1.0 / (square + 1.0));
    Matrix::from_fn(|i, j| long * l[i][j] - short * l[j][i])
}

/// ṗ = Ap − p(p·Ap), Jeffery's equation with A = W + ΛD.
pub fn jeffery_rate(a: &Matrix3<f64>, p: Vector3<f64>) -> Vector3<f64> {
    let pull = a * p;
    pull - p * p.dot(&pull)
}

/// p after `steps` steps of `h` s of the classical method of order 4.
pub fn rk4_in_p(a: &Matrix3<f64>, p: Vector3<f64>, h: f64, steps: u64) -> Vector3<f64> {
    (0..steps).fold(p, |p, _| rk4(|p| jeffery_rate(a, p), p, h))
}

/// The gradient L(t) = Q L Qᵀ + S with S p = ω × p, as a code forms it that may be wrong.
pub struct Turning {
    /// L at t = 0.
    pub l: Matrix3<f64>,
    /// ω, rad/s.
    pub rotation: Vector3<f64>,
    /// r_e.
    pub ratio: f64,
    /// The factors on t in Q and on S.
    pub factors: [f64; 2],
    /// The time at which it is taken, from a stage's own and that of the step's begin.
    pub when: fn(f64, f64) -> f64,
}

impl Turning {
    fn a(&self, time: f64) -> Matrix {
        let turned = Rotation3::new(self.rotation * (self.factors[0] * time)).into_inner();
        let spin = self.factors[1] * self.rotation.cross_matrix();
        rate_matrix(&(turned * self.l * turned.transpose() + spin).transpose().into(), self.ratio)
    }

    /// p after `steps` steps of `h` s of the classical method of order 4.
    pub fn rk4(&self, p: Vector3<f64>, h: f64, steps: u64) -> Vector3<f64> {
        (0..steps).fold(p, |p, k| {
            let begun = k as f64 * h;
            let [first, half, last] = [0.0, 0.5, 1.0].map(|share| self.a((self.when)(begun + share * h, begun)));
            let one = jeffery_rate(&first, p);
            let two = jeffery_rate(&half, p + 0.5 * h * one);
            let three = jeffery_rate(&half, p + 0.5 * h * two);
            p + h / 6.0 * (one + 2.0 * (two + three) + jeffery_rate(&last, p + h * three))
        })
    }
}

struct Motion {
    a: Matrix,
    form: Form,
}

impl Motion {
    fn rate(&self, x: &Vector) -> Vector {
        match self.form {
            Form::Linear => self.a * x,
            Form::Raw | Form::Normalised => jeffery_rate(&self.a, *x),
            Form::Angles => {
                let ((sp, cp), (st, ct)) = (x.x.sin_cos(), x.y.sin_cos());
                let v = self.a * Vector::new(st * cp, st * sp, ct);
                Vector::new((v.y * cp - v.x * sp) / st, (v.x * cp + v.y * sp) * ct - v.z * st, 0.0)
            }
        }
    }
    fn first(&self, p: Vector) -> Vector {
        match self.form {
            Form::Angles => Vector::new(p.y.atan2(p.x), p.x.hypot(p.y).atan2(p.z), 0.0),
            _ => p,
        }
    }
    fn kept(&self, x: Vector) -> Vector {
        match self.form {
            Form::Normalised | Form::Linear => x.normalize(),
            _ => x,
        }
    }
    fn last(&self, x: Vector) -> Vector {
        match self.form {
            Form::Angles => {
                let ((sp, cp), (st, ct)) = (x.x.sin_cos(), x.y.sin_cos());
                Vector::new(st * cp, st * sp, ct)
            }
            _ => x,
        }
    }
}

impl System<f64, Vector> for &Motion {
    fn system(&self, _: f64, x: &Vector, rate: &mut Vector) {
        *rate = self.rate(x);
    }
}

fn stages(motion: &Motion, tableau: &Tableau, x: &Vector, h: f64, k: &mut Vec<Vector>) {
    k.clear();
    for row in &tableau.a {
        let at = sum(x, h, row, k);
        k.push(motion.rate(&at));
    }
}

/// The direction at `end_s` seconds after `p`; `None` if the method does not take this setting, or gives up.
pub fn advance(
    method: &Method,
    form: Form,
    l: &[[f64; 3]; 3],
    ratio: f64,
    p: &[f64; 3],
    end_s: f64,
    setting: Setting,
) -> Option<[f64; 3]> {
    let motion = Motion { a: rate_matrix(l, ratio), form };
    let x = motion.first((*p).into());
    let end = match (method, setting) {
        (Method::Adaptive { tableau, other }, Setting::Tolerance(tolerance)) => {
            adaptive(&motion, tableau, other, x, end_s, tolerance)
        }
        (Method::DormandPrince8, Setting::Tolerance(tolerance)) => {
            let mut solver = Dop853::new(&motion, 0.0, end_s, end_s, x, tolerance, tolerance);
            solver.set_output(OutputType::Sparse);
            solver.integrate().ok()?;
            motion.kept(*solver.y_out().last()?)
        }
        (Method::Adaptive { .. } | Method::DormandPrince8, _) => return None,
        (_, Setting::Steps(steps)) => fixed(method, &motion, x, end_s, steps),
        _ => return None,
    };
    Some(motion.last(end).into())
}

/// Steps until the end, or until there is no direction.
fn fixed(method: &Method, motion: &Motion, mut x: Vector, end_s: f64, steps: u64) -> Vector {
    let h = end_s / steps as f64;
    let mut one = stepper(method, motion, x, h);
    for _ in 0..steps {
        x = one(x);
        if x[0].is_nan() {
            break;
        }
    }
    x
}

/// A step of length `h` of a method without step control; multistep methods keep their rates.
fn stepper<'a>(method: &'a Method, motion: &'a Motion, start: Vector, h: f64) -> Box<dyn FnMut(Vector) -> Vector + 'a> {
    let mut k = Vec::new();
    match method {
        Method::RungeKutta(tableau) => Box::new(move |x| {
            stages(motion, tableau, &x, h, &mut k);
            motion.kept(sum(&x, h, &tableau.b, &k))
        }),
        Method::Adams { b, starter } | Method::PredictorCorrector { b, starter, .. } => {
            let mut rates = vec![motion.rate(&start)];
            Box::new(move |x| {
                let next = if rates.len() < b.len() {
                    stages(motion, starter, &x, h, &mut k);
                    sum(&x, h, &starter.b, &k)
                } else {
                    let mut next = sum(&x, h, b, &rates);
                    if let Method::PredictorCorrector { moulton, .. } = method {
                        rates.insert(0, motion.rate(&next));
                        next = sum(&x, h, moulton, &rates);
                        rates.remove(0);
                    }
                    rates.pop();
                    next
                };
                let next = motion.kept(next);
                rates.insert(0, motion.rate(&next));
                next
            })
        }
        Method::Implicit { a, b } => Box::new(move |x| motion.kept(implicit(motion, a, b, &x, h))),
        Method::Composed(parts) => {
            let half = [vec![0.5]];
            let part = move |x, part: &f64| implicit(motion, &half, &[1.0], &x, part * h);
            Box::new(move |x| motion.kept(parts.iter().fold(x, &part)))
        }
        Method::LieGroup { tableau, rkmk } => Box::new(move |x| lie(motion, tableau, *rkmk, &x, h)),
        Method::Splitting { turning, stretching } => {
            let part = |sign: f64| (motion.a + motion.a.transpose() * sign) * 0.5;
            let maps = |m: Matrix, lengths: &[f64]| lengths.iter().map(|c| (m * (c * h)).exp()).collect::<Vec<_>>();
            let (turns, stretches) = (maps(part(-1.0), turning), maps(part(1.0), stretching));
            Box::new(move |x| {
                let pairs = turns.iter().zip(&stretches);
                let x = pairs.fold(x, |x, (turn, stretch)| stretch * (turn * x));
                turns.get(stretches.len()).map_or(x, |turn| turn * x).normalize()
            })
        }
        Method::Adaptive { .. } | Method::DormandPrince8 => Box::new(|x| x),
    }
}

/// One step of an implicit method, by iteration until nothing changes.
fn implicit(motion: &Motion, a: &[Vec<f64>], b: &[f64], x: &Vector, h: f64) -> Vector {
    let mut k = vec![motion.rate(x); b.len()];
    let mut before = f64::INFINITY;
    for _ in 0..100 {
        let next: Vec<Vector> = a.iter().map(|row| motion.rate(&sum(x, h, row, &k))).collect();
        let change: f64 = k.iter().zip(&next).map(|(old, new)| (new - old).dot(&(new - old))).sum();
        k = next;
        if change == 0.0 || (change >= before && change < 1e-24) || change.is_nan() {
            break;
        }
        before = change;
    }
    sum(x, h, b, &k)
}

fn lie(motion: &Motion, tableau: &Tableau, rkmk: bool, p: &Vector, h: f64) -> Vector {
    let omega = |p: &Vector| p.cross(&(motion.a * p));
    let mut k: Vec<Vector> = Vec::new();
    for row in &tableau.a {
        let v = sum(&Vector::zeros(), h, row, &k);
        let w = omega(&(Rotation3::new(v) * p));
        // dexp⁻¹ to the second commutator.
        k.push(if rkmk {
            let once = v.cross(&w);
            w - once * 0.5 + v.cross(&once) * (1.0 / 12.0)
        } else {
            w
        });
    }
    Rotation3::new(sum(&Vector::zeros(), h, &tableau.b, &k)) * p
}

/// Number of steps, accepted or rejected, after which an adaptive method gives up.
const MOST_STEPS: u64 = 2_000_000;

fn adaptive(motion: &Motion, tableau: &Tableau, other: &[f64], mut x: Vector, end_s: f64, tolerance: f64) -> Vector {
    let (mut t, mut h) = (0.0, end_s / 1e4);
    let order = f64::from(tableau.order);
    let mut k = Vec::new();
    for _ in 0..MOST_STEPS {
        if t >= end_s {
            return x;
        }
        h = h.min(end_s - t);
        stages(motion, tableau, &x, h, &mut k);
        let next = sum(&x, h, &tableau.b, &k);
        let estimate = sum(&x, h, other, &k);
        let scale = |i: usize| tolerance + tolerance * x[i].abs().max(next[i].abs());
        let error = (0..3).map(|i| ((next[i] - estimate[i]) / scale(i)).powi(2)).sum::<f64>() / 3.0;
        let error = error.sqrt();
        if error <= 1.0 {
            t += h;
            x = motion.kept(next);
        }
        h *= (0.9 * error.powf(-1.0 / order)).clamp(0.2, 5.0);
        if h.is_nan() || t + h <= t {
            break;
        }
    }
    if t >= end_s { x } else { Vector::repeat(f64::NAN) }
}

/// Twice the steps reduce the error by 2ᵖ. With 32 steps the errors of higher orders are no larger than that of the
/// reference, about 10⁻¹².
#[test]
fn extrapolated_methods_are_of_their_order() {
    let l = [[0.1, -0.3, 0.2], [0.9, 0.1, -0.3], [0.0, 0.4, -0.2]];
    let (ratio, start) = (3.0, [0.6, 0.0, 0.8]);
    let by = |method: Method, form: Form, steps: u64| -> Vector {
        advance(&method, form, &l, ratio, &start, 1.0, Setting::Steps(steps)).unwrap().into()
    };
    let euler = |order: usize| Method::RungeKutta(tableaus::extrapolated_euler("", order));
    let end = by(euler(8), Form::Normalised, 64);
    let order = |of: &dyn Fn(u64) -> Vector| ((of(16) - end).norm() / (of(32) - end).norm()).log2();
    for p in 1..=5 {
        let form = if p % 2 == 0 { Form::Normalised } else { Form::Raw };
        let found = order(&|steps| by(euler(p), form, steps));
        assert!((found - p as f64).abs() < 0.4, "{p}: {found}");
    }
    let found = order(&|steps| rk4_in_p(&rate_matrix(&l, ratio), start.into(), 1.0 / steps as f64, steps));
    assert!((found - 4.0).abs() < 0.2, "{found}");
}
