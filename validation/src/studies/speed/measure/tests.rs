use super::*;

const TINY: Amount = Amount { repeats: 1, free_rods: 1000, large_run: 1000, seconds: 1e-5 };

#[test]
fn a_step_is_measured_of_both() {
    let step = step(50, 50.0, TINY).unwrap();
    assert!(step.core_ns > 0.0 && step.naive_ns.unwrap() > 0.0);
    assert_eq!(super::step(50, 5.0, TINY).unwrap().naive_ns, None);
}

#[test]
fn ratios_are_of_the_same_number_of_rods() {
    let step = |rods, core_ns, naive_ns| Step { rods, concentration_per_cm3: 50.0, core_ns, naive_ns };
    let steps = [step(100, 20.0, Some(300.0)), step(10_000, 40.0, Some(30_000.0)), step(1_000_000, 50.0, None)];
    let measured: Vec<_> = against_naive(&steps).iter().map(|check| check.measured).collect();
    assert_eq!(measured, [15.0, 750.0, 2.5]);
}
