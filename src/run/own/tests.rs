//! Compares own observables with those of the core.

use super::*;
use crate::observable::Block;
use crate::scene::{Interaction, Scene};
use approx::assert_relative_eq;

/// The observable |p_1| to |p_3|, and r_e.
struct Own;

impl Observe for Own {
    fn name(&self) -> &'static str {
        "own"
    }

    fn label(&self) -> &'static str {
        "of one's own"
    }

    fn columns(&self) -> &[&'static str] {
        &["x1", "x2", "x3", "r_e"]
    }

    fn add(&self, block: &Block, sums: &mut [Sum]) {
        for (sum, p) in sums.iter_mut().zip(&block.p) {
            sum.add_each(block.len, |i| p[i].abs());
        }
        sums[3].add_each(block.len, |i| block.aspect_ratio[i]);
    }
}

#[test]
fn what_the_core_observes_too_is_the_same() {
    for interaction in [None, Some(Interaction::default())] {
        for replicas in [1, 3] {
            let mut scene = Scene { interaction: interaction.clone(), ..Scene::default() };
            // More than one block, and not a whole number of blocks.
            scene.particles.count = 300;
            scene.particles.aspect_ratio_sd_percent = 3.6;
            scene.time.outputs_per_unit = Some(10);
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
                    // The variance loses digits if the mean is large beside it.
                    assert_relative_eq!(column.se[k], expected.se[k], max_relative = 1e-9);
                }
            }
            // The mean of 300 rods with a deviation of 3.6 % is within 5 standard errors of 11.6, and it does not
            // change.
            let r_e = &own[3].mean;
            assert!((r_e[0] / 11.6 - 1.0).abs() < 5.0 * 0.036 / 300f64.sqrt(), "{r_e:?}");
            assert!(r_e.iter().all(|r| r == &r_e[0]));
        }
    }
}
