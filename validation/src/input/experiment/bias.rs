//! The bias δ and the scatter σ_M of a model against experiments, as the FDS Validation Guide defines them.

use serde::Serialize;

/// Relation of a model to the truth, M ≈ δ·truth, after the scatter of the experiments is subtracted.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct Bias {
    /// δ: above 1, the model's values are too large.
    pub delta: f64,
    /// The model's relative standard deviation about δ·truth.
    pub sigma_m: f64,
    /// The relative standard uncertainty of the experiments, which was subtracted.
    pub sigma_e: f64,
}

/// δ and σ_M of positive pairs (model, experiment), for experiments with the relative standard uncertainty `sigma_e`
/// (McGrattan & Toman, Metrologia 48 (2011) 173; FDS Validation Guide, "Calculating Model Uncertainty"):
///
/// σ_M² + σ_E² = 1/(n−1) Σ (ln(M_i/E_i) − mean)², δ = exp(mean + σ_M²/2 − σ_E²/2).
///
/// A model cannot be shown to be better than the experiments: σ_E is limited to σ_M. `None` for fewer than two pairs,
/// or if a value is not positive.
pub fn bias(pairs: &[(f64, f64)], sigma_e: f64) -> Option<Bias> {
    let positive = pairs.iter().all(|&(model, experiment)| model > 0.0 && experiment > 0.0);
    if pairs.len() < 2 || !positive {
        return None;
    }
    let n = pairs.len() as f64;
    let logs: Vec<f64> = pairs.iter().map(|(model, experiment)| (model / experiment).ln()).collect();
    let mean = logs.iter().sum::<f64>() / n;
    let variance = logs.iter().map(|log| (log - mean).powi(2)).sum::<f64>() / (n - 1.0);
    let experiment = (sigma_e * sigma_e).min(variance / 2.0);
    let model = variance - experiment;
    Some(Bias {
        delta: (mean + model / 2.0 - experiment / 2.0).exp(),
        sigma_m: model.sqrt(),
        sigma_e: experiment.sqrt(),
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn two_pairs_by_hand() {
        // ln 1.1 = 0.0953101798, ln 1.2 = 0.1823215568: mean 0.1388158683, variance 0.0870113770²/2 = 0.0037854898.
        // σ_E² = 0.0004, so σ_M² = 0.0033854898 and δ = exp(0.1388158683 + 0.0016927449 − 0.0002).
        let found = bias(&[(1.1, 1.0), (1.2, 1.0)], 0.02).unwrap();
        assert_relative_eq!(found.sigma_m, 0.058_184_962, max_relative = 1e-7);
        assert_relative_eq!(found.delta, (0.140_308_613_2_f64).exp(), max_relative = 1e-9);
        assert_relative_eq!(found.sigma_e, 0.02, max_relative = 1e-14);
    }

    #[test]
    fn the_experiments_take_half_of_the_variance_at_most() {
        let found = bias(&[(1.1, 1.0), (1.2, 1.0)], 0.5).unwrap();
        assert_relative_eq!(found.sigma_m, found.sigma_e, max_relative = 1e-14);
        assert_relative_eq!(found.delta, (1.1_f64 * 1.2).sqrt(), max_relative = 1e-12);
    }

    #[test]
    fn too_few_or_not_positive() {
        assert_eq!(bias(&[(1.0, 1.0)], 0.1), None);
        assert_eq!(bias(&[(1.0, 1.0), (0.0, 1.0)], 0.1), None);
        assert_eq!(bias(&[(1.0, 1.0), (1.0, -1.0)], 0.1), None);
    }
}
