//! A second formulation of the closed equations, in the axes of a, with another integrator.
//!
//! The coefficients of fits and the integrals of the natural closure, which exact distributions check, are shared with
//! the first one; eigenvectors (Jacobi's), invariants, contractions, models and steps are not.

use super::fourth::{Fourth, PAIRS};
use super::ibof::{COEFFICIENTS, POWERS};
use super::orthotropic::{ORE, ORW};
use super::{Closure, Equation, Model};
use nalgebra::{Matrix3, Vector3};

type M = Matrix3<f64>;

/// Units of strain per step, and the number of midpoint rules in a step: order 16.
const STEP: f64 = 0.25;
const RULES: usize = 8;

/// a at these times by Gragg's midpoint rule, extrapolated (Bulirsch & Stoer).
pub fn at(equation: &Equation, start: &M, times_s: &[f64]) -> Vec<M> {
    let (mut now, mut a) = (0.0, *start);
    let mut all = Vec::new();
    for time in times_s {
        let steps = ((time - now) * equation.gradient_per_s.norm() / STEP).ceil();
        for _ in 0..steps as usize {
            a = step(equation, &a, (time - now) / steps);
        }
        now = *time;
        all.push(a);
    }
    all
}

fn step(equation: &Equation, a: &M, time_s: f64) -> M {
    let mut table: Vec<M> = Vec::new();
    for k in 0..RULES {
        let n = 2 * (k + 1);
        let h = time_s / n as f64;
        let (mut before, mut here) = (*a, a + rate(equation, a) * h);
        for _ in 1..n {
            (before, here) = (here, before + rate(equation, &here) * (2.0 * h));
        }
        let mut value = (here + before + rate(equation, &here) * h) * 0.5;
        // Neville's scheme in h².
        for (j, other) in table.iter_mut().enumerate().rev() {
            let ratio = (n as f64 / (2.0 * (j as f64 + 1.0))).powi(2);
            let next = value + (value - *other) / (ratio - 1.0);
            *other = value;
            value = next;
        }
        table.insert(0, value);
    }
    table[0]
}

/// The rate da_ij/dt in 1/s.
pub fn rate(equation: &Equation, a: &M) -> M {
    let (values, axes) = eigen(a);
    let a = M::from_diagonal(&values);
    let l = axes.transpose() * equation.gradient_per_s * axes;
    let d = (l + l.transpose()) * 0.5;
    let speed = (2.0 * (d * d).trace()).sqrt();
    let (c, kappa) = match equation.model {
        Model::FolgarTucker { c_i } => (M::from_diagonal_element(c_i), 1.0),
        Model::Rsc { c_i, kappa } => (M::from_diagonal_element(c_i), kappa),
        Model::PhelpsTucker { b, kappa } => {
            let own = values.map(|x| b[0] + x * (b[1] + x * b[2]));
            let unit = d / speed;
            (M::from_diagonal(&own) + unit * b[3] + unit * unit * b[4], kappa)
        }
        Model::Iard { c_i, c_m } => {
            let square = d * d;
            let size = (0.5 * (square * square).trace()).sqrt();
            ((M::identity() - square * (c_m / size)) * c_i, 1.0)
        }
        Model::Pard { c_i, omega } => (M::from_diagonal(&Vector3::new(c_i, c_i * omega, c_i - c_i * omega)), 1.0),
        Model::Mrd { c_i, d } => (M::from_diagonal(&(Vector3::from(d) * c_i)), 1.0),
    };
    // One contraction for flow and diffusion: ȧ = Wa − aW + ga + ag − 2𝔸:g + 2γ̇(C − tr C a) with g = ΛD − 5γ̇C.
    let g = d * equation.shape_factor - c * (5.0 * speed);
    let w = (l - l.transpose()) * 0.5;
    let mut found = w * a - a * w + g * a + a * g - contracted(equation.closure, &axes, &values, &g) * 2.0
        + (c - a * c.trace()) * (2.0 * speed);
    // κ slows the change of the eigenvalues.
    (0..3).for_each(|i| found[(i, i)] *= kappa);
    axes * found * axes.transpose()
}

/// a_ijkl, by contraction with each pair of axes.
pub fn fourth(closure: Closure, a: &M) -> Fourth {
    let (values, axes) = eigen(a);
    let pairs = PAIRS.map(|(k, l)| {
        let unit =
            M::from_fn(|i, j| if (i, j) == (k, l) || (i, j) == (l, k) { if k == l { 1.0 } else { 0.5 } } else { 0.0 });
        let inside = contracted(closure, &axes, &values, &(axes.transpose() * unit * axes));
        axes * inside * axes.transpose()
    });
    Fourth::from_fn(|i, j, k, l| {
        let column = PAIRS.iter().position(|pair| *pair == (k.min(l), k.max(l)));
        column.map_or(f64::NAN, |column| pairs[column][(i, j)])
    })
}

