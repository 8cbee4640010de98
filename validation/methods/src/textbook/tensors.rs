//! A code for orientation tensors in plain arrays, each part of which can be made wrong. Its models
//! share nothing with the project's own but coefficients.

use crate::integrators::rk4;
use crate::tensors::ibof::{COEFFICIENTS, POWERS};
use crate::tensors::orthotropic::ORE;
use nalgebra::Matrix3;
use std::array::from_fn;

/// A tensor of rank 2.
pub type M = [[f64; 3]; 3];
/// a_ijkl from a and i, j, k, l from 0.
pub type Closure = fn(&M, [usize; 4]) -> f64;
/// C/C_I from a, D, L, γ̇ and a parameter.
pub type Diffusivity = fn(&M, &M, &M, f64, f64) -> M;

/// The parts of a code; [`Code::right`] has the right ones.
#[derive(Clone)]
pub struct Code {
    /// The L that the code uses, from L.
    pub gradient: fn(&M) -> M,
    /// The ½ of W and of D.
    pub half: [f64; 2],
    /// Before D_12, D_13 and D_23.
    pub shear: f64,
    /// Λ from r_e.
    pub shape: fn(f64) -> f64,
    /// γ̇ from L and D.
    pub speed: fn(&M, &M) -> f64,
    /// Before Wa and aW, and before Da and aD.
    pub sides: [[f64; 2]; 2],
    /// Before products of 𝔸 and D with k ≠ l.
    pub pairs: f64,
    /// Before Da + aD, and before 𝔸:D, from Λ.
    pub stretch: [fn(f64) -> f64; 2],
    /// The 2 and the 3 of 2 C_I γ̇ (δ − 3a), and the 1 before δ.
    pub spread: [f64; 3],
    /// a_ijkl.
    pub closure: Closure,
    /// κ in RSC's bracket and at the diffusion, from κ.
    pub slow: fn(f64) -> [f64; 2],
    /// Before Ca + aC and 𝔸:C, halves of the 5 and the 10.
    pub drift: [f64; 2],
    /// C/C_I from a, D, L, γ̇ and a parameter; `None` for C = C_I δ.
    pub anisotropic: Option<Diffusivity>,
    /// What is written for 11, 22, 33, 12, 13, 23.
    pub written: fn([f64; 6]) -> [f64; 6],
}

fn sum(of: impl Fn(usize) -> f64) -> f64 {
    (0..3).map(of).sum()
}

/// a:b.
pub fn double(a: &M, b: &M) -> f64 {
    sum(|i| sum(|j| a[i][j] * b[i][j]))
}

/// aᵀ.
pub fn transposed(a: &M) -> M {
    from_fn(|i| from_fn(|j| a[j][i]))
}

/// The matrix product.
pub fn product(a: &M, b: &M) -> M {
    from_fn(|i| from_fn(|j| sum(|k| a[i][k] * b[k][j])))
}

/// δ_ij.
pub const fn delta(i: usize, j: usize) -> f64 {
    if i == j { 1.0 } else { 0.0 }
}

/// The linear closure with other numbers for 1/7 and −1/35.
pub fn linear_by(a: &M, [i, j, k, l]: [usize; 4], seventh: f64, ones: f64) -> f64 {
    let d = delta;
    let of_a = a[i][j] * d(k, l) + a[i][k] * d(j, l) + a[i][l] * d(j, k);
    let of_others = a[k][l] * d(i, j) + a[j][l] * d(i, k) + a[j][k] * d(i, l);
    seventh * (of_a + of_others) + ones * (d(i, j) * d(k, l) + d(i, k) * d(j, l) + d(i, l) * d(j, k))
}

/// The linear closure.
pub fn linear(a: &M, at: [usize; 4]) -> f64 {
    linear_by(a, at, 1.0 / 7.0, -1.0 / 35.0)
}

/// The linear closure of directions in a plane.
pub fn planar(a: &M, at: [usize; 4]) -> f64 {
    linear_by(a, at, 1.0 / 6.0, -1.0 / 24.0)
}

