//! Means over free rods that pointed at random in the plane of axes 1 and 2 at t = 0.
//!
//! p = q/|q| with q = F u, u = (cos φ, sin φ, 0), φ uniform. With M = FᵀF in the plane, δ = (det M)^½ and s = δ tr M +
//! 2δ²: ⟨u uᵀ/(u·M u)⟩ = (adj M + δ)/s, its derivative by M is −⟨u u u u/(u·M u)²⟩, and ⟨|f·u|/(u·M u)^½⟩ is elementary
//! in the axes of M.

use super::big::{Big, Bits};
use super::isotropic::{PAIRS, QUADRUPLES};
use super::motion::Matrix;

/// Bits of the answers: 80 more than may be lost.
pub(super) const PRECISION: usize = 208;

/// The moments of u, weighted so that F turns them into those of p.
pub(super) struct Means<'a> {
    map: &'a Matrix,
    bits: Bits,
    /// adj M, as [11, 22, 12].
    adjoint: [Big; 3],
    delta: Big,
    second: [Big; 3],
    scale: Big,
    trace: Big,
}

fn place(a: usize, b: usize) -> usize {
    if a == b { a } else { 2 }
}

impl<'a> Means<'a> {
    pub(super) fn of(map: &'a Matrix, bits: Bits) -> Self {
        let m = |a: usize, b: usize| (0..3).fold(bits.of(0.0), |sum, i| sum + &map[i][a] * &map[i][b]);
        let [m11, m22, m12] = [m(0, 0), m(1, 1), m(0, 1)];
        let delta = (&m11 * &m22 - m12.sqr()).sqrt();
        let trace = &m11 + &m22;
        let scale = &delta * &trace + bits.of(2.0) * delta.sqr();
        let adjoint = [m22, m11, -m12];
        let second = [(&adjoint[0] + &delta) / &scale, (&adjoint[1] + &delta) / &scale, &adjoint[2] / &scale];
        Self { map, bits, adjoint, delta, second, scale, trace }
    }

    /// a_ijkl in the order of [`QUADRUPLES`], or ⟨|p_i|⟩ and a_ij in that of [`PAIRS`].
    pub(super) fn values(&self, fourth: bool) -> Vec<Big> {
        if fourth {
            return QUADRUPLES.map(|q| self.moment(&q.map(|i| i - 1), &mut Vec::new())).into();
        }
        let projections = [0, 1, 2].map(|i| self.projection(i));
        projections.into_iter().chain(PAIRS.map(|(i, j)| self.moment(&[i, j], &mut Vec::new()))).collect()
    }

    /// Σ F_ia F_jb … ⟨u_a u_b …⟩.
    fn moment(&self, rows: &[usize], columns: &mut Vec<usize>) -> Big {
        let Some(row) = rows.get(columns.len()) else {
            return match columns[..] {
                [a, b] => self.second[place(a, b)].clone(),
                _ => self.weighted(columns),
            };
        };
        let mut sum = self.bits.of(0.0);
        for column in [0, 1] {
            columns.push(column);
            sum += &self.map[*row][column] * self.moment(rows, columns);
            columns.pop();
        }
        sum
    }

    /// ⟨u_a u_b u_c u_d/(u·M u)²⟩ = −∂⟨u_a u_b/(u·M u)⟩/∂M_cd.
    fn weighted(&self, columns: &[usize]) -> Big {
        let (bits, [a, b, c, d]) = (self.bits, [0, 1, 2, 3].map(|k| columns[k]));
        let one = |a: usize, b: usize| bits.of(if a == b { 1.0 } else { 0.0 });
        let adjoint = &self.adjoint[place(c, d)];
        // ∂δ/∂M_cd and ∂s/∂M_cd; adj M = tr M − M.
        let delta = adjoint / (bits.of(2.0) * &self.delta);
        let scale = &self.trace * &delta + &self.delta * one(c, d) + bits.of(2.0) * adjoint;
        let both = (one(a, c) * one(b, d) + one(a, d) * one(b, c)) / bits.of(2.0);
        (&self.second[place(a, b)] * scale - one(a, b) * (one(c, d) + delta) + both) / &self.scale
    }

