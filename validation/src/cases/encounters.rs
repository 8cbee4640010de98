//! The choice of colliding rods: P_c and its empirical frequency.

use super::*;
use crate::oracle::naive::{collision_probability, expected_candidates};
use shearbed::model::collision::reach;

pub fn cases() -> Vec<Case> {
    vec![
        Case::of(Judges::Core, "collision-probability")
            .claim(
                "The reach of a draw R, which runs compare distances with, is the s at which P_c of eq. 7 is R, for \
                 any α, m > 0. As m → ∞ at fixed α/m, P_c tends to e^(−ms/(aα)).",
            )
            .source("eqs 7, 10")
            .under_test(reach as Formula)
            .mistake("α missing in the denominator of P_c", |r, alpha, m| alpha * r.powf(-1.0 / m))
            .mistake("m = 3 whatever m is", |r, alpha, _| reach(r, alpha, 3.0))
            .mistake("s in rod radii", |r, alpha, m| 0.5 * reach(r, alpha, m))
            .mistake("the reach of 1 − R", |r, alpha, m| reach(1.0 - r, alpha, m))
            .check(limits),
        Case::of(Judges::Core, "collision-frequency")
            .claim("In a run, nearest pairs become candidates as often as the sum of their P_c says.")
            .source("eqs 7–9")
            .under_test((|_| {}) as Change)
            .mistake("α 10 % larger", |scene| lab::interaction(scene).alpha *= 1.1)
            .mistake("m = 2", |scene| lab::interaction(scene).m = 2.0)
            .check(frequency),
    ]
}

/// A function that returns s* for R, α and m, in rod lengths.
type Formula = fn(f64, f64, f64) -> f64;

fn limits(reach: &Formula, _: &Effort) -> Vec<Evidence> {
    let scenes = || pairs([1e-3f64, 0.1, 0.5, 1.0, 7.0], [0.1, 0.7, 1.0, 3.0, 4.5, 50.0]);
    let errors = pairs(scenes(), 1..20).map(|((alpha, m), k)| {
        let r = f64::from(k) / 20.0;
        let back = collision_probability(reach(r, alpha, m), 1.0, alpha, m);
        ((back - r) / r / (1.0 + m)).abs()
    });
    let bounded = scenes().filter(|(alpha, m)| reach(0.0, *alpha, *m) != f64::INFINITY).count();
    // s* = (α/m) ln(1/R) times 1 + ln(1/R)/(2m) + …: at m = 10⁴ and R ≥ 0.05, by 1.5·10⁻⁴.
    let many = 1e4;
    let exponential = pairs([1e-3, 0.5, 7.0], 1..20).map(|(scale, k): (f64, i32)| {
        let r = f64::from(k) / 20.0;
        (reach(r, scale * many, many) / (scale * -r.ln()) - 1.0).abs()
    });
    // By hand: α = 0.5 and m = 3 give (1/3)³ at s = a.
    let by_hand = reach(1.0 / 27.0, 0.5, 3.0) - 1.0;
    vec![
        Evidence::on("s* of R = 1, where P_c is certain", "rod lengths")
            .exact(worst(scenes().map(|(alpha, m)| reach(1.0, alpha, m).abs()))),
        Evidence::on("scenes in which R = 0 does not reach everyone", "scenes").exact(bounded as f64),
        Evidence::on("P_c(s*(R)) over R, less 1, over 1 + m", "–")
            .within(worst(errors), 8.0 * f64::EPSILON)
            .because("round-off of the two powers, m times that of their bases"),
        Evidence::on("s* of R = 1/27 for α = ½, m = 3, less a rod length", "rod lengths")
            .within(by_hand, 4.0 * f64::EPSILON)
            .because("roundings of 1/27, of its root, and of two operations on 3"),
        Evidence::on("s* over its limit (α/m) ln(1/R), less 1, at m = 10⁴", "–")
            .within(worst(exponential), 20f64.ln() / many)
            .because("the limit is reached as ln(1/R)/(2m), which is at most half of this"),
    ]
}

/// Candidates less the sum of P_c over all rods and steps is a martingale, so that its increments are
/// uncorrelated, and runs with different seeds are independent. Places do not depend on the draws, so that the ratio of
/// the two has the mean 1.
fn frequency(change: &Change, effort: &Effort) -> Vec<Evidence> {
    // Few rods, for which all pairs are searched, and many rods, which are sorted into cells. The last number is the
    // deviation of a replica's ratio: 0.172 from 14,000 replicas and 0.122 from 6,180 at seeds 9001 to 9010, plus a
    // sixth.
    let settings = [((0.5, 3.0, 50.0), 25, 100, 0.2), ((0.3, 1.7, 400.0), 300, 2, 0.14)];
    let evidence = settings.map(|((alpha, m, concentration), count, steps, sd)| {
        let mut scene = lab::crowded_scene(effort, count, concentration);
        scene.ensemble.seed = effort.seed(count as u64);
        let interaction = lab::interaction(&mut scene);
        (interaction.alpha, interaction.m) = (alpha, m);
        change(&mut scene);
        let design = Design { effect: 0.12, sd };
        let ratios: Vec<f64> = lab::replicas(effort.samples(design), |replica| {
            let mut suspension = lab::suspension(&scene, replica);
            let mut expected = 0.0;
            for _ in 0..steps {
                expected += expected_candidates(suspension.positions_in_lengths(), alpha, m);
                if suspension.step().is_err() {
                    return f64::NAN;
                }
            }
            suspension.counters().candidates as f64 / expected
        });
        let rods = format!("{count} rods, α = {alpha}, m = {m}, n = {concentration} per cm³");
        Evidence::on(format!("candidates over the sum of P_c, {rods}"), "–")
            .is(Sample::of(&ratios), 1.0, 0.0, design.effect)
            .because("unbiased; an α a tenth larger makes 13 % more at 300 rods, and 25 % at 25")
    });
    evidence.into()
}
