//! The motion of a free rod in any velocity gradient: its matrix N, and the parts of the exponential of N.
//!
//! With Λ = (r_e² − 1)/(r_e² + 1), A = W + ΛD = (L − ρLᵀ)/(1 + ρ) for rods, ρ = 1/r_e²; a disc moves as the rod of
//! 1/r_e in the flow −Lᵀ. N = L − ρLᵀ has no cancellation for long rods, and its invariants are polynomials in ρ whose
//! coefficients depend on L alone. A multiple of 1 in L changes |q| only and is removed.
//!
//! Coordinates that N does not couple form blocks, each with its own exponential. One exponential of all coordinates
//! would lose digits: of a block in which the start is small beside the rounding of another, and of blocks whose rates
//! nearly coincide.

use super::ball::Ball;
use super::functions::exp_and_power;
use super::modes::{Cubic, Pair, Time};
use crate::model::flow::VelocityGradient;
use nalgebra::Matrix3;
use std::array::from_fn;

pub(super) type Square = [[Ball; 3]; 3];

/// The matrix N of one flow and one aspect ratio, with the quantities that its exponential needs.
#[derive(Clone, Debug)]
pub(super) struct General {
    n: Square,
    n_squared: Square,
    /// L was multiplied by 2^`power`, which makes its largest component about 1.
    power: i32,
    /// 1/(1 + ρ): A = N · `slower`.
    slower: Ball,
    /// (2 D:D)^½ of the scaled L.
    magnitude: Ball,
    cubic: Cubic,
    /// Δ of the roots m ± √Δ of the two coordinates that remain without the first, second or third.
    squares: [Ball; 3],
}

/// exp(Nτ) by rows, up to a common factor, for the coordinates that a start reaches.
pub(super) struct Rows {
    /// a₀, a₁ and a₂ of each row's block.
    coefficients: Square,
    /// Exponent of the power of two that is left out of each row.
    powers: [i32; 3],
}

impl General {
    pub fn new(flow: &VelocityGradient, aspect_ratio: f64) -> Self {
        let (l, power) = scaled(flow);
        let magnitude = magnitude(&l);
        let rod = aspect_ratio >= 1.0;
        let without_trace = traceless(l);
        let x: Square = from_fn(|i| from_fn(|j| if rod { without_trace[i][j] } else { -without_trace[j][i] }));
        let r = Ball::exact(aspect_ratio);
        let square = r * r;
        // ρ and 1 − ρ, both without cancellation.
        let difference = (r - Ball::ONE) * (r + Ball::ONE);
        let (rho, rest) = if rod { (Ball::ONE.over(square), difference.over(square)) } else { (square, -difference) };
        let n: Square = from_fn(|i| from_fn(|j| x[i][j] - rho * x[j][i]));
        let forward: Square = product(|i, k| x[i][k], |k, j| x[k][j]);
        let mixed: [Square; 2] = [product(|i, k| x[i][k], |k, j| x[j][k]), product(|i, k| x[k][i], |k, j| x[k][j])];
        let n_squared: Square = from_fn(|i| {
            from_fn(|j| forward[i][j] - rho * (mixed[0][i][j] + mixed[1][i][j]) + rho * rho * forward[j][i])
        });
        // λ³ − tλ² + cλ − d.
        let t = rest * trace(&x);
        let trace_of_square = (Ball::ONE + rho * rho) * trace(&forward) - rho.scaled(2.0) * trace(&mixed[0]);
        let c = (t * t - trace_of_square).scaled(0.5);
        let (determinant, with_transpose) = determinants(&x);
        let d = rest * ((Ball::ONE + rho + rho * rho) * determinant - rho * with_transpose);
        Self {
            n,
            n_squared,
            power,
            slower: Ball::ONE.over(Ball::ONE + rho),
            magnitude,
            cubic: Cubic::new(t, c, d),
            squares: from_fn(|left_out| square_of_pair(&l, others(left_out), rho, rest)),
        }
    }

    /// The period in units in which L is about 1, and |ln| of the ratio by which the rest of the motion grows in it
    /// relative to the rotating part; `None` if there is no period.
    pub fn period(&self) -> Option<(Ball, f64)> {
        let (period, drift) = self.cubic.period()?;
        Some((period.over(self.slower), drift))
    }

    /// The period in s; `None` if the motion has none.
    pub fn period_s(&self) -> Option<f64> {
        self.period().map(|(period, _)| libm::scalbn(period.hi, self.power))
    }

    /// The time in which the strain increases by `strain`.
    pub fn time_of_strain(&self, strain: Ball) -> Time {
        Time { span: strain.over(self.magnitude) * self.slower, turns: None }
    }

    /// The time of `ticks`/`each` seconds.
    pub fn time_of_seconds(&self, ticks: f64, each: f64) -> Time {
        let span = libm::scalbn(ticks, -self.power);
        let rounded = if libm::scalbn(span, self.power) == ticks { 0.0 } else { span * f64::EPSILON };
        let span = Ball::exact(span).widened(rounded);
        let span = if each == 1.0 { span } else { span.over(Ball::exact(each)) };
        Time { span: span * self.slower, turns: None }
    }

