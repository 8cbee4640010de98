//! What the paper leaves open: interpretations that change X̄₁ of Fig. 7's rods, and some that do not.

use super::*;
use crate::oracle::naive::{Lines, Naive, NaiveProblem, Who, mean_projections};
use crate::studies::interpretations::Change;
use shearbed::scene::Interaction;

/// The width of a drawn line, in rod lengths: 1 % of an axis from 0 to ½, the amplitude of free rods.
pub(super) const LINE: f64 = 0.005;

const CONCENTRATION_PER_CM3: f64 = 200.0;

#[derive(Clone, Copy)]
struct Alternative {
    model: Model,
    /// +1 if X̄₁ should be larger because rods are damped less, −1 if it should be smaller.
    sign: f64,
    bound: f64,
    /// The effect beyond the bound, three standard errors below the pilot's mean, and its scatter.
    design: Design,
}

/// The program that runs an alternative and the default with the same random numbers: Fig. 7's rods at 200 per cm³, up
/// to the first maximum of X̄₁, t/T = ½, where the least work distinguishes the interpretations.
#[derive(Clone, Copy)]
enum Model {
    /// The core, if it has the option: 100 rods.
    Core(fn(&mut Interaction)),
    /// The naive reference: 25 rods, as its work is proportional to their square.
    Naive(Change),
}

pub fn cases() -> Vec<Case> {
    let pair_draws = Model::Naive(|p| p.reading.who = Who::PairDraws);
    let index_order = Model::Naive(|p| p.reading.who = Who::IndexOrder);
    let hardly_any_arm = Model::Core(|i| i.min_contact_arm = 1e-3);
    // Pilots at seed 99, means and deviations: 1,500 replicas by the reference, 800 by the core.
    let who_draws = Alternative {
        model: pair_draws,
        sign: 1.0,
        bound: LINE,
        // 0.0267 ± 0.0360
        design: Design::new(0.0189, 0.0395),
    };
    let angles = Alternative {
        model: Model::Core(|i| i.update = Update::Angles),
        sign: -1.0,
        bound: 0.0,
        // 0.0084 ± 0.0114
        design: Design::new(0.0072, 0.0125),
    };
    let shortest_arm = Alternative {
        model: Model::Core(|i| i.min_contact_arm = 0.5 / 11.6),
        sign: 1.0,
        bound: LINE,
        // 0.0162 ± 0.0149
        design: Design::new(0.0096, 0.0165),
    };
    let cut_lines = Alternative {
        model: Model::Naive(|p| p.reading.lines = Lines::CutAtEnds),
        sign: 1.0,
        bound: LINE,
        // 0.0377 ± 0.0389
        design: Design::new(0.0297, 0.043),
    };
    let instead = |alternative, model| Alternative { model, ..alternative };
    vec![
        Case::of(Judges::Interpretation, "interpretation-who-draws")
            .claim("With one draw per mutual pair in place of two, rods are damped less: this interpretation matters.")
            .source("eqs 8, 9; whose R decides is left open")
            .under_test(who_draws)
            .mistake("index order instead", instead(who_draws, index_order))
            .check(matters),
        Case::of(Judges::Interpretation, "interpretation-order")
            .claim("Taking candidates in index order in place of closest first changes next to nothing.")
            .source("eqs 8, 9; the order is left open")
            .under_test(index_order)
            .mistake("one draw per mutual pair instead", pair_draws)
            .check(does_not_matter),
        Case::of(Judges::Interpretation, "interpretation-update")
            .claim("Exactly A.14 damps a little more than Jeffery's step and the kick: this interpretation matters.")
            .source("A.13, A.14; the pole of the angles")
            .under_test(angles)
            .mistake("no contact at arms below a thousandth of the length instead", instead(angles, hardly_any_arm))
            .check(matters),
        Case::of(Judges::Interpretation, "interpretation-shortest-arm")
            .claim(
                "Without contacts at arms below the rod's radius, rods are damped less: this interpretation matters.",
            )
            .source("A.13; a kick ∝ 1/r has no bound")
            .under_test(shortest_arm)
            .mistake("arms below a thousandth of the length instead", instead(shortest_arm, hardly_any_arm))
            .check(matters),
        Case::of(Judges::Interpretation, "interpretation-contact-lines")
            .claim("With contact lines cut at the rods' ends, rods are damped less: this interpretation matters.")
            .source("A.7; Fig. 2, assumption ii")
            .under_test(cut_lines)
            .mistake("index order instead", instead(cut_lines, index_order))
            .check(matters),
    ]
}

fn matters(alternative: &Alternative, effort: &Effort) -> Evidence {
    let changes = changes(alternative.model, effort, effort.samples(alternative.design));
    let changes = changes.iter().map(|change| alternative.sign * change);
    Evidence::on("how much X̄₁ at t/T = ½ changes, in the direction expected", "rod lengths")
        .exceeds(Sample::of(changes), alternative.bound, alternative.design.effect)
        .because(
            "more than the width of a drawn line, 1 % of the amplitude ½ of free rods; for \"a little\" any change \
             that is beyond chance",
        )
}

fn does_not_matter(model: &Model, effort: &Effort) -> Evidence {
    // The control's pilot is that of `interpretation-who-draws`; index order itself changed −0.0004 ± 0.0105.
    let design = Design::new(0.0214, 0.0395);
    Evidence::on("change of X̄₁ at t/T = ½", "rod lengths")
        .is(Sample::of(changes(*model, effort, effort.samples(design))), 0.0, 0.5 * LINE, design.effect)
        .because("half the width of a drawn line; the control changes 0.027")
}

/// The changes of X̄₁ at the end from the project's interpretation, for each replica with the same random numbers.
fn changes(model: Model, effort: &Effort, replicas: u64) -> Vec<f64> {
    let (changed, default) = match model {
        Model::Core(change) => (by_core(change, effort, replicas), by_core(|_| (), effort, replicas)),
        Model::Naive(change) => (by_reference(change, effort, replicas), by_reference(|_| (), effort, replicas)),
    };
    changed.iter().zip(&default).map(|(a, b)| a - b).collect()
}

fn by_core(change: fn(&mut Interaction), effort: &Effort, replicas: u64) -> Vec<f64> {
    let mut scene = lab::crowded_scene(effort, 100, CONCENTRATION_PER_CM3);
    scene.time = Time { outputs_per_unit: Some(2), ..Time::periods(0.5) };
    change(lab::interaction(&mut scene));
    per_replica(&scene, replicas, |mean| mean(Channel::X[0], 1))
}

fn by_reference(change: Change, effort: &Effort, replicas: u64) -> Vec<f64> {
    lab::replicas(replicas, |replica| {
        let mut problem = NaiveProblem {
            count: 25,
            concentration_per_cm3: CONCENTRATION_PER_CM3,
            seed: effort.seed(0),
            ..NaiveProblem::paper(1, replica)
        };
        change(&mut problem);
        let steps = problem.steps_per_period / 2;
        let mut naive = Naive::new(problem);
        (0..steps).for_each(|_| naive.step());
        mean_projections(&naive.orientations)[0]
    })
}
