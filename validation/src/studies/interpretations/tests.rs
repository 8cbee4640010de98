use super::*;

#[test]
fn the_rate_of_an_exponential_is_exact() {
    // Maxima at 0.4; each minimum lies below them by an amplitude A ∝ exp(−0.3 t/T).
    let mut x1 = [0.4; QUARTERS + 2];
    for k in [1, 3, 5, 7] {
        x1[k] -= 0.2 * (-0.3 * k as f64 / 4.0).exp();
    }
    assert!((damping_rate(&x1) - 0.3).abs() < 1e-14);
    // A linear drift, such as that of a changing plateau, does not count as damping.
    let mut drifting = x1;
    (0..=QUARTERS).for_each(|k| drifting[k] += 0.01 * k as f64);
    assert!((damping_rate(&drifting) - 0.3).abs() < 1e-13);
}

#[test]
fn the_jackknife_of_a_mean_is_its_standard_error() {
    // 1, 2, 6: mean 3, variance 7, standard error √(7/3)
    let traces = [1.0, 2.0, 6.0].map(|x| [x; QUARTERS + 2]);
    let default = [1.0, 1.0, 1.0].map(|x| [x; QUARTERS + 2]);
    for (estimate, mean) in [(value(|x| x[4], &traces), 3.0), (change(|x| x[4], &default, &traces), 2.0)] {
        assert!((estimate.value - mean).abs() < 1e-14);
        assert!((estimate.se - (7.0f64 / 3.0).sqrt()).abs() < 1e-14);
    }
    let same = change(damping_rate, &default, &default);
    assert!(same.value.is_nan(), "no oscillation has no rate");
}

#[test]
fn the_problem_is_that_of_fig_7() {
    let scene = crate::input::scenes::find("fig7-n50").expect("built in").scene().expect("valid");
    let (ours, rods) = (NaiveProblem::paper(SEED, 0), &scene.particles);
    let theirs = scene.interaction.as_ref().expect("interacting");
    assert_eq!(
        [ours.length_mm, ours.aspect_ratio, ours.aspect_ratio_sd_percent, ours.alpha, ours.m, ours.min_contact_arm],
        [
            rods.length_mm,
            rods.aspect_ratio,
            rods.aspect_ratio_sd_percent,
            theirs.alpha,
            theirs.m,
            theirs.min_contact_arm
        ]
    );
    assert_eq!(scene.flow.shear_rate_per_s(), Some(ours.shear_rate_per_s));
    assert_eq!(theirs.concentration_per_cm3, Some(ours.concentration_per_cm3));
    assert_eq!((rods.count, scene.steps_per_unit() as usize), (ours.count, ours.steps_per_period));
}