/// The determinant of the plane 12.
pub fn in_plane(a: &M) -> f64 {
    a[0][0] * a[1][1] - a[0][1] * a[1][0]
}

/// The quadratic closure.
pub fn quadratic(a: &M, [i, j, k, l]: [usize; 4]) -> f64 {
    a[i][j] * a[k][l]
}

/// det a.
pub fn determinant(a: &M) -> f64 {
    sum(|j| a[0][j] * (a[1][(j + 1) % 3] * a[2][(j + 2) % 3] - a[1][(j + 2) % 3] * a[2][(j + 1) % 3]))
}

/// f times the quadratic closure and 1 − f times the linear one.
pub fn hybrid_by(a: &M, at: [usize; 4], f: f64) -> f64 {
    f * quadratic(a, at) + (1.0 - f) * linear(a, at)
}

/// The hybrid closure.
pub fn hybrid(a: &M, at: [usize; 4]) -> f64 {
    hybrid_by(a, at, 1.0 - 27.0 * determinant(a))
}

/// C/C_I of iARD: δ − 4 C_M D²/γ̇², with another factor for the 4.
pub fn iard(d: &M, speed: f64, c_m: f64, four: f64) -> M {
    iard_of(&product(d, d), c_m, four / (speed * speed))
}

/// δ − `factor` C_M `square`.
pub fn iard_of(square: &M, c_m: f64, factor: f64) -> M {
    from_fn(|i| from_fn(|j| delta(i, j) - factor * c_m * square[i][j]))
}

/// C/C_I of pARD: the `shares` along the axes of a, from the largest eigenvalue.
pub fn along(a: &M, shares: [f64; 3]) -> M {
    let (_, axes) = axes_of(a);
    from_fn(|i| from_fn(|j| sum(|k| shares[k] * axes[k][i] * axes[k][j])))
}

/// Eigenvalues from the largest, and their axes.
fn axes_of(a: &M) -> ([f64; 3], M) {
    let eigen = Matrix3::from_fn(|i, j| a[i][j]).symmetric_eigen();
    let mut order = [0, 1, 2];
    order.sort_by(|i, j| eigen.eigenvalues[*j].total_cmp(&eigen.eigenvalues[*i]));
    (order.map(|k| eigen.eigenvalues[k]), order.map(|k| eigen.eigenvectors.column(k).into_owned().into()))
}

/// IBOF.
pub fn ibof(a: &M, at: [usize; 4]) -> f64 {
    ibof_by(a, at, invariants, |_, _, c| c, true)
}

/// Eigenvalues and their axes.
pub type Axes = ([f64; 3], M);

/// ORE from polynomials of the first two eigenvalues, which are sorted by `sort` from the largest; R is `axes`.
pub fn ore_by(a: &M, at: [usize; 4], sort: fn(Axes) -> Axes, change: fn(usize, usize, f64) -> f64) -> f64 {
    let (values, axes) = sort(axes_of(a));
    let [x, y, _] = values;
    let (xx, yy) = (x * x, y * y);
    let terms =
        [1.0, x, y, x * y, xx, yy, xx * y, x * yy, xx * x, yy * y, xx * yy, xx * x * y, x * yy * y, xx * xx, yy * yy];
    let own: [f64; 3] = from_fn(|k| (0..15).map(|n| change(n, k, ORE[n][k]) * terms[n]).sum());
    // Three equations a_iikk = a_ii for the three others.
    let half = 0.5 * sum(|k| values[k] - own[k]);
    let mixed = |i: usize, j: usize| half - (values[3 - i - j] - own[3 - i - j]);
    let inner = |[i, j, k, l]: [usize; 4]| match (i == j && k == l, (i == k && j == l) || (i == l && j == k)) {
        (true, true) => own[i],
        (true, false) => mixed(i, k),
        (false, true) => mixed(i, j),
        (false, false) => 0.0,
    };
    let [i, j, k, l] = at;
    let each = |m, n, p, q| match inner([m, n, p, q]) {
        0.0 => 0.0,
        value => axes[m][i] * axes[n][j] * axes[p][k] * axes[q][l] * value,
    };
    sum(|m| sum(|n| sum(|p| sum(|q| each(m, n, p, q)))))
}