    /// The time of `turns` periods; `None` if the motion has no period.
    pub fn time_of_periods(&self, turns: Ball) -> Option<Time> {
        let (period, _) = self.cubic.period()?;
        Some(Time { span: turns * period, turns: Some(turns) })
    }

    /// The time of `turns` periods of `mean`, the motion of another aspect ratio in this flow; `None` if it has no
    /// period.
    pub fn time_of_periods_of(&self, mean: &Self, turns: Ball) -> Option<Time> {
        let (period, _) = mean.period()?;
        Some(Time { span: turns * period * self.slower, turns: None })
    }

    /// The map q = M p, up to a factor.
    pub fn map(&self, time: Time) -> Square {
        let rows = self.rows([true; 3], time);
        let most = rows.powers.into_iter().fold(i32::MIN, i32::max);
        let map = self.map_of(&rows);
        from_fn(|i| map[i].map(|component| component.shifted(rows.powers[i] - most)))
    }

    /// The map of the coordinates that `rows` reach, without the powers of two; its other columns are meaningless.
    pub fn map_of(&self, rows: &Rows) -> Square {
        from_fn(|i| {
            let [a0, a1, a2] = rows.coefficients[i];
            from_fn(|j| {
                let one = if i == j { a0 } else { Ball::ZERO };
                one + a1 * self.n[i][j] + a2 * self.n_squared[i][j]
            })
        })
    }

    /// The rows that move a rod starting along `p`, and `p` times the rows' powers of two, scaled to a largest
    /// component of about 1.
    pub fn rows_from(&self, p: [f64; 3], time: Time) -> (Rows, [Ball; 3]) {
        let rows = self.rows(self.reached(p), time);
        let most = (0..3).filter(|&i| p[i] != 0.0).map(|i| rows.powers[i] + exponent(p[i])).fold(i32::MIN, i32::max);
        let start = from_fn(|i| match p[i] {
            0.0 => Ball::ZERO,
            component => Ball::exact(component).shifted(rows.powers[i] - most),
        });
        (rows, start)
    }

    /// The image of a start from [`Self::rows_from`], up to a factor.
    pub fn moved(&self, rows: &Rows, start: [Ball; 3]) -> [Ball; 3] {
        let once = times(&self.n, start);
        let twice = times(&self.n_squared, start);
        from_fn(|i| {
            let [a0, a1, a2] = rows.coefficients[i];
            a0 * start[i] + a1 * once[i] + a2 * twice[i]
        })
    }

    /// The coordinates that a rod along `p` can reach: a rod on an axis that the flow maps to itself stays there.
    fn reached(&self, p: [f64; 3]) -> [bool; 3] {
        let mut reached = p.map(|component| component != 0.0);
        for _ in 0..2 {
            reached = from_fn(|i| reached[i] || (0..3).any(|j| reached[j] && !self.n[i][j].is_zero()));
        }
        reached
    }

    /// exp(Nτ) of the `reached` coordinates, block by block.
    fn rows(&self, reached: [bool; 3], time: Time) -> Rows {
        let mut couplings = (0..3).filter(|&left_out| {
            let [i, j] = others(left_out);
            reached[i] && reached[j] && !(self.n[i][j].is_zero() && self.n[j][i].is_zero())
        });
        let alone = match (couplings.next(), couplings.next()) {
            (alone, None) => alone,
            _ => {
                return Rows { coefficients: [self.cubic.coefficients(time); 3], powers: [0; 3] };
            }
        };
        // The first coordinate of each coordinate's block, by which the block's coefficients and rate are found.
        let first: [usize; 3] = from_fn(|i| match alone {
            Some(alone) if i != alone => others(alone)[0],
            _ => i,
        });
        let blocks: [Option<([Ball; 3], Ball)>; 3] = from_fn(|i| {
            (first[i] == i && reached[i]).then(|| match alone {
                Some(alone) if i != alone => self.pair(alone).coefficients(time),
                _ => ([Ball::ONE, Ball::ZERO, Ball::ZERO], self.n[i][i]),
            })
        });
        let rate = |i: usize| blocks[i].map_or(f64::NEG_INFINITY, |(_, rate)| rate.hi);
        let fastest = (1..3).fold(0, |a, b| if rate(b) > rate(a) { b } else { a });
        let scaled: [([Ball; 3], i32); 3] = from_fn(|i| match (blocks[i], blocks[fastest]) {
            (Some((coefficients, rate)), Some((_, largest))) if i != fastest => {
                let (factor, power) = exp_and_power((rate - largest) * time.span);
                (coefficients.map(|a| a * factor), power)
            }
            (block, _) => (block.map_or([Ball::ZERO; 3], |(coefficients, _)| coefficients), 0),
        });
        Rows { coefficients: first.map(|i| scaled[i].0), powers: first.map(|i| scaled[i].1) }
    }