/// 𝔸:m in the axes of a.
fn contracted(closure: Closure, axes: &M, values: &Vector3<f64>, m: &M) -> M {
    let a = M::from_diagonal(values);
    let one = M::identity();
    let linear = || (a * m.trace() + (a * m + m * a) * 2.0 + one * a.dot(m)) / 7.0 - (one * m.trace() + m * 2.0) / 35.0;
    let quadratic = || a * a.dot(m);
    match closure {
        Closure::Linear => linear(),
        Closure::Quadratic => quadratic(),
        Closure::Hybrid => {
            let random = 27.0 * values.product();
            linear() * random + quadratic() * (1.0 - random)
        }
        Closure::Ibof => ibof(values, m),
        Closure::Ore => fitted(values, m, |k, x, y| {
            let c = |n: usize| ORE[n][k];
            c(0) + x * (c(1) + x * (c(4) + x * (c(8) + x * c(13))))
                + y * (c(2) + y * (c(5) + y * (c(9) + y * c(14))))
                + x * y * (c(3) + x * c(6) + y * c(7) + x * y * c(10) + x * x * c(11) + y * y * c(12))
        }),
        Closure::Orw => fitted(values, m, |k, x, y| {
            let c = ORW[k];
            c[0] + x * (c[1] + x * c[2]) + y * (c[3] + y * c[4]) + x * y * c[5]
        }),
        Closure::Natural => {
            let outside = axes * a * axes.transpose();
            let fourth = closure.fourth(&outside);
            axes.transpose() * fourth.contract(&(axes * m * axes.transpose())) * axes
        }
    }
}

fn fitted(values: &Vector3<f64>, m: &M, of: impl Fn(usize, f64, f64) -> f64) -> M {
    let own = Vector3::from_fn(|k, _| of(k, values.x, values.y));
    let [b, c, d] = [0, 1, 2].map(|k| values[k] - own[k]);
    // a_1122 + a_1133 = b and so on.
    let [xy, xz, yz] = [0.5 * (b + c - d), 0.5 * (b + d - c), 0.5 * (c + d - b)];
    let pairs = M::new(own.x, xy, xz, xy, own.y, yz, xz, yz, own.z);
    let diagonal = pairs * m.diagonal();
    M::from_fn(|i, j| if i == j { diagonal[i] } else { 2.0 * pairs[(i, j)] * m[(i, j)] })
}

/// β₅, β₂ and β₁ from a_ijkk = a_ij: its parts in a², a and δ by Cayley & Hamilton, in agreement with the printed
/// formulas.
fn ibof(values: &Vector3<f64>, m: &M) -> M {
    let second = values.x * values.y + values.y * values.z + values.z * values.x;
    let third = values.product();
    let squares = values.norm_squared();
    let beta = |k: usize| {
        let each = COEFFICIENTS.iter().zip(POWERS).map(|(c, (i, j))| {
            let powers = std::iter::repeat_n(second, i as usize).chain(std::iter::repeat_n(third, j as usize));
            powers.fold(c[k], |product, factor| product * factor)
        });
        each.rev().sum::<f64>()
    };
    let (b3, b4, b6) = (beta(0), beta(1), beta(2));
    let b5 = -(4.0 * b3 + 7.0 * b4 + b6 * (2.0 * squares + 4.0 * (1.0 - second))) / 5.0;
    let b2 = (6.0 - 2.0 * b3 - b5 * (squares - 4.0 * second) - 4.0 * b6 * (third - second)) / 7.0;
    let b1 = -(b2 + b4 * squares + 4.0 * third * (b5 + b6)) / 10.0;
    let (one, a) = (M::identity(), M::from_diagonal(values));
    let square = a * a;
    let symmetric = |p: &M, q: &M| {
        let mixed = p * m * q;
        (p * q.dot(m) + q * p.dot(m) + (mixed + mixed.transpose()) * 2.0) / 6.0
    };
    symmetric(&one, &one) * b1
        + symmetric(&one, &a) * b2
        + symmetric(&a, &a) * b3
        + symmetric(&one, &square) * b4
        + symmetric(&a, &square) * b5
        + symmetric(&square, &square) * b6
}

/// Eigenvalues in descending order with their axes, by Jacobi's rotations.
fn eigen(a: &M) -> (Vector3<f64>, M) {
    let (mut a, mut axes) = (*a, M::identity());
    for _ in 0..12 {
        for (i, j) in [(0, 1), (0, 2), (1, 2)] {
            let angle = 0.5 * (2.0 * a[(i, j)]).atan2(a[(i, i)] - a[(j, j)]);
            let (sine, cosine) = if a[(i, j)] == 0.0 { (0.0, 1.0) } else { angle.sin_cos() };
            let mut turn = M::identity();
            (turn[(i, i)], turn[(j, j)], turn[(i, j)], turn[(j, i)]) = (cosine, cosine, -sine, sine);
            a = turn.transpose() * a * turn;
            axes *= turn;
        }
    }
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| a[(*j, *j)].total_cmp(&a[(*i, *i)]));
    let columns = order.map(|k| axes.column(k).into_owned());
    (Vector3::from(order.map(|k| a[(k, k)])), M::from_columns(&columns))
}
