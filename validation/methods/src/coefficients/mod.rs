//! The effect of collisions on ⟨pp⟩ in the terms of fibre-orientation codes: Folgar & Tucker's coefficient C_I, with
//! ⟨pppp⟩ measured instead of closed.
//!
//! In plane Couette flow, per unit of strain,
//!   da/dγ = W·a − a·W + Λ(D·a + a·D − 2 ⟨pp p₁p₂⟩) + J,
//! which is exact for free rods with J = 0. J = Σ(p′p′ − pp)/(rods × strain) over the steps of all rods, from the
//! direction p that Jeffery's motion alone would have given to the direction p′ that came. Folgar & Tucker (1984) put J
//! = 2 C_I (1 − 3a); C_I is the best factor by least squares over all nine components. Koch (1995) has an anisotropic
//! diffusivity.

mod diffusing;
pub mod jumps;
mod of_run;
mod watched;

pub use diffusing::{Diffusing, Diffusion, free};
pub use of_run::of_run;
pub use watched::watched;

use crate::tensors::fourth::Fourth;
use crate::tensors::models::diffusion;
use nalgebra::{Matrix2, Matrix3, Vector2};
use shearbed_oracle::spheroid;

/// Means over rods and over a window of time, of one replica or several.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    /// The tensor ⟨p_i p_j⟩.
    pub second: Matrix3<f64>,
    /// ⟨p_i p_j p_k p_l⟩.
    pub fourth: Fourth,
    /// ⟨p_i p_j p₁² p₂²⟩.
    pub sixth: Matrix3<f64>,
    /// J, per unit of strain.
    pub gain: Matrix3<f64>,
}

impl Means {
    /// The means of several replicas, leaving out the one with index `without`.
    pub fn of(all: &[Self], without: Option<usize>) -> Self {
        let kept = all.iter().enumerate().filter(|(k, _)| Some(*k) != without);
        let count = (all.len() - usize::from(without.is_some())) as f64;
        let mut sum = Self::default();
        for (_, one) in kept {
            sum.second += one.second / count;
            sum.fourth.0 += one.fourth.0 / count;
            sum.sixth += one.sixth / count;
            sum.gain += one.gain / count;
        }
        sum
    }

    /// ⟨p_i p_j p₁ p₂⟩.
    pub fn sheared(&self) -> Matrix3<f64> {
        Matrix3::from_fn(|i, j| self.fourth.at(i, j, 0, 1))
    }

    /// 2(1 − 3a): the effect of rotary diffusion with C_I = 1.
    pub fn diffusion(&self) -> Matrix3<f64> {
        (Matrix3::identity() - self.second * 3.0) * 2.0
    }

    /// C_I by least squares over the nine components.
    pub fn coefficient(&self) -> f64 {
        let diffusion = self.diffusion();
        self.gain.dot(&diffusion) / diffusion.norm_squared()
    }

    /// The relative residual of a single C_I: |J − 2 C_I (1 − 3a)|/|J|.
    pub fn misfit(&self) -> f64 {
        (self.gain - self.diffusion() * self.coefficient()).norm() / self.gain.norm()
    }

    /// What a diffusivity C over G does: 2C − 2 tr(C) a − 5(Ca + aC) + 10 ⟨pppp⟩:C.
    pub fn diffused(&self, diffusivity: &Matrix3<f64>) -> Matrix3<f64> {
        diffusion(&self.second, &self.fourth, diffusivity)
    }

    /// Koch's diffusivities over G: (D:⟨pppp⟩:D) δ and D:⟨pppppp⟩:D over G², which are tr⟨pp p₁²p₂²⟩ δ and ⟨pp p₁²p₂²⟩.
    pub fn diffusivities_of_koch(&self) -> [Matrix3<f64>; 2] {
        [Matrix3::identity() * self.sixth.trace(), self.sixth]
    }

    /// β₁ and β₂ of C = β₁ (D:⟨pppp⟩:D) δ/G² + β₂ D:⟨pppppp⟩:D/G² (Koch 1995) by least squares over the nine components
    /// of J, and the relative residual.
    pub fn koch(&self) -> ([f64; 2], f64) {
        let parts = self.diffusivities_of_koch().map(|c| self.diffused(&c));
        let normal = Matrix2::from_fn(|i, j| parts[i].dot(&parts[j]));
        let right = Vector2::from_fn(|i, _| parts[i].dot(&self.gain));
        let beta = normal.lu().solve(&right).map_or([f64::NAN; 2], Into::into);
        let fitted = parts[0] * beta[0] + parts[1] * beta[1];
        (beta, (self.gain - fitted).norm() / self.gain.norm())
    }

    /// The rods' stress over μ_fiber G: σ₁₂, N₁ = σ₂₂ − σ₁₁ and N₂ = σ₁₁ − σ₃₃.
    pub fn stress(&self) -> [f64; 3] {
        let s = self.sheared();
        [s[(0, 1)], s[(1, 1)] - s[(0, 0)], s[(0, 0)] - s[(2, 2)]]
    }

    /// σ₁₂/(μG n a³) of spheroids with the finite aspect ratio r_e.
    pub fn spheroids(&self, aspect_ratio: f64) -> f64 {
        let in_plane = self.second[(0, 0)] + self.second[(1, 1)];
        spheroid::shear_stress(aspect_ratio, self.sheared()[(0, 1)], in_plane)
    }
}
