use super::*;

/// Independent replicas with a common mean.
fn made(mean: f64, seed: u64) -> Vec<Shares> {
    let mut rng = Pcg64Dxsm::seed_from_u64(seed);
    let one = || {
        let mut off: Vec<f64> = (0..100).map(|k| 0.01 * f64::from(k)).collect();
        off.shuffle(&mut rng);
        Quantity::ALL.map(|quantity| vec![mean + off[quantity as usize]; quantity.edges().len()])
    };
    std::iter::repeat_with(one).take(12).collect()
}

#[test]
fn only_samples_that_differ_are_told_apart() {
    let p = |mean: f64, seed: u64| apart(&made(0.0, seed), &made(mean, 1000 + seed), Quantity::Orbit, seed).p;
    let trials = 200;
    let low = (0..trials).filter(|seed| p(0.0, *seed) <= 0.1).count() as f64;
    // A p-value is at most 0.1 in a tenth of the trials, to five standard errors of a share of 200: 0.106.
    assert!((low / trials as f64 - 0.1).abs() < 0.106, "{low}");
    assert!((0..10).all(|seed| p(0.8, seed) <= 0.002));
}
