//! Methods for ṗ = Ap − p(p·Ap) in double precision, by which the grader's rules are tested. They share no code with
//! the grader.

pub mod extrapolated;
pub mod tableaus;

use nalgebra::Vector3;
use ode_solvers::dop_shared::OutputType;
use ode_solvers::{Dop853, System};
use tableaus::Tableau;

/// The vector p or q.
pub type Vector = [f64; 3];
/// A matrix by rows.
pub type Matrix = [[f64; 3]; 3];

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

fn image(m: &Matrix, p: &Vector) -> Vector {
    [0, 1, 2].map(|i| m[i][0] * p[0] + m[i][1] * p[1] + m[i][2] * p[2])
}
fn dot(a: &Vector, b: &Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}
fn cross(a: &Vector, b: &Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
fn plus(a: &Vector, f: f64, b: &Vector) -> Vector {
    [0, 1, 2].map(|i| a[i] + f * b[i])
}
fn unit(p: &Vector) -> Vector {
    let length = dot(p, p).sqrt();
    p.map(|x| x / length)
}
/// The vector x + h Σ w k.
fn sum(x: &Vector, h: f64, weights: &[f64], k: &[Vector]) -> Vector {
    [0, 1, 2].map(|i| x[i] + h * weights.iter().zip(k).map(|(w, k)| w * k[i]).sum::<f64>())
}

/// A = W + ΛD for L with L_ij = ∂u_i/∂x_j and the aspect ratio `ratio`, without the cancellation of Λ near 1.
pub fn rate_matrix(l: &Matrix, ratio: f64) -> Matrix {
    let square = ratio * ratio;
    let (long, short) = (square / (square + 1.0), 1.0 / (square + 1.0));
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| long * l[i][j] - short * l[j][i]))
}

struct Motion {
    a: Matrix,
    form: Form,
}

impl Motion {
    fn rate(&self, x: &Vector) -> Vector {
        match self.form {
            Form::Linear => image(&self.a, x),
            Form::Raw | Form::Normalised => {
                let pull = image(&self.a, x);
                plus(&pull, -dot(x, &pull), x)
            }
            Form::Angles => {
                let ((sp, cp), (st, ct)) = (x[0].sin_cos(), x[1].sin_cos());
                let v = image(&self.a, &[st * cp, st * sp, ct]);
                [(v[1] * cp - v[0] * sp) / st, (v[0] * cp + v[1] * sp) * ct - v[2] * st, 0.0]
            }
        }
    }
    fn first(&self, p: &Vector) -> Vector {
        match self.form {
            Form::Angles => [p[1].atan2(p[0]), p[0].hypot(p[1]).atan2(p[2]), 0.0],
            _ => *p,
        }
    }
    fn kept(&self, x: Vector) -> Vector {
        match self.form {
            Form::Normalised | Form::Linear => unit(&x),
            _ => x,
        }
    }
    fn last(&self, x: &Vector) -> Vector {
        match self.form {
            Form::Angles => {
                let ((sp, cp), (st, ct)) = (x[0].sin_cos(), x[1].sin_cos());
                [st * cp, st * sp, ct]
            }
            _ => *x,
        }
    }
}

impl System<f64, Vector3<f64>> for &Motion {
    fn system(&self, _: f64, x: &Vector3<f64>, rate: &mut Vector3<f64>) {
        *rate = Vector3::from(self.rate(&[x[0], x[1], x[2]]));
    }
}

fn stages(motion: &Motion, tableau: &Tableau, x: &Vector, h: f64, k: &mut Vec<Vector>) {
    k.clear();
    for row in &tableau.a {
        let at = sum(x, h, row, k);
        k.push(motion.rate(&at));
    }
}

/// The choice of the steps.
#[derive(Clone, Copy)]
pub enum Setting {
    /// This number of equal steps.
    Steps(u64),
    /// Steps chosen by a tolerance.
    Tolerance(f64),
}

