//! The claims of `docs/src/verification/integrators.md` about the cheapest split of a run.

use super::work_precision::first;
use super::*;
use crate::judge::statistics::covariance;
use crate::studies::suspensions::coupled::interacting;
use crate::studies::suspensions::split::{Constants, Scope, Split};

type Respell = fn(&mut Split);

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Program, "cheapest-split")
            .claim("Steps and replicas by the rule for an error of 0.02 give the bias and the scatter that it says.")
            .source("eq. 4")
            .under_test((|_| {}) as Respell)
            .mistake("a quarter of the replicas, or less", |split| split.replicas /= 4)
            .mistake("two steps a period", |split| split.steps_per_period = 2)
            .check(realised),
    ]
}

/// The constants of 25 rods from a small study of the steps, and X̄₁ at its finest step.
struct Known {
    constants: Constants,
    reference: Estimate,
}

const RODS: usize = 25;

/// Steps of the study, coarse and fine, and replicas of each.
const STUDY: ([u64; 2], u64) = ([100, 400], 400);

/// Estimates the bias from two numbers of steps with the same random numbers, and the variance.
fn study(scene: &Scene) -> Known {
    let (steps, replicas) = STUDY;
    let [coarse, fine] = steps.map(|steps| first(interacting(scene, steps, 1.0, 4, replicas), 3));
    let differences: Vec<_> = (coarse.iter().zip(&fine)).map(|(coarse, fine)| coarse - fine).collect();
    let Estimate { value: difference, se } = Estimate::mean_of(&differences);
    let [coarse_step, fine_step] = steps.map(|steps| 1.0 / steps as f64);
    Known {
        constants: Constants {
            steps_bias: (difference.abs() + 2.0 * se) / (coarse_step - fine_step),
            steps_bias_seen: difference.abs() > 2.0 * se,
            fewest_steps: steps[0],
            // The number of rods is the scene's own.
            rods_bias: 0.0,
            variance_per_rod: covariance(&coarse, &coarse) * RODS as f64,
        },
        reference: Estimate::mean_of(&fine),
    }
}

fn realised(respell: &Respell, effort: &Effort) -> Vec<Evidence> {
    static KNOWN: Shared<(), Known> = Shared::new();
    let mut scene = lab::interacting_scene(effort);
    scene.particles.count = RODS;
    let known = KNOWN.get(effort, (), || study(&scene));
    let constants = known.constants;
    let said = constants.cheapest(Scope::OwnRods(RODS), 0.02);
    let mut run = said;
    respell(&mut run);
    scene.ensemble.seed = effort.seed(1);
    // ∛4 of the mistake scatters by ∛4 of what 1 does, and both errors' quantiles leave 0.049 for that; 200 have 0.041.
    let repeats = effort.pick(1, 4) * 200;
    let Ok(found) = run.realise(&scene, repeats, known.reference) else {
        return vec![Evidence::on("runs that stopped", "runs").exact(1.0)];
    };
    // The cube root of a ratio of variances is normal to a part in 10³ (Wilson & Hilferty 1931), the ratio itself is
    // not.
    let ratio = (found.scatter.value / said.scatter).powi(2);
    let [of_repeats, of_study] = [repeats, STUDY.1].map(|count| 2.0 / (9.0 * (count as f64 - 1.0)));
    vec![
        Evidence::on("bias of the steps and replicas that the rule says for an error of 0.02, against 400 steps", "–")
            .is(
                Sample { mean: found.bias.value, se: found.bias.se, samples: repeats },
                0.0,
                said.bias + constants.bias(Scope::OwnRods(RODS), 400.0, RODS as f64),
                0.05,
            )
            .because("the bias that the rule allows for, and that of the reference; two steps are off by more"),
        Evidence::on("cube root of the variance of repeats over the one that the rule says", "–")
            .is(
                Sample { mean: ratio.cbrt(), se: (of_repeats + of_study).sqrt(), samples: repeats },
                1.0 - of_repeats + of_study,
                0.0,
                0.5,
            )
            .because("both variances are estimates; a quarter of the replicas or less bring ∛4, 0.59 more, at least"),
    ]
}
