use super::*;
use std::f64::consts::PI;

const RATIO: f64 = 11.6;

fn direction(phi: f64, theta: f64) -> Vector3<f64> {
    Vector3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

#[test]
fn a_rod_that_nothing_kicks_has_made_no_jump() {
    let (from, carry) = (direction(0.3, 1.1), free(shape_factor(RATIO), 1.0));
    let to = (carry * from).normalize();
    // Opposite directions are the same rod.
    for to in [to, -to] {
        let [angle, change, orbit, phase] = seen(RATIO, &from, &(carry * from), &to);
        assert!(angle < 1e-15 && change < 1e-15, "{angle} {change}");
        // C of eq. 13, and A.4: tan φ = r_e tan(phase) with the phase growing by γ/(r_e + 1/r_e).
        let c =
            1.1_f64.tan() * (RATIO.powi(2) * 0.3_f64.cos().powi(2) + 0.3_f64.sin().powi(2)).sqrt() / RATIO;
        assert!((orbit - c / (1.0 + c)).abs() < 1e-14);
        let after = (0.3_f64.tan() / RATIO).atan() + 1.0 / (RATIO + 1.0 / RATIO);
        assert!((phase - after / FRAC_PI_2).abs() < 1e-14);
    }
}

#[test]
fn jumps_are_angles_between_lines() {
    let from = direction(0.3, 1.1);
    for kick in [0.01, 1.0, 3.0, PI - 0.02] {
        let axis = from.cross(&Vector3::z()).normalize();
        let to = from * kick.cos() + axis.cross(&from) * kick.sin();
        let [angle, ..] = seen(RATIO, &from, &from, &to);
        assert!((angle - kick.min(PI - kick)).abs() < 1e-14, "{kick}: {angle}");
    }
}

#[test]
fn shares_are_of_values_above_the_edges() {
    let mut values = [0.5, 0.1, f64::NAN, 0.2];
    assert_eq!(shares(&mut values, &[0.0, 0.1, 0.2, 9.0]), [1.0, 0.75, 0.5, 0.25]);
}

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
