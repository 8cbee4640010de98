//! The stress of dilute slender rods in plane Couette flow, over μ_fiber G: shear stress σ₁₂ and normal stress
//! differences N₁ = σ₂₂ − σ₁₁ (flow less gradient) and N₂ = σ₁₁ − σ₃₃ of σ_ij = μ_fiber ⟨p_i p_j p_k p_l⟩ D_kl, which
//! is μ_fiber G ⟨p_i p_j p₁p₂⟩ (Batchelor 1970; docs/src/theory/coefficients.md). μ_fiber ∝ n⟨a³⟩: rods count by their
//! cubed length.

use super::Mean;

pub(super) const MEAN: Mean = Mean {
    name: "particle_stress",
    label: "stress of the rods over μ_fiber G",
    columns: &["s12_per_mu_fiber_g", "n1_per_mu_fiber_g", "n2_per_mu_fiber_g"],
    symbols: &["σ_12/(μ_fiber G)", "N_1/(μ_fiber G)", "N_2/(μ_fiber G)"],
    range: |column| {
        // sin²2φ/4, sin 4φ/4, and p₁³p₂, largest at p₁² = ¾.
        let n2 = 3.0 * 3f64.sqrt() / 16.0;
        [[0.0, 0.25], [-0.25, 0.25], [-n2, n2]][column]
    },
    add: |block, sums| {
        let ([p1, p2, p3], weight) = (&block.p, &block.weight);
        sums[0].add_each(block.len, |i| weight[i] * (p1[i] * p2[i]).powi(2));
        sums[1].add_each(block.len, |i| weight[i] * (p1[i] * p2[i] * (p2[i] * p2[i] - p1[i] * p1[i])));
        sums[2].add_each(block.len, |i| weight[i] * (p1[i] * p2[i] * (p1[i] * p1[i] - p3[i] * p3[i])));
    },
    needs_couette: true,
    weighs_rods: true,
    ..Mean::ANY
};
