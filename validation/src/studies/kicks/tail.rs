//! The exponent of the tail of the kicks.

use super::*;

/// An exponent of a tail P(κ > x) ∝ x^−α.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent {
    /// The threshold; only values above it are used.
    pub threshold: f64,
    pub count: u64,
    pub alpha: f64,
    /// The standard error α/√count.
    pub se: f64,
}

/// Hill's estimate from the values above a fixed threshold u: 1/α is the mean of ln(x/u).
pub fn hill(values: impl IntoIterator<Item = f64>, threshold: f64) -> Exponent {
    let logarithms: Vec<_> = (values.into_iter())
        .filter(|value| is_above(*value, threshold))
        .map(|value| (value / threshold).ln())
        .collect();
    let count = logarithms.len() as u64;
    let alpha = count as f64 / logarithms.iter().sum::<f64>();
    Exponent { threshold, count, alpha, se: alpha / (count as f64).sqrt() }
}

/// Kicks over GΔt in the first step of many replicas, where the arms of all pairs are fresh.
pub fn fresh(scene: &Scene, replicas: u64, angles: Angles) -> Vec<f64> {
    let strain = super::step_strain(scene);
    let kicks = |replica| of_one_step(&mut lab::suspension(scene, replica), angles);
    (0..replicas)
        .into_par_iter()
        .flat_map_iter(|replica| kicks(replica).into_iter().map(|kick| kick / strain))
        .collect()
}

/// Kicks in rad over whole runs of the scene's own duration.
pub fn in_runs(scene: &Scene, replicas: u64, angles: Angles) -> Vec<f64> {
    let steps = (scene.time.duration * scene.steps_per_unit() as f64).round() as u64;
    let run = |replica| {
        let mut suspension = lab::suspension(scene, replica);
        (0..steps)
            .flat_map(|_| of_one_step(&mut suspension, angles))
            .filter(|kick| is_above(*kick, 1e-3))
            .collect::<Vec<_>>()
    };
    (0..replicas).into_par_iter().flat_map_iter(run).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_exponent_of_exact_quantiles() {
        for alpha in [0.5, 1.0, 2.0] {
            // x = (1 − u)^(−1/α) has the tail x^−α.
            let values = (0..100_000).map(|k| ((f64::from(k) + 0.5) / 1e5).powf(-1.0 / alpha));
            let exponent = hill(values, 1.0);
            assert_eq!(exponent.count, 100_000);
            assert!((exponent.alpha / alpha - 1.0).abs() < 1e-4, "{exponent:?}");
            assert!((exponent.se - exponent.alpha / 1e5f64.sqrt()).abs() < 1e-15);
        }
        assert!(hill([f64::NAN], 1.0).alpha.is_nan(), "a run that stopped is no tail");
    }
}
