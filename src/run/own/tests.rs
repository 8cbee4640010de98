//! Against what the core observes itself.

use super::*;
use crate::scene::{Interaction, Scene};
use approx::assert_relative_eq;

/// |p_1| to |p_3|, and r_e.
struct Own;

impl OwnObservable for Own {
    fn columns(&self) -> Vec<String> {
        ["x1", "x2", "x3", "r_e"].map(str::to_owned).to_vec()
    }

    fn values(&self, p: [f64; 3], aspect_ratio: f64, values: &mut [f64]) {
        values.copy_from_slice(&[p[0].abs(), p[1].abs(), p[2].abs(), aspect_ratio]);
    }
}

#[test]
fn what_the_core_observes_too_is_the_same() {
    for interaction in [None, Some(Interaction::default())] {
        for replicas in [1, 3] {
            let mut scene = Scene { interaction: interaction.clone(), ..Scene::default() };
            // More than a block, and not a whole number of them.
            scene.particles.count = 300;
            scene.particles.aspect_ratio_sd_percent = 3.6;
            scene.time.outputs_per_period = Some(10);
            scene.ensemble.replicas = replicas;
            let plan = Plan::new(&scene).unwrap();
            let results = crate::run::ensemble::run(&plan).unwrap();
            let own = observe(&plan, &Own).unwrap();
            assert_eq!(own.len(), 4);
            for column in &own[..3] {
                let expected = results.column(&column.name).unwrap();
                assert_eq!(column.mean.len(), plan.outputs());
                for k in 0..plan.outputs() {
                    assert_relative_eq!(column.mean[k], expected.mean[k], max_relative = 1e-13);
                    // A variance loses digits where the mean is large beside it.
                    assert_relative_eq!(column.se[k], expected.se[k], max_relative = 1e-9);
                }
            }
            // 300 rods with a deviation of 3.6 % have a mean within 5 standard errors of 11.6, and it does not change.
            let r_e = &own[3].mean;
            assert!((r_e[0] / 11.6 - 1.0).abs() < 5.0 * 0.036 / 300f64.sqrt(), "{r_e:?}");
            assert!(r_e.iter().all(|r| r == &r_e[0]));
        }
    }
}

/// No number for any rod.
struct Broken;

impl OwnObservable for Broken {
    fn columns(&self) -> Vec<String> {
        vec!["inverse".to_owned()]
    }

    fn values(&self, _: [f64; 3], _: f64, values: &mut [f64]) {
        values[0] = f64::INFINITY;
    }
}

#[test]
fn a_value_that_is_no_number_is_told_with_its_rod() {
    let refused = observe(&Plan::new(&Scene::default()).unwrap(), &Broken).unwrap_err();
    let text = refused.to_string();
    assert!(
        text.starts_with("rod 0, output 0 (t_over_T = 0) of replica 0")
            && text.contains("its inverse came out as inf"),
        "{text}"
    );
}