/// ORE.
pub fn ore(a: &M, at: [usize; 4]) -> f64 {
    ore_by(a, at, |axes| axes, |_, _, c| c)
}

/// IBOF with other invariants and coefficients, without `S`'s symmetry if `whole` is false.
pub fn ibof_by(
    a: &M,
    at: [usize; 4],
    invariants: fn(&M) -> [f64; 2],
    change: fn(usize, usize, f64) -> f64,
    whole: bool,
) -> f64 {
    let [second, third] = invariants(a);
    let beta = |k: usize| -> f64 {
        let term = |n: usize| change(n, k, COEFFICIENTS[n][k]) * second.powi(POWERS[n].0) * third.powi(POWERS[n].1);
        (0..21).map(term).sum()
    };
    let [b3, b4, b6] = [beta(0), beta(1), beta(2)];
    let b1 = 0.6
        * (-1.0 / 7.0 + 0.2 * b3 * (1.0 / 7.0 + 4.0 / 7.0 * second + 8.0 / 3.0 * third)
            - b4 * (0.2 - 8.0 / 15.0 * second - 14.0 / 15.0 * third)
            - b6 * (1.0 / 35.0 - 24.0 / 105.0 * third - 4.0 / 35.0 * second
                + 16.0 / 15.0 * second * third
                + 8.0 / 35.0 * second * second));
    let b2 = 6.0 / 7.0
        * (1.0 - 0.2 * b3 * (1.0 + 4.0 * second) + 1.4 * b4 * (1.0 / 6.0 - second)
            - b6 * (-0.2 + 2.0 / 3.0 * third + 0.8 * second - 1.6 * second * second));
    let b5 = -0.8 * b3 - 1.4 * b4 - 1.2 * b6 * (1.0 - 4.0 / 3.0 * second);
    let one: M = from_fn(|i| from_fn(|j| delta(i, j)));
    let square = product(a, a);
    let parts =
        [(b1, one, one), (b2, one, *a), (b3, *a, *a), (b4, one, square), (b5, *a, square), (b6, square, square)];
    let [i, j, k, l] = at;
    let pairs = [[i, j, k, l], [i, k, j, l], [i, l, j, k]];
    let used = &pairs[..if whole { 3 } else { 1 }];
    let mean = |(beta, p, q): &(f64, M, M)| {
        let sum: f64 = used.iter().map(|[i, j, k, l]| p[*i][*j] * q[*k][*l] + q[*i][*j] * p[*k][*l]).sum();
        beta * sum / (2 * used.len()) as f64
    };
    parts.iter().map(mean).sum()
}

/// II and III of IBOF.
pub fn invariants(a: &M) -> [f64; 2] {
    [0.5 * (1.0 - double(a, a)), determinant(a)]
}

impl Code {
    /// The right code with a closure.
    pub fn right(closure: Closure) -> Self {
        Self {
            gradient: |l| *l,
            half: [0.5, 0.5],
            shear: 1.0,
            sides: [[1.0, -1.0], [1.0, 1.0]],
            pairs: 1.0,
            shape: |r| 1.0 - 2.0 / (r * r + 1.0),
            speed: |_, d| (2.0 * double(d, d)).sqrt(),
            stretch: [|shape| shape, |shape| 2.0 * shape],
            spread: [2.0, 3.0, 1.0],
            closure,
            slow: |kappa| [kappa; 2],
            drift: [2.5, 5.0],
            anisotropic: None,
            written: |six| six,
        }
    }

    /// a_ijkl of each two pairs, written as a_ij is on rows and on columns.
    pub fn fourth(&self, a: &M, pairs: [(usize, usize); 6]) -> Vec<f64> {
        let row = |(i, j)| (self.written)(pairs.map(|(k, l)| (self.closure)(a, [i, j, k, l])));
        let rows = pairs.map(row);
        let columns: [[f64; 6]; 6] = from_fn(|k| (self.written)(rows.map(|row| row[k])));
        (0..6).flat_map(|j| (j..6).map(move |k| columns[k][j])).collect()
    }

