//! Real spherical harmonics of even degree, orthonormal, and their products with p_i p_j.
//!
//! Y_lm are the complex harmonics with the Condon–Shortley phase. A real density is
//! ψ = Σ_l [b_l0 Y_l0 + 2 Re Σ_{m>0} b_lm Y_lm]. The unknowns are b_l0, √2 Re b_lm and, in flows without a plane of
//! reflection, √2 Im b_lm, so that their Euclidean norm is the norm of ψ.

use std::f64::consts::{PI, SQRT_2};

/// The harmonics of an expansion: even degrees l ≤ `degree` (even), orders m ≤ `order`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Basis {
    /// The largest l, even.
    pub degree: usize,
    /// The largest m.
    pub order: usize,
    /// True if ψ is even in the azimuth, so that every b_lm is real.
    pub even: bool,
}

impl Basis {
    /// Number of unknowns of degree `l`.
    pub fn width(&self, l: usize) -> usize {
        let order = l.min(self.order);
        if self.even { order + 1 } else { 2 * order + 1 }
    }

    /// Index of the first unknown of degree `l`.
    pub fn offset(&self, l: usize) -> usize {
        (0..l).step_by(2).map(|l| self.width(l)).sum()
    }

    /// Number of unknowns.
    pub fn len(&self) -> usize {
        self.offset(self.degree + 2)
    }

    /// (l, m, true for the imaginary part) of each unknown, in order.
    pub fn unknowns(&self) -> impl Iterator<Item = (usize, usize, bool)> {
        let basis = *self;
        (0..=basis.degree).step_by(2).flat_map(move |l| {
            (0..basis.width(l))
                .map(move |k| if basis.even { (l, k, false) } else { (l, k.div_ceil(2), k > 0 && k % 2 == 0) })
        })
    }

    /// Index of an unknown within its degree.
    pub fn place(&self, m: usize, imaginary: bool) -> usize {
        if self.even { m } else { (2 * m + usize::from(imaginary)).saturating_sub(1) }
    }

    /// Converts the unknowns of the basis `from` to this one; those that `from` lacks are 0.
    pub fn take(&self, from: &Basis, values: &[f64]) -> Vec<f64> {
        let mut taken = vec![0.0; self.len()];
        let (mut there, mut here) = (0, 0);
        for l in (0..=self.degree.min(from.degree)).step_by(2) {
            let shared = self.width(l).min(from.width(l));
            taken[here..here + shared].copy_from_slice(&values[there..there + shared]);
            (there, here) = (there + from.width(l), here + self.width(l));
        }
        taken
    }

    /// The functions of the basis at the unit vector `p`: ψ(p) = Σ value × unknown.
    pub fn values(&self, p: [f64; 3]) -> Vec<f64> {
        let (c, s, azimuth) = (p[2], p[0].hypot(p[1]), p[1].atan2(p[0]));
        let mut values = vec![0.0; self.len()];
        let offsets: Vec<_> = (0..=self.degree).step_by(2).map(|l| self.offset(l)).collect();
        // Y_mm at azimuth 0.
        let mut diagonal = (4.0 * PI).recip().sqrt();
        for m in 0..=self.order.min(self.degree) {
            if m > 0 {
                let m = m as f64;
                diagonal *= -s * ((2.0 * m + 1.0) / (2.0 * m)).sqrt();
            }
            let (sine, cosine) = (m as f64 * azimuth).sin_cos();
            let (mut before, mut now) = (0.0, diagonal);
            let up = |l: usize| height(l as i64, l as i64 - 1, m as i64);
            for l in m..=self.degree {
                if l % 2 == 0 {
                    let at = offsets[l / 2];
                    let weight = if m == 0 { 1.0 } else { SQRT_2 };
                    values[at + self.place(m, false)] = weight * now * cosine;
                    if !self.even && m > 0 {
                        values[at + self.place(m, true)] = -weight * now * sine;
                    }
                }
                let next = (c * now - up(l) * before) / up(l + 1);
                (before, now) = (now, next);
            }
        }
        values
    }
}

/// ⟨Y_{to,m}| p_z |Y_{from,m}⟩.
fn height(to: i64, from: i64, m: i64) -> f64 {
    let l = to.max(from) as f64;
    let m = m as f64;
    ((l - m) * (l + m) / (4.0 * l * l - 1.0)).max(0.0).sqrt()
}