/// The direction at `end_s` seconds after `p`; `None` if the method does not take this setting, or gives up.
pub fn advance(
    method: &Method,
    form: Form,
    l: &Matrix,
    ratio: f64,
    p: &Vector,
    end_s: f64,
    setting: Setting,
) -> Option<Vector> {
    let motion = Motion { a: rate_matrix(l, ratio), form };
    let x = motion.first(p);
    let end = match (method, setting) {
        (Method::Adaptive { tableau, other }, Setting::Tolerance(tolerance)) => {
            adaptive(&motion, tableau, other, x, end_s, tolerance)
        }
        (Method::DormandPrince8, Setting::Tolerance(tolerance)) => {
            let mut solver = Dop853::new(&motion, 0.0, end_s, end_s, Vector3::from(x), tolerance, tolerance);
            solver.set_output(OutputType::Sparse);
            solver.integrate().ok()?;
            solver.y_out().last().map(|x| motion.kept([x[0], x[1], x[2]]))?
        }
        (Method::Adaptive { .. } | Method::DormandPrince8, _) | (_, Setting::Tolerance(_)) => return None,
        (_, Setting::Steps(steps)) => fixed(method, &motion, x, end_s, steps),
    };
    Some(motion.last(&end))
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
            let part = |sign: f64| [0, 1, 2].map(|i| [0, 1, 2].map(|j| 0.5 * (motion.a[i][j] + sign * motion.a[j][i])));
            let maps = |m: Matrix, lengths: &[f64]| lengths.iter().map(|c| exponential(&m, c * h)).collect::<Vec<_>>();
            let (turns, stretches) = (maps(part(-1.0), turning), maps(part(1.0), stretching));
            Box::new(move |x| {
                let pairs = turns.iter().zip(&stretches);
                let x = pairs.fold(x, |x, (turn, stretch)| image(stretch, &image(turn, &x)));
                unit(&turns.get(stretches.len()).map_or(x, |turn| image(turn, &x)))
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
        let change =
            k.iter().zip(&next).map(|(old, new)| dot(&plus(new, -1.0, old), &plus(new, -1.0, old))).sum::<f64>();
        k = next;
        if change == 0.0 || (change >= before && change < 1e-24) || change.is_nan() {
            break;
        }
        before = change;
    }
    sum(x, h, b, &k)
}

/// The rotation of `p` by the rotation vector `about`, by Rodrigues's formula.
fn turned(about: &Vector, p: &Vector) -> Vector {
    let angle = dot(about, about).sqrt();
    let (s, c) = if angle < 1e-4 {
        (1.0 - angle * angle / 6.0, 0.5 - angle * angle / 24.0)
    } else {
        (angle.sin() / angle, (1.0 - angle.cos()) / (angle * angle))
    };
    let once = cross(about, p);
    let twice = cross(about, &once);
    [0, 1, 2].map(|i| p[i] + s * once[i] + c * twice[i])
}

fn lie(motion: &Motion, tableau: &Tableau, rkmk: bool, p: &Vector, h: f64) -> Vector {
    let omega = |p: &Vector| cross(p, &image(&motion.a, p));
    let mut k: Vec<Vector> = Vec::new();
    for row in &tableau.a {
        let v = sum(&[0.0; 3], h, row, &k);
        let w = omega(&turned(&v, p));
        // dexp⁻¹ to the second commutator.
        k.push(if rkmk {
            let once = cross(&v, &w);
            plus(&plus(&w, -0.5, &once), 1.0 / 12.0, &cross(&v, &once))
        } else {
            w
        });
    }
    turned(&sum(&[0.0; 3], h, &tableau.b, &k), p)
}

/// The exponential exp(mt), by scaling and squaring of its series.
fn exponential(m: &Matrix, t: f64) -> Matrix {
    let norm = m.iter().flatten().map(|x| (x * t).abs()).sum::<f64>();
    let halvings = norm.max(1e-300).log2().ceil().max(0.0) as i32 + 3;
    let small = m.map(|row| row.map(|x| x * t / 2f64.powi(halvings)));
    let product =
        |a: &Matrix, b: &Matrix| [0, 1, 2].map(|i| [0, 1, 2].map(|j| (0..3).map(|k| a[i][k] * b[k][j]).sum()));
    let one = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let (mut term, mut all) = (one, one);
    for k in 1..18 {
        term = product(&term, &small).map(|row: Vector| row.map(|x| x / f64::from(k)));
        (0..3).for_each(|i| all[i] = plus(&all[i], 1.0, &term[i]));
    }
    (0..halvings).for_each(|_| all = product(&all, &all));
    all
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
    if t >= end_s { x } else { [f64::NAN; 3] }
}
