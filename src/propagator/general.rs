//! A free rod in any velocity gradient: the matrix that moves it, and what its exponential is made of.
//!
//! With Λ = (r_e² − 1)/(r_e² + 1), A = W + ΛD = (L − ρLᵀ)/(1 + ρ) for rods, ρ = 1/r_e²; a disc is the rod of 1/r_e in the
//! flow −Lᵀ. Nothing cancels in N = L − ρLᵀ for long rods, and its invariants are polynomials in ρ whose coefficients come
//! from L alone. A multiple of 1 in L changes |q| only and is taken out.

use super::ball::Ball;
use super::modes::{Modes, Time};
use crate::flow::VelocityGradient;
use nalgebra::Matrix3;
use std::array::from_fn;

pub(super) type Square = [[Ball; 3]; 3];

/// N of one flow and one aspect ratio, with what its exponential needs.
#[derive(Clone, Debug)]
pub(super) struct General {
    n: Square,
    n_squared: Square,
    /// L was multiplied by two to this power, so that its largest component is about 1.
    power: i32,
    /// 1/(1 + ρ): A = N · this.
    slower: Ball,
    /// (2 D:D)^½ of L as it was scaled.
    magnitude: Ball,
    /// All three coordinates.
    modes: Modes,
}

impl General {
    pub fn new(flow: &VelocityGradient, aspect_ratio: f64) -> Self {
        let (l, power) = scaled(flow);
        let magnitude = magnitude(&l);
        let rod = aspect_ratio >= 1.0;
        let without_trace = traceless(l);
        let x: Square = from_fn(|i| {
            from_fn(|j| {
                if rod {
                    without_trace[i][j]
                } else {
                    -without_trace[j][i]
                }
            })
        });
        let r = Ball::exact(aspect_ratio);
        let square = r * r;
        // ρ and 1 − ρ, both without cancellation.
        let difference = (r - Ball::ONE) * (r + Ball::ONE);
        let (rho, rest) = if rod {
            (Ball::ONE.over(square), difference.over(square))
        } else {
            (square, -difference)
        };
        let n: Square = from_fn(|i| from_fn(|j| x[i][j] - rho * x[j][i]));
        let forward: Square = product(|i, k| x[i][k], |k, j| x[k][j]);
        let mixed: [Square; 2] = [
            product(|i, k| x[i][k], |k, j| x[j][k]),
            product(|i, k| x[k][i], |k, j| x[k][j]),
        ];
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
            modes: Modes::of_three(t, c, d),
        }
    }

    /// The period in units in which L is about 1, where there is one, and by how much the rest of the motion grows
    /// against the turning in it: |ln| of the ratio.
    pub fn period(&self) -> Option<(Ball, f64)> {
        let (period, drift) = self.modes.period()?;
        Some((period.over(self.slower), drift))
    }

    /// The period in s.
    pub fn period_s(&self) -> Option<f64> {
        self.period().map(|(period, _)| shifted(period.hi, self.power))
    }

    /// The time in which the strain grows by `strain`.
    pub fn time_of_strain(&self, strain: Ball) -> Time {
        Time {
            span: strain.over(self.magnitude) * self.slower,
            turns: None,
        }
    }

    /// `time_s` seconds.
    pub fn time_of_seconds(&self, time_s: f64) -> Time {
        let span = shifted(time_s, -self.power);
        let rounded = if shifted(span, self.power) == time_s {
            0.0
        } else {
            span * f64::EPSILON
        };
        Time {
            span: Ball::exact(span).widened(rounded) * self.slower,
            turns: None,
        }
    }

    /// The time of `turns` periods, where there is a period.
    pub fn time_of_periods(&self, turns: Ball) -> Option<Time> {
        let (period, _) = self.modes.period()?;
        Some(Time {
            span: turns * period,
            turns: Some(turns),
        })
    }

    /// As long as rods of another aspect ratio in this flow take for `turns` of their periods.
    pub fn time_of_periods_of(&self, mean: &Self, turns: Ball) -> Option<Time> {
        let (period, _) = mean.period()?;
        Some(Time {
            span: turns * period * self.slower,
            turns: None,
        })
    }

    /// The map q = M p, up to a factor.
    pub fn map(&self, time: Time) -> Square {
        self.map_of(&self.modes, time)
    }

    /// The map of the coordinates that `modes` stands for; its other columns mean nothing.
    pub fn map_of(&self, modes: &Modes, time: Time) -> Square {
        let [a0, a1, a2] = modes.coefficients(time);
        from_fn(|i| {
            from_fn(|j| {
                let one = if i == j { a0 } else { Ball::ZERO };
                one + a1 * self.n[i][j] + a2 * self.n_squared[i][j]
            })
        })
    }

    /// What moves a rod that starts along `p`: of the coordinates only those that it can reach, so that a rod on an axis
    /// that is one of the flow's stays there.
    pub fn modes_from(&self, p: [f64; 3]) -> Modes {
        let mut reached = p.map(|component| component != 0.0);
        for _ in 0..2 {
            reached = from_fn(|i| reached[i] || (0..3).any(|j| reached[j] && !self.n[i][j].is_zero()));
        }
        let axes: Vec<usize> = (0..3).filter(|axis| reached[*axis]).collect();
        match axes[..] {
            [i, j] => {
                let (a, b) = (self.n[i][i], self.n[j][j]);
                let half = (a - b).scaled(0.5);
                Modes::of_two((a + b).scaled(0.5), half * half + self.n[i][j] * self.n[j][i])
            }
            [_, _, _] => self.modes,
            _ => Modes::None,
        }
    }

    /// Where `p` goes, up to a factor, under `modes` of [`Self::modes_from`].
    pub fn moved(&self, modes: &Modes, p: [f64; 3], time: Time) -> [Ball; 3] {
        let coefficients = modes.coefficients(time);
        let p = p.map(Ball::exact);
        let once = times(&self.n, p);
        let twice = times(&self.n_squared, p);
        from_fn(|i| coefficients[0] * p[i] + coefficients[1] * once[i] + coefficients[2] * twice[i])
    }
}