    /// The roots of the two coordinates other than `left_out`.
    fn pair(&self, left_out: usize) -> Pair {
        let [i, j] = others(left_out);
        Pair { middle: (self.n[i][i] + self.n[j][j]).scaled(0.5), square: self.squares[left_out] }
    }
}

/// The two coordinates other than `left_out`.
fn others(left_out: usize) -> [usize; 2] {
    [[1, 2], [0, 2], [0, 1]][left_out]
}

/// Δ of two coordinates: (1 − ρ)²(h² + L_ij L_ji) − ρ(L_ij − L_ji)² with h = (L_ii − L_jj)/2, free of cancellation both
/// for long rods and near spheres.
fn square_of_pair(l: &Square, [i, j]: [usize; 2], rho: Ball, rest: Ball) -> Ball {
    let half = (l[i][i] - l[j][j]).scaled(0.5);
    let turning = l[i][j] - l[j][i];
    rest * rest * (half * half + l[i][j] * l[j][i]) - rho * turning * turning
}

pub(super) fn times(matrix: &Square, p: [Ball; 3]) -> [Ball; 3] {
    from_fn(|i| matrix[i][0] * p[0] + matrix[i][1] * p[1] + matrix[i][2] * p[2])
}

pub(super) fn product(a: impl Fn(usize, usize) -> Ball, b: impl Fn(usize, usize) -> Ball) -> Square {
    from_fn(|i| from_fn(|j| a(i, 0) * b(0, j) + a(i, 1) * b(1, j) + a(i, 2) * b(2, j)))
}

fn trace(x: &Square) -> Ball {
    x[0][0] + x[1][1] + x[2][2]
}

/// det X and tr(adj(X) Xᵀ).
fn determinants(x: &Square) -> (Ball, Ball) {
    let cofactor = |i: usize, j: usize| {
        let (a, b) = ((i + 1) % 3, (i + 2) % 3);
        let (c, d) = ((j + 1) % 3, (j + 2) % 3);
        x[a][c] * x[b][d] - x[a][d] * x[b][c]
    };
    let sum = |terms: [Ball; 3]| terms[0] + terms[1] + terms[2];
    let determinant = sum(from_fn(|i| x[0][i] * cofactor(0, i)));
    let with_transpose = sum(from_fn(|i| sum(from_fn(|j| cofactor(j, i) * x[i][j]))));
    (determinant, with_transpose)
}

/// L times the power of two that makes its largest component about 1, and the exponent of that power.
fn scaled(flow: &VelocityGradient) -> (Square, i32) {
    let l = flow.per_s();
    let power = -exponent(l.amax());
    let component = |i: usize, j: usize| {
        let component = l[(i, j)];
        let scaled = libm::scalbn(component, power);
        let lost = libm::scalbn(scaled, -power) != component;
        Ball::exact(scaled).widened(if lost { 1e-320 } else { 0.0 })
    };
    (from_fn(|i| from_fn(|j| component(i, j))), power)
}

/// The exponent of the largest power of two ≤ |x|; 0 for 0.
fn exponent(x: f64) -> i32 {
    if x == 0.0 { 0 } else { libm::log2(x.abs()).floor() as i32 }
}

/// (2 D:D)^½ = (Σ (L_ij + L_ji)²/2)^½.
fn magnitude(l: &Square) -> Ball {
    let squares = (0..3).flat_map(|i| (0..3).map(move |j| (i, j)));
    let sum = squares.fold(Ball::ZERO, |sum, (i, j)| {
        let twice = l[i][j] + l[j][i];
        sum + twice * twice
    });
    sum.scaled(0.5).sqrt()
}

/// L less a third of its trace, in two steps: if a third of the trace is a double, nothing is rounded.
fn traceless(mut l: Square) -> Square {
    for step in 0..2 {
        let sum = trace(&l);
        let third = if step == 0 { Ball::exact(sum.hi / 3.0) } else { sum.over(Ball::exact(3.0)) };
        for (i, row) in l.iter_mut().enumerate() {
            row[i] = row[i] - third;
        }
    }
    l
}

/// The map times the power of two that makes its largest component about 1.
pub(super) fn at_size_one(map: Square) -> Square {
    let largest = map.iter().flatten().fold(0.0, |largest: f64, component| largest.max(component.hi.abs()));
    map.map(|row| row.map(|component| component.shifted(-exponent(largest))))
}

/// The middle of a map as doubles, scaled to a largest component of about 1, and its relative error.
pub(super) fn rounded(map: &Square) -> (Matrix3<f64>, f64) {
    let middle = Matrix3::from_fn(|i, j| map[i][j].hi);
    let power = -exponent(middle.amax());
    let error = Matrix3::from_fn(|i, j| libm::scalbn(map[i][j].error, power));
    let middle = middle.map(|component| libm::scalbn(component, power));
    let relative = error.norm() / middle.norm();
    (middle, infinite_if_nan(relative))
}

pub(super) fn infinite_if_nan(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error }
}