    /// da_ij/dt with the parameters C_I and κ, C_M or Ω.
    pub fn rate(&self, a: &M, l: &M, r: f64, [c_i, other]: [f64; 2]) -> M {
        let l = (self.gradient)(l);
        let w: M = from_fn(|i| from_fn(|j| self.half[0] * (l[i][j] - l[j][i])));
        let side = |i, j| if i == j { 1.0 } else { self.shear };
        let d: M = from_fn(|i| from_fn(|j| side(i, j) * self.half[1] * (l[i][j] + l[j][i])));
        let shape = (self.shape)(r);
        let [strain, fourth] = self.stretch.map(|of| of(shape));
        let [two, three, one] = self.spread;
        let speed = (self.speed)(&l, &d);
        let weight = |k: usize, m: usize| if k == m { 1.0 } else { self.pairs };
        let by_closure = |x: &M| -> M {
            let term = |i, j, k: usize, m: usize| match x[k][m] {
                // Saves time: most of D is zeros.
                0.0 => 0.0,
                other => weight(k, m) * (self.closure)(a, [i, j, k, m]) * other,
            };
            from_fn(|i| from_fn(|j| sum(|k| sum(|m| term(i, j, k, m)))))
        };
        let [mut contracted, mut slow] = [by_closure(&d), [[0.0; 3]; 3]];
        let mut kappas = [1.0; 2];
        if self.anisotropic.is_none() && !other.is_nan() {
            kappas = (self.slow)(other);
            let (values, axes) = axes_of(a);
            let along = |x: &M, e: &[f64; 3]| sum(|i| sum(|j| e[i] * x[i][j] * e[j]));
            for (value, e) in values.iter().zip(&axes) {
                let part = (1.0 - kappas[0]) * (value * along(&d, e) - along(&contracted, e));
                slow = from_fn(|i| from_fn(|j| slow[i][j] + part * e[i] * e[j]));
            }
        }
        contracted = from_fn(|i| from_fn(|j| contracted[i][j] + slow[i][j]));
        let diffusion: M = match self.anisotropic {
            None => from_fn(|i| from_fn(|j| two * kappas[1] * (one * delta(i, j) - three * a[i][j]))),
            Some(of) => {
                let c = of(a, &d, &l, speed, other);
                let (trace, fourth) = (sum(|k| c[k][k]), by_closure(&c));
                let both = |i: usize, j: usize| sum(|k| c[i][k] * a[k][j] + a[i][k] * c[k][j]);
                let each = |i: usize, j: usize| {
                    c[i][j] - trace * a[i][j] - self.drift[0] * both(i, j) + self.drift[1] * fourth[i][j]
                };
                from_fn(|i| from_fn(|j| two * each(i, j)))
            }
        };
        let [[wa, aw], [da, ad]] = self.sides;
        let rate = |i: usize, j: usize| {
            let turned = sum(|k| wa * w[i][k] * a[k][j] + aw * a[i][k] * w[k][j]);
            let stretched = sum(|k| da * d[i][k] * a[k][j] + ad * a[i][k] * d[k][j]);
            turned + strain * stretched - fourth * contracted[i][j] + c_i * speed * diffusion[i][j]
        };
        // Six components are stored: those above the diagonal.
        from_fn(|i| from_fn(|j| rate(i.min(j), i.max(j))))
    }

    /// a_ij at the times, by RK4 in steps of `strain`.
    pub fn path(&self, start: &M, l: &M, r: f64, c_i: f64, times_s: &[f64], strain: f64) -> Vec<M> {
        let rate = |a: Matrix3<f64>| Matrix3::from(self.rate(&a.into(), l, r, [c_i, f64::NAN]));
        let norm = double(l, l).sqrt();
        let (mut a, mut now) = (Matrix3::from(*start), 0.0);
        // Columns are rows: all is symmetric.
        let to = |time: &f64| -> M {
            let steps = ((time - now) * norm / strain).ceil();
            let h = (time - now) / steps;
            (a, now) = ((0..steps as usize).fold(a, |a, _| rk4(rate, a, h)), *time);
            a.into()
        };
        times_s.iter().map(to).collect()
    }
}
