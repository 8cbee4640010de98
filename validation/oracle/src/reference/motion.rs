//! The exact motion of a free rod: p(t) = q/|q|, q = F(t) p(0), with dF/dt = A F, A = W + ΛD.
//!
//! W and D are the antisymmetric and symmetric parts of L, Λ = (r_e² − 1)/(r_e² + 1). Entries of L and r_e are exact.

use super::big::{Big, Bits, double, magnitude};

/// The largest |A|t in units of strain that is computed, in flows other than plane Couette flow.
pub const LARGEST_STRAIN: f64 = 5000.0;

/// A 3×3 matrix, by rows.
pub type Matrix = [[Big; 3]; 3];

/// A unit of time.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Unit {
    /// The period of rotation T (eq. 15) of the (mean) aspect ratio.
    Period,
    /// Strain, ∫(2D:D)^½ dt; in steady plane Couette flow |G| t.
    Strain,
    /// Seconds.
    Second,
}

/// A rod or disc in a steady flow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Motion {
    /// L in 1/s; row i and column j hold ∂u_i/∂x_j; finite.
    pub gradient_per_s: [[f64; 3]; 3],
    /// r_e > 0; ∞ for Λ = 1.
    pub aspect_ratio: f64,
}

impl Motion {
    /// G in 1/s if the flow is u₂ = G x₁ and rods turn in it, that is if r_e is finite; else `None`.
    pub fn couette(&self) -> Option<f64> {
        let rate = self.gradient_per_s[1][0];
        let others = self.gradient_per_s.as_flattened().iter().filter(|x| **x != 0.0).count();
        (rate != 0.0 && others == 1 && self.aspect_ratio.is_finite()).then_some(rate)
    }

    /// True if ΛD has no part but its trace: then rods turn as the liquid does, and isotropic ones stay so.
    pub fn only_turns(&self) -> bool {
        let l = &self.gradient_per_s;
        let alike = l[0][0] == l[1][1] && l[1][1] == l[2][2];
        let skew = [(0, 1), (0, 2), (1, 2)].iter().all(|&(i, j)| l[i][j] == -l[j][i]);
        self.aspect_ratio == 1.0 || (alike && skew)
    }

    /// T·|G| = 2π(r_e + 1/r_e): the strain of a period in plane Couette flow (eq. 15).
    pub fn strain_per_period(&self, bits: Bits) -> Big {
        let r = bits.of(self.aspect_ratio);
        bits.of(2.0) * bits.pi() * (&r + bits.of(1.0) / &r)
    }

    /// (2D:D)^½, 1/s.
    pub fn strain_rate_per_s(&self, bits: Bits) -> Big {
        if let Some(rate) = self.couette() {
            return bits.of(rate.abs());
        }
        let l = |i: usize, j: usize| bits.of(self.gradient_per_s[i][j]);
        let pairs = (0..9).map(|k| (k / 3, k % 3));
        let sum = pairs.fold(bits.of(0.0), |sum, (i, j)| sum + (l(i, j) + l(j, i)).sqr());
        (sum / bits.of(2.0)).sqrt()
    }

    /// Converts a time to another unit; `None` if there is no period, or no strain to count it by.
    pub fn convert(&self, time: &Big, from: Unit, to: Unit, bits: Bits) -> Option<Big> {
        if from == to {
            return Some(time.clone());
        }
        let seconds = match from {
            Unit::Second => time.clone(),
            _ => time * self.unit_s(from, bits)?,
        };
        match to {
            Unit::Second => Some(seconds),
            Unit::Strain if self.strain_rate_per_s(bits) == Big::ZERO => Some(Big::ZERO),
            _ => Some(seconds / self.unit_s(to, bits)?),
        }
    }

    /// The number of seconds per unit; `None` if the unit is undefined in this flow.
    fn unit_s(&self, unit: Unit, bits: Bits) -> Option<Big> {
        let rate = self.strain_rate_per_s(bits);
        match unit {
            Unit::Second => Some(bits.of(1.0)),
            _ if rate == Big::ZERO => None,
            Unit::Strain => Some(bits.of(1.0) / rate),
            Unit::Period => self.couette().map(|_| self.strain_per_period(bits) / rate),
        }
    }

