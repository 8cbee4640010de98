//! The stress of dilute rods in plane Couette flow, in Pa: shear stress σ₁₂ and normal stress differences N₁ = σ₂₂ −
//! σ₁₁ (flow less gradient) and N₂ = σ₁₁ − σ₃₃, with the coefficients of the rods' own shape
//! ([`crate::model::stress`]).

use super::{BLOCK, Mean};

pub(super) const MEAN: Mean = Mean {
    name: "stress",
    label: "stress of the rods (Pa)",
    columns: &["s12_pa", "n1_pa", "n2_pa"],
    symbols: &["σ_12 (Pa)", "N_1 (Pa)", "N_2 (Pa)"],
    add: |block, sums| {
        let ([p1, p2, p3], r_e) = (&block.p, &block.aspect_ratio);
        let mut k = [[0.0; 3]; BLOCK];
        let mut last = (f64::NAN, [0.0; 3]);
        for (i, k) in k[..block.len].iter_mut().enumerate() {
            if last.0 != r_e[i] {
                last = (r_e[i], block.body.coefficients(r_e[i]));
            }
            *k = last.1.map(|k| block.weight[i] * k);
        }
        let squares = |i: usize| [p1[i] * p1[i], p2[i] * p2[i], p3[i] * p3[i]];
        // ⟨pppp⟩:D/G has the components p_i p_j p₁p₂, and ⟨pp⟩·D + D·⟨pp⟩ over G has p₁p₂ at 11 and 22, (p₁² + p₂²)/2
        // at 12.
        sums[0].add_each(block.len, |i| {
            let (s, [a, b, c]) = (squares(i), k[i]);
            a * s[0] * s[1] + 0.5 * (b * (s[0] + s[1]) + c)
        });
        sums[1].add_each(block.len, |i| {
            let s = squares(i);
            k[i][0] * p1[i] * p2[i] * (s[1] - s[0])
        });
        sums[2].add_each(block.len, |i| {
            let s = squares(i);
            p1[i] * p2[i] * (k[i][0] * (s[0] - s[2]) + k[i][1])
        });
    },
    needs_couette: true,
    weighs_rods: true,
    needs_viscosity: true,
    ..Mean::ANY
};
