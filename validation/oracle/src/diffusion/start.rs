//! The density of directions at t = 0.

use super::NoAnswer;
use super::frame::Frame;
use super::harmonics::{Basis, sphere_rule};
use std::f64::consts::PI;
use std::fmt;

/// The density of directions at t = 0.
#[derive(Clone, Copy)]
pub enum Start<'a> {
    /// Isotropic directions.
    Isotropic,
    /// A smooth function of p with ψ(−p) = ψ(p), in the laboratory's axes. It need not be normalised.
    Density(&'a (dyn Fn([f64; 3]) -> f64 + Sync)),
}

impl fmt::Debug for Start<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Isotropic => "Isotropic",
            Self::Density(_) => "Density",
        })
    }
}

impl Start<'_> {
    /// The harmonics of the start in the frame's axes, normalised.
    pub(super) fn unknowns(&self, frame: &Frame) -> Result<(Basis, Vec<f64>), NoAnswer> {
        let mean = (4.0 * PI).recip().sqrt();
        match self {
            Self::Isotropic => {
                let basis = Basis { degree: 8, order: 4, even: frame.even };
                let mut unknowns = vec![0.0; basis.len()];
                unknowns[0] = mean;
                Ok((basis, unknowns))
            }
            Self::Density(density) => {
                for degree in [16, 32, 64, 128] {
                    // The start need not have the flow's plane of reflection.
                    let basis = Basis { degree, order: degree, even: false };
                    let unknowns = projected(&basis, &|p| density(frame.outward(p)));
                    let high = unknowns[basis.offset(degree - 4)..].iter().map(|x| x * x).sum::<f64>().sqrt();
                    let scale = mean / unknowns[0];
                    if unknowns[0] > 0.0 && high * scale <= 1e-14 {
                        return Ok((basis, unknowns.iter().map(|x| x * scale).collect()));
                    }
                }
                Err(NoAnswer::RoughStart)
            }
        }
    }
}

/// The harmonics of `function`.
pub(super) fn projected(basis: &Basis, function: &dyn Fn([f64; 3]) -> f64) -> Vec<f64> {
    let mut unknowns = vec![0.0; basis.len()];
    for (p, weight) in sphere_rule(basis.degree + 8) {
        let share = weight * function(p);
        unknowns.iter_mut().zip(basis.values(p)).for_each(|(sum, value)| *sum += share * value);
    }
    unknowns
}
