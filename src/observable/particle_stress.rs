//! The stress of dilute slender rods in plane Couette flow, over μ_fiber G: shear stress σ₁₂ and normal stress
//! differences N₁ = σ₂₂ − σ₁₁ (flow less gradient) and N₂ = σ₁₁ − σ₃₃ of σ_ij = μ_fiber ⟨p_i p_j p_k p_l⟩ D_kl, which
//! is μ_fiber G ⟨p_i p_j p₁p₂⟩ (Batchelor 1970; docs/src/theory/coefficients.md). μ_fiber ∝ n⟨a³⟩: rods count by their
//! cubed length.

use super::{Block, Observe, Sum};

pub(super) struct ParticleStress;

impl Observe for ParticleStress {
    fn name(&self) -> &'static str {
        "particle_stress"
    }

    fn label(&self) -> &'static str {
        "stress of the rods over μ_fiber G"
    }

    fn columns(&self) -> &[&'static str] {
        &["s12_per_mu_fiber_g", "n1_per_mu_fiber_g", "n2_per_mu_fiber_g"]
    }

    fn symbol(&self, column: usize) -> String {
        ["σ_12/(μ_fiber G)", "N_1/(μ_fiber G)", "N_2/(μ_fiber G)"][column].into()
    }

    fn range(&self, column: usize) -> [f64; 2] {
        // sin²2φ/4, sin 4φ/4, and p₁³p₂, largest at p₁² = ¾.
        let n2 = 3.0 * 3f64.sqrt() / 16.0;
        [[0.0, 0.25], [-0.25, 0.25], [-n2, n2]][column]
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        let ([p1, p2, p3], weight) = (&block.p, &block.weight);
        sums[0].add_each(block.len, |i| weight[i] * (p1[i] * p2[i]).powi(2));
        sums[1].add_each(block.len, |i| weight[i] * (p1[i] * p2[i] * (p2[i] * p2[i] - p1[i] * p1[i])));
        sums[2].add_each(block.len, |i| weight[i] * (p1[i] * p2[i] * (p1[i] * p1[i] - p3[i] * p3[i])));
    }

    fn needs_couette(&self) -> bool {
        true
    }

    fn weighs_rods(&self) -> bool {
        true
    }
}