    /// The precision of a calculation that keeps `kept` bits after the losses due to the size of r_e and of the time.
    pub fn bits(&self, time: f64, unit: Unit, kept: usize) -> Bits {
        let shape = if self.aspect_ratio.is_finite() { 8 * magnitude(self.aspect_ratio) } else { 0 };
        if self.couette().is_some() {
            // Losses come from the time's whole turns, and from T in seconds.
            return Bits(kept + shape + magnitude(time) + magnitude(self.gradient_per_s[1][0]));
        }
        // F and its inverse grow as e^{|A|t} at most, their products of four as its fourth power.
        Bits(kept + shape + (4.0 * std::f64::consts::LOG2_E * self.strain(time, unit)) as usize)
    }

    /// A bound of |A|t, where |A| ≤ |L| (Frobenius).
    pub fn strain(&self, time: f64, unit: Unit) -> f64 {
        let bits = Bits(64);
        let seconds = self.convert(&bits.of(time), unit, Unit::Second, bits);
        let squares = self.gradient_per_s.as_flattened().iter().map(|x| bits.of(*x).sqr());
        let norm = squares.fold(bits.of(0.0), |sum, x| sum + x).sqrt();
        seconds.map_or(f64::INFINITY, |seconds| double(&(norm * seconds)).abs())
    }

    /// F at `time`; `None` if the unit is undefined in this flow.
    ///
    /// In plane Couette flow, with ω = 2π/T: q₁ = p₁ cos ωt − (p₂/r_e) sin ωt, q₂ = r_e p₁ sin ωt + p₂ cos ωt, q₃ = p₃
    /// (A.4, A.5). Otherwise the exponential of the traceless part of At; the trace only stretches q.
    pub fn map(&self, time: &Big, unit: Unit, bits: Bits) -> Option<Matrix> {
        match self.couette() {
            Some(rate) => {
                let turns = bits.round(self.convert(time, unit, Unit::Period, bits)?);
                Some(couette_map(&bits.of(self.aspect_ratio), &turns, rate.signum(), bits))
            }
            None => {
                let seconds = self.convert(time, unit, Unit::Second, bits)?;
                let strain = self.strain(double(time), unit);
                Some(exponential(&self.generator(&seconds, bits), strain, bits))
            }
        }
    }

    /// The traceless part of A t.
    fn generator(&self, seconds: &Big, bits: Bits) -> Matrix {
        let l = |i: usize, j: usize| bits.of(self.gradient_per_s[i][j]);
        let shape = if self.aspect_ratio.is_finite() {
            let square = bits.of(self.aspect_ratio).sqr();
            (&square - bits.of(1.0)) / (&square + bits.of(1.0))
        } else {
            bits.of(1.0)
        };
        let (half, third) = (bits.of(0.5), bits.of(1.0) / bits.of(3.0));
        let trace = (l(0, 0) + l(1, 1) + l(2, 2)) * &shape * third;
        matrix(|i, j| {
            let entry = &half * (l(i, j) - l(j, i)) + &half * (l(i, j) + l(j, i)) * &shape;
            let entry = if i == j { entry - &trace } else { entry };
            entry * seconds
        })
    }
}

fn couette_map(r: &Big, turns: &Big, sign: f64, bits: Bits) -> Matrix {
    let (sine, cosine) = turns.sin_cos_unit(1);
    let sine = sine * bits.of(sign);
    let (zero, one) = (bits.of(0.0), bits.of(1.0));
    [[cosine.clone(), -(&sine / r), zero.clone()], [r * &sine, cosine, zero.clone()], [zero.clone(), zero, one]]
}

/// exp M for |M| ≤ `norm`: the series of M/2^k, squared k times. k balances terms against squarings.
fn exponential(m: &Matrix, norm: f64, bits: Bits) -> Matrix {
    let halvings = norm.max(1.0).log2().ceil() as usize + (bits.0 as f64).sqrt() as usize;
    // A squaring doubles the error.
    let bits = Bits(bits.0 + 2 * halvings);
    let small = matrix(|i, j| bits.round(m[i][j].clone()) >> halvings as isize);
    let mut sum = matrix(|i, j| bits.of(if i == j { 1.0 } else { 0.0 }));
    let mut term = sum.clone();
    // |M/2^k| ≤ 2^-√bits: the terms beyond √bits + 1 are below 2^-bits.
    for k in 1..=(bits.0 as f64).sqrt() as usize + 2 {
        let divisor = bits.of(k as f64);
        let next = product(&term, &small);
        term = matrix(|i, j| &next[i][j] / &divisor);
        sum = matrix(|i, j| &sum[i][j] + &term[i][j]);
    }
    (0..halvings).fold(sum, |map, _| product(&map, &map))
}