/// ⟨Y_{to,m+1}| p_x + i p_y |Y_{from,m}⟩.
fn raise(to: i64, from: i64, m: i64) -> f64 {
    let size = |l: i64, m: i64| {
        let (l, m) = (l as f64, m as f64);
        ((l + m) * (l + m - 1.0) / (4.0 * l * l - 1.0)).max(0.0).sqrt()
    };
    if to > from { -size(to, m + 1) } else { size(from, -m) }
}

/// ⟨Y_{l',m'}| T |Y_{lm}⟩ with T = (3p_z² − 1)/2 for m' = m, p_z s for m' = m + 1, s² for m' = m + 2, s = p_x + i p_y,
/// and their complex conjugates for m' < m. Real.
pub fn quadratic((l_to, m_to): (i64, i64), (l, m): (i64, i64)) -> f64 {
    if m_to < m {
        return quadratic((l, m), (l_to, m_to));
    }
    // The sum goes over the odd degrees next to both, at the order in between.
    let via = |order: i64, step: &dyn Fn(i64) -> f64| {
        let degrees = [l - 1, l + 1].into_iter().filter(|b| (b - l_to).abs() == 1 && *b >= order.abs());
        degrees.map(step).sum::<f64>()
    };
    match m_to - m {
        0 => {
            let square = via(m, &|b| height(l_to, b, m) * height(b, l, m));
            1.5 * square - if l_to == l { 0.5 } else { 0.0 }
        }
        1 => via(m + 1, &|b| height(l_to, b, m + 1) * raise(b, l, m)),
        2 => via(m + 1, &|b| raise(l_to, b, m + 1) * raise(b, l, m)),
        _ => 0.0,
    }
}

/// Factors of Funk & Hecke for |n·p|: 2π ∫₋₁¹ |x| P_l dx for even l up to `degree`.
pub fn modulus(degree: usize) -> Vec<f64> {
    let halves = by_ratio(degree, 0.5, |l| -(l - 1.0) / (l + 4.0));
    halves.into_iter().map(|half| 4.0 * PI * half).collect()
}

/// Values for even l up to `degree`, from that for l = 0 and the ratio of the next one to that for l.
pub fn by_ratio(degree: usize, first: f64, ratio: impl Fn(f64) -> f64) -> Vec<f64> {
    let next = |(l, value): &(usize, f64)| Some((l + 2, value * ratio(*l as f64)));
    std::iter::successors(Some((0, first)), next).take_while(|(l, _)| *l <= degree).map(|(_, value)| value).collect()
}

/// Nodes and weights of Gauss–Legendre's rule on [−1, 1].
pub fn gauss_legendre(count: usize) -> Vec<(f64, f64)> {
    let n = count as f64;
    let node = |k: usize| {
        let mut x = (PI * (k as f64 + 0.75) / (n + 0.5)).cos();
        let mut slope = 1.0;
        for _ in 0..100 {
            let (mut before, mut now) = (0.0, 1.0);
            for l in 0..count {
                let l = l as f64;
                (before, now) = (now, ((2.0 * l + 1.0) * x * now - l * before) / (l + 1.0));
            }
            slope = n * (x * now - before) / (x * x - 1.0);
            let step = now / slope;
            x -= step;
            if step.abs() < 1e-15 {
                break;
            }
        }
        (x, 2.0 / ((1.0 - x * x) * slope * slope))
    };
    (0..count).map(node).collect()
}

/// Directions and weights that integrate harmonics over the sphere exactly up to degree `2 rings − 1`.
pub fn sphere_rule(rings: usize) -> Vec<([f64; 3], f64)> {
    let around = 2 * rings;
    let each = |(z, weight): (f64, f64)| {
        let rho = (1.0 - z * z).sqrt();
        (0..around).map(move |k| {
            let (sine, cosine) = (2.0 * PI * (k as f64 + 0.3) / around as f64).sin_cos();
            ([rho * cosine, rho * sine, z], weight * 2.0 * PI / around as f64)
        })
    };
    gauss_legendre(rings).into_iter().flat_map(each).collect()
}