fn times(matrix: &Square, p: [Ball; 3]) -> [Ball; 3] {
    from_fn(|i| matrix[i][0] * p[0] + matrix[i][1] * p[1] + matrix[i][2] * p[2])
}

fn product(a: impl Fn(usize, usize) -> Ball, b: impl Fn(usize, usize) -> Ball) -> Square {
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

/// L times a power of two that makes its largest component about 1, and the power's exponent.
fn scaled(flow: &VelocityGradient) -> (Square, i32) {
    let l = flow.per_s();
    let power = -exponent(l.amax());
    let component = |i: usize, j: usize| {
        let component = l[(i, j)];
        let scaled = shifted(component, power);
        let lost = shifted(scaled, -power) != component;
        Ball::exact(scaled).widened(if lost { 1e-320 } else { 0.0 })
    };
    (from_fn(|i| from_fn(|j| component(i, j))), power)
}

/// The exponent of the power of two below |x|, 0 for 0.
fn exponent(x: f64) -> i32 {
    if x == 0.0 {
        0
    } else {
        libm::log2(x.abs()).floor() as i32
    }
}

/// x · 2^power.
fn shifted(x: f64, power: i32) -> f64 {
    libm::scalbn(x, power)
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

/// L less a third of its trace, in two steps: where a third is a double, nothing is rounded.
fn traceless(mut l: Square) -> Square {
    for step in 0..2 {
        let sum = trace(&l);
        let third = if step == 0 {
            Ball::exact(sum.hi / 3.0)
        } else {
            sum.over(Ball::exact(3.0))
        };
        for (i, row) in l.iter_mut().enumerate() {
            row[i] = row[i] - third;
        }
    }
    l
}

/// The middle of a map as doubles, its largest component about 1, and its error against its own size.
pub(super) fn rounded(map: &Square) -> (Matrix3<f64>, f64) {
    let middle = Matrix3::from_fn(|i, j| map[i][j].hi);
    let power = -exponent(middle.amax());
    let error = Matrix3::from_fn(|i, j| shifted(map[i][j].error, power));
    let middle = middle.map(|component| shifted(component, power));
    let relative = error.norm() / middle.norm();
    (middle, known(relative))
}

/// An error that is no number is one without bound.
pub(super) fn known(error: f64) -> f64 {
    if error.is_nan() { f64::INFINITY } else { error }
}