/// The matrix of `entry(i, j)`.
pub fn matrix(entry: impl Fn(usize, usize) -> Big) -> Matrix {
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| entry(i, j)))
}

/// The matrix product a b.
pub fn product(a: &Matrix, b: &Matrix) -> Matrix {
    matrix(|i, j| &a[i][0] * &b[0][j] + &a[i][1] * &b[1][j] + &a[i][2] * &b[2][j])
}

/// The vector a x.
pub fn image(a: &Matrix, x: &[Big; 3]) -> [Big; 3] {
    [0, 1, 2].map(|i| &a[i][0] * &x[0] + &a[i][1] * &x[1] + &a[i][2] * &x[2])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apart(a: &Matrix, b: &Matrix) -> f64 {
        let differences = (0..9).map(|k| (k / 3, k % 3)).map(|(i, j)| double(&(&a[i][j] - &b[i][j])).abs());
        crate::worst(differences)
    }

    #[test]
    fn the_exponential_is_the_closed_form_in_couette_flow() {
        let bits = Bits(300);
        for (rate, aspect_ratio, strain) in [(0.5, 11.6, 100.0), (-3.0, 0.2, 7.0), (1.0, 1.0, 30.0), (1e10, 1e4, 0.3)] {
            let motion = Motion { gradient_per_s: [[0.0; 3], [rate, 0.0, 0.0], [0.0; 3]], aspect_ratio };
            let seconds = bits.of(strain) / bits.of(rate.abs());
            let closed = motion.map(&seconds, Unit::Second, bits).unwrap();
            let series = exponential(&motion.generator(&seconds, bits), strain, bits);
            // The tolerance is 300 bits, less some for entries of r_e and a hundred squarings.
            assert!(apart(&closed, &series) < 1e-75, "{rate} {aspect_ratio}");
            let wrong = Motion { aspect_ratio: aspect_ratio * (1.0 + f64::EPSILON), ..motion };
            let wrong = exponential(&wrong.generator(&seconds, bits), strain, bits);
            assert!(apart(&closed, &wrong) > 1e-30 || aspect_ratio == 1.0);
        }
    }

    #[test]
    fn extension_is_the_exponential_of_its_rates_and_a_trace_does_not_matter() {
        let bits = Bits(300);
        for trace in [0.0, 6.0] {
            let rates = [1.0 + trace, -0.75 + trace, -0.25 + trace];
            let motion = Motion {
                gradient_per_s: [[rates[0], 0.0, 0.0], [0.0, rates[1], 0.0], [0.0, 0.0, rates[2]]],
                aspect_ratio: 2.0,
            };
            let map = motion.map(&bits.of(3.0), Unit::Second, bits).unwrap();
            for (i, rate) in [1.0, -0.75, -0.25].into_iter().enumerate() {
                // Λ = 3/5.
                let expected = (bits.of(3.0 * rate) * bits.of(3.0) / bits.of(5.0)).exp();
                assert!(double(&(&map[i][i] / expected - bits.of(1.0))).abs() < 1e-75);
            }
        }
    }

    #[test]
    fn units_of_time_agree_with_eq_15_and_the_strain() {
        let bits = Bits(200);
        let motion = |gradient_per_s| Motion { gradient_per_s, aspect_ratio: 2.0 };
        let couette = motion([[0.0; 3], [-0.5, 0.0, 0.0], [0.0; 3]]);
        let one = bits.of(1.0);
        let seconds = couette.convert(&one, Unit::Period, Unit::Second, bits).unwrap();
        assert_eq!(double(&seconds), std::f64::consts::TAU * 2.5 / 0.5);
        let strain = couette.convert(&one, Unit::Second, Unit::Strain, bits).unwrap();
        assert_eq!(double(&strain), 0.5);
        let planar = motion([[1.0, 0.0, 0.0], [0.0, -1.0, 0.0], [0.0; 3]]);
        let strain = planar.convert(&one, Unit::Second, Unit::Strain, bits).unwrap();
        assert_eq!(double(&strain), 2.0);
        assert!(planar.convert(&one, Unit::Period, Unit::Second, bits).is_none());
        let turning = motion([[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0; 3]]);
        assert!(turning.convert(&one, Unit::Strain, Unit::Second, bits).is_none());
    }
}
