//! What collisions do to ⟨pp⟩, as fibre-orientation codes have it: Folgar & Tucker's coefficient C_I, with ⟨pppp⟩ measured
//! and not closed.
//!
//! In plane Couette flow, per unit of strain,
//!   da/dγ = W·a − a·W + Λ(D·a + a·D − 2 ⟨pp p₁p₂⟩) + J,
//! which is exact for free rods with J = 0. Folgar & Tucker (1984) put J = 2 C_I (1 − 3a). J is what is left when the rest
//! is taken from runs; C_I is the best factor by least squares over all nine components.

mod diffusing;

pub use diffusing::{Diffusing, Diffusion, free};

use nalgebra::Matrix3;
use shearbed_oracle::spheroid;

/// Means over rods and over a window of time, of one replica or several.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Means {
    /// ⟨p_i p_j⟩.
    pub second: Matrix3<f64>,
    /// ⟨p_i p_j p₁ p₂⟩.
    pub sheared: Matrix3<f64>,
    /// The change of ⟨p_i p_j⟩ through the window over its strain.
    pub change: Matrix3<f64>,
}

impl Means {
    /// The means of several replicas, or of all but one.
    pub fn of(all: &[Self], without: Option<usize>) -> Self {
        let kept = all.iter().enumerate().filter(|(k, _)| Some(*k) != without);
        let count = (all.len() - usize::from(without.is_some())) as f64;
        let mut sum = Self::default();
        for (_, one) in kept {
            sum.second += one.second / count;
            sum.sheared += one.sheared / count;
            sum.change += one.change / count;
        }
        sum
    }

    /// J, per unit of strain, of rods with the shape factor Λ: what free rods would not have done.
    pub fn gain(&self, shape_factor: f64) -> Matrix3<f64> {
        let spin = Matrix3::new(0.0, -0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0);
        let strain = Matrix3::new(0.0, 0.5, 0.0, 0.5, 0.0, 0.0, 0.0, 0.0, 0.0);
        let a = &self.second;
        let free = spin * a - a * spin + (strain * a + a * strain - self.sheared * 2.0) * shape_factor;
        self.change - free
    }

    /// 2(1 − 3a): what rotary diffusion does for C_I = 1.
    pub fn diffusion(&self) -> Matrix3<f64> {
        (Matrix3::identity() - self.second * 3.0) * 2.0
    }

    /// C_I by least squares over the nine components.
    pub fn coefficient(&self, shape_factor: f64) -> f64 {
        let diffusion = self.diffusion();
        self.gain(shape_factor).dot(&diffusion) / diffusion.norm_squared()
    }

    /// How much of J a single C_I leaves: |J − 2 C_I (1 − 3a)|/|J|.
    pub fn misfit(&self, shape_factor: f64) -> f64 {
        let gain = self.gain(shape_factor);
        (gain - self.diffusion() * self.coefficient(shape_factor)).norm() / gain.norm()
    }

    /// The stress of the rods over μ_fiber G: σ₁₂, N₁ = σ₂₂ − σ₁₁ and N₂ = σ₁₁ − σ₃₃.
    pub fn stress(&self) -> [f64; 3] {
        let s = &self.sheared;
        [s[(0, 1)], s[(1, 1)] - s[(0, 0)], s[(0, 0)] - s[(2, 2)]]
    }

    /// σ₁₂/(μG n a³) of rods that are spheroids of finite r_e.
    pub fn spheroids(&self, aspect_ratio: f64) -> f64 {
        let in_plane = self.second[(0, 0)] + self.second[(1, 1)];
        spheroid::shear_stress(aspect_ratio, self.sheared[(0, 1)], in_plane)
    }
}
