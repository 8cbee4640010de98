//! Means over a density, as sums over its harmonics.

use super::frame::Frame;
use super::harmonics::{Basis, modulus, sphere_rule};
use crate::reference::isotropic::{PAIRS, QUADRUPLES};

/// Number of means: ⟨|p_i|⟩, ⟨p_i p_j⟩, ⟨p_i p_j p_k p_l⟩.
pub const MEANS: usize = 3 + 6 + 15;

/// Means over infinitely many rods.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Means {
    /// ⟨|p₁|⟩, ⟨|p₂|⟩, ⟨|p₃|⟩.
    pub projections: [f64; 3],
    /// a_ij = ⟨p_i p_j⟩ in the order of [`PAIRS`].
    pub second: [f64; 6],
    /// a_ijkl = ⟨p_i p_j p_k p_l⟩ in the order of [`QUADRUPLES`].
    pub fourth: [f64; 15],
    /// An upper estimate of the absolute error of each mean.
    pub error: f64,
}

impl Means {
    /// Means in the order of the fields.
    pub fn new(means: &[f64], error: f64) -> Self {
        Self {
            projections: std::array::from_fn(|i| means[i]),
            second: std::array::from_fn(|i| means[3 + i]),
            fourth: std::array::from_fn(|i| means[9 + i]),
            error,
        }
    }

    /// The extinction angle of flow birefringence in degrees: from axis 2 to the axis of a_ij in the plane of 1 and 2.
    pub fn extinction_angle_deg(&self) -> f64 {
        let [a11, a22, _, a12, ..] = self.second;
        (0.5 * (2.0 * a12).atan2(a22 - a11)).to_degrees()
    }

    /// Adds means and their error, times a weight ≥ 0.
    pub fn add(&mut self, weight: f64, other: &Self) {
        self.all_mut().zip(other.all()).for_each(|(sum, x)| *sum += weight * x);
        self.error += weight * other.error;
    }

    /// The largest difference.
    pub fn apart(&self, other: &Self) -> f64 {
        crate::worst(self.all().zip(other.all()).map(|(a, b)| (a - b).abs()))
    }

    fn all(&self) -> impl Iterator<Item = f64> {
        let Self { projections, second, fourth, .. } = *self;
        projections.into_iter().chain(second).chain(fourth)
    }

    fn all_mut(&mut self) -> impl Iterator<Item = &mut f64> {
        self.projections.iter_mut().chain(&mut self.second).chain(&mut self.fourth)
    }

    /// A mean rounded to as many decimals as the error allows, eleven at most.
    pub fn certain(&self, mean: f64) -> f64 {
        let decimals = -(2.0 * self.error.max(1e-12)).log10();
        format!("{mean:.*}", decimals.clamp(0.0, 11.0) as usize).parse::<f64>().unwrap_or(mean) + 0.0
    }
}

/// The means as linear functions of the unknowns.
#[derive(Clone, Debug, PartialEq)]
pub struct Functionals {
    /// Rows of ⟨|p_i|⟩, to which every degree contributes.
    pub moduli: [Vec<f64>; 3],
    /// Rows of the moments, over the unknowns up to degree 4.
    pub moments: Vec<Vec<f64>>,
}

impl Functionals {
    /// The means in the laboratory's axes, of a density in the frame's axes.
    pub fn new(frame: &Frame, basis: &Basis) -> Self {
        let shares = modulus(basis.degree);
        let moduli = [0, 1, 2].map(|axis| {
            let mut direction = [0.0; 3];
            direction[axis] = 1.0;
            let mut row = basis.values(frame.inward(direction));
            for (value, (l, _, _)) in row.iter_mut().zip(basis.unknowns()) {
                *value *= shares[l / 2];
            }
            row
        });
        let low = Basis { degree: 4.min(basis.degree), ..*basis };
        let mut moments = vec![vec![0.0; low.len()]; MEANS - 3];
        // Products of four components and harmonics of degree 4 have degree 8.
        for (direction, weight) in sphere_rule(5) {
            let (values, p) = (low.values(direction), frame.outward(direction));
            let second = PAIRS.map(|(i, j)| p[i] * p[j]);
            let fourth = QUADRUPLES.map(|q| q.iter().map(|i| p[i - 1]).product::<f64>());
            for (row, product) in moments.iter_mut().zip(second.iter().chain(&fourth)) {
                row.iter_mut().zip(&values).for_each(|(sum, value)| *sum += weight * product * value);
            }
        }
        Self { moduli, moments }
    }

    /// The means of the density with these unknowns.
    pub fn of(&self, unknowns: &[f64]) -> [f64; MEANS] {
        let mut means = [0.0; MEANS];
        let rows = self.moduli.iter().chain(&self.moments);
        for (mean, row) in means.iter_mut().zip(rows) {
            *mean = row.iter().zip(unknowns).map(|(a, b)| a * b).sum();
        }
        means
    }
}