    /// ⟨|p_i|⟩ = (δ/2π) ∫|g·w|/(w·adj M w) dα over directions w, g = adj(M^½) f/δ with f of row i.
    ///
    /// In the axes of adj M, k₁ ≤ k₂ and k = (k₂ − k₁)^½, the integral is 4 [g₁ atan(k c/√k₁)/√k₁ + g₂ atanh(k
    /// s/√k₂)/√k₂]/k with g = |g|(c, s).
    fn projection(&self, i: usize) -> Big {
        let (bits, two) = (self.bits, self.bits.of(2.0));
        let f = [&self.map[i][0], &self.map[i][1]];
        let [k11, k22, k12] = &self.adjoint;
        // adj(M^½) = (adj M + δ)/τ, τ² = tr M + 2δ.
        let root = (&self.trace + &two * &self.delta).sqrt() * &self.delta;
        let along = |a: usize, b: usize| {
            let diagonal = &self.adjoint[place(a, a)] + &self.delta;
            (diagonal * f[a] + k12 * f[b]) / &root
        };
        let [x, y] = [along(0, 1), along(1, 0)];
        let size = (x.sqr() + y.sqr()).sqrt();
        let factor = &two * &self.delta / bits.pi();
        let apart = ((k11 - k22).sqr() + (&two * k12).sqr()).sqrt();
        if size == Big::ZERO || apart == Big::ZERO {
            return factor * size / (&self.trace / two);
        }
        // The axis of k₁ has the angle β, cos 2β = (k₂₂ − k₁₁)/k², sin 2β = −2k₁₂/k².
        let (sine, cosine) = ((-(&two * k12)).atan2(&(k22 - k11)) / &two).sin_cos();
        let (g1, g2) = (&cosine * &x + &sine * &y, &cosine * &y - &sine * &x);
        let large = (&self.trace + &apart) / &two;
        // k₁ without cancellation: k₁k₂ = δ².
        let [k1, k2] = [self.delta.sqr() / &large, large].map(|k| k.sqrt());
        let k = apart.sqrt();
        let one = bits.of(1.0);
        let angle = (&k * &g1).atan2(&(&k1 * &size)) / k1;
        let share = &k * &g2 / (&k2 * &size);
        let area = ((&one + &share) / (&one - &share)).ln() / (&two * k2);
        factor * (g1 * angle + g2 * area) / k
    }
}

#[cfg(test)]
mod tests {
    use super::super::big::double;
    use super::super::motion::{Motion, Unit};
    use super::*;

    /// The same means by the trapezoid rule over φ, in doubles.
    fn summed(map: &[[f64; 3]; 3], fourth: bool) -> Vec<f64> {
        const NODES: usize = 4000;
        let mut sums = vec![0.0; if fourth { 15 } else { 9 }];
        for node in 0..NODES {
            let (s, c) = (std::f64::consts::TAU * (node as f64 + 0.5) / NODES as f64).sin_cos();
            let q = map.map(|row| row[0] * c + row[1] * s);
            let size = q.iter().map(|x| x * x).sum::<f64>().sqrt();
            let p = q.map(|x| x / size);
            let values: Vec<f64> = if fourth {
                QUADRUPLES.map(|q| q.iter().map(|i| p[i - 1]).product()).into()
            } else {
                p.map(f64::abs).into_iter().chain(PAIRS.map(|(i, j)| p[i] * p[j])).collect()
            };
            sums.iter_mut().zip(values).for_each(|(sum, x)| *sum += x / NODES as f64);
        }
        sums
    }

    #[test]
    fn means_are_those_of_a_sum_over_the_plane() {
        let couette = [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]];
        let askew = [[0.3, -0.5, 0.1], [0.8, 0.1, -0.2], [0.4, 0.6, -0.4]];
        for (gradient_per_s, aspect_ratio, time) in [(couette, 3.0, 0.0), (couette, 3.0, 1.7), (askew, 0.3, 1.3)] {
            let motion = Motion { gradient_per_s, aspect_ratio };
            let bits = motion.bits(time, Unit::Second, PRECISION);
            let map = motion.map(&bits.of(time), Unit::Second, bits).unwrap();
            let doubles = map.each_ref().map(|row| row.each_ref().map(double));
            let off = |map: &[[f64; 3]; 3], fourth| {
                let found = Means::of(&super::super::motion::matrix(|i, j| bits.of(map[i][j])), bits).values(fourth);
                let each = found.iter().zip(summed(&doubles, fourth)).map(|(a, b)| (double(a) - b).abs());
                crate::worst(each)
            };
            // |p_i| has kinks, where the rule's error is of the order of its squared step, 2e-6.
            assert!(off(&doubles, true) < 1e-13, "{:e}", off(&doubles, true));
            assert!(off(&doubles, false) < 3e-6, "{:e}", off(&doubles, false));
            let mut wrong = doubles;
            wrong[1][0] += 0.01;
            assert!(off(&wrong, true) > 1e-4 && off(&wrong, false) > 1e-3);
        }
    }
}
