//! What the paper leaves open: which readings change X̄₁ of Fig. 7's rods, and which do not.

use super::lab::Sample;
use crate::accept::Rule;
use crate::case::{About, Case, Effort, Evidence, Judges};
use crate::oracle::naive::{Lines, Naive, Problem, Update, Who, mean_projections};
use crate::readings::{Change, paper};
use rayon::prelude::*;

/// 1 % of the amplitude ½ of free rods, which the width of a drawn line hides in Fig. 7.
const LINE: f64 = 0.005;

/// What an alternative reading should do to X̄₁ at t/T = 1.
#[derive(Clone, Copy)]
struct Alternative {
    change: Change,
    /// +1 where X̄₁ should be larger, as rods are damped less.
    sign: f64,
    /// By how much at least.
    bound: f64,
    /// In the quick gate; ten times as many in a full run.
    replicas: u64,
}

pub fn cases() -> Vec<Case> {
    let who_draws = Alternative {
        change: |p| p.reading.who = Who::PairDraws,
        sign: 1.0,
        bound: LINE,
        replicas: 40,
    };
    let index_order: Change = |p| p.reading.who = Who::IndexOrder;
    let angles = Alternative {
        change: |p| p.update = Update::Angles,
        sign: -1.0,
        bound: 0.0,
        replicas: 100,
    };
    let shortest_arm = Alternative {
        change: |p| p.min_contact_arm = 0.5 / p.aspect_ratio,
        sign: 1.0,
        bound: LINE,
        replicas: 90,
    };
    let cut_lines = Alternative {
        change: |p| p.reading.lines = Lines::CutAtEnds,
        sign: 1.0,
        bound: LINE,
        replicas: 40,
    };
    let instead = |alternative, change| Alternative {
        change,
        ..alternative
    };
    vec![
        Case::new(
            about(
                "reading-who-draws",
                "With one draw per mutual pair in place of two, rods are damped less: this reading matters.",
                "eqs 8, 9; whose R decides is left open",
                &["8", "9"],
            ),
            who_draws,
            vec![("index order instead", instead(who_draws, index_order))],
            matters,
        ),
        Case::new(
            about(
                "reading-order",
                "Taking candidates in index order in place of closest first changes next to nothing.",
                "eqs 8, 9; the order is left open",
                &["8", "9"],
            ),
            index_order,
            vec![("one draw per mutual pair instead", who_draws.change)],
            does_not_matter,
        ),
        Case::new(
            about(
                "reading-update",
                "A.14 to the letter damps a little more than a turn about p × ṗ′: this reading matters.",
                "A.13, A.14; the pole of the angles",
                &["A.13", "A.14"],
            ),
            angles,
            vec![(
                "Jeffery's exact step plus the kick instead",
                instead(angles, |p| p.update = Update::ExactStepAndKick),
            )],
            matters,
        ),
        Case::new(
            about(
                "reading-shortest-arm",
                "Without contacts at arms below the rod's radius, rods are damped less: this reading matters.",
                "A.13; a kick ∝ 1/r has no bound",
                &["A.13"],
            ),
            shortest_arm,
            vec![(
                "arms below a thousandth of the length instead",
                instead(shortest_arm, |p| p.min_contact_arm = 1e-3),
            )],
            matters,
        ),
        Case::new(
            about(
                "reading-contact-lines",
                "With contact lines cut at the rods' ends, rods are damped less: this reading matters.",
                "Fig. 2, assumption ii",
                &["A.7"],
            ),
            cut_lines,
            vec![("the same reading twice", instead(cut_lines, |_| ()))],
            matters,
        ),
    ]
}

fn about(
    name: &'static str,
    claim: &'static str,
    source: &'static str,
    equations: &'static [&'static str],
) -> About {
    About {
        name,
        judges: Judges::Interpretation,
        claim,
        source,
        equations,
    }
}

fn matters(alternative: &Alternative, effort: &Effort) -> Vec<Evidence> {
    let replicas = effort.pick(1, 10) * alternative.replicas;
    let sample = Sample::of(&changes(alternative.change, replicas));
    vec![Evidence::new(
        "how much X̄₁ at t/T = 1 changes, in the direction expected",
        Rule::Above {
            mean: alternative.sign * sample.mean,
            se: sample.se,
            samples: sample.samples,
            bound: alternative.bound,
            effect: 0.004,
            because: "1 % of the amplitude ½ of free rods where that can be shown, else any change that is \
                      beyond chance; a standard error of 0.004 shows the larger ones",
        },
    )]
}

fn does_not_matter(change: &Change, effort: &Effort) -> Vec<Evidence> {
    let sample = Sample::of(&changes(*change, effort.pick(50, 500)));
    vec![Evidence::new(
        "change of X̄₁ at t/T = 1",
        sample.is(
            0.0,
            0.2 * LINE,
            0.2 * LINE,
            "a thousandth: a fifth of the width of a line in Fig. 7",
        ),
    )]
}

/// The changes of X̄₁ at t/T = 1 from the project's reading, replica by replica with the same random numbers.
fn changes(change: Change, replicas: u64) -> Vec<f64> {
    let x1 = |mut problem: Problem, change: Change| {
        change(&mut problem);
        let steps = problem.steps_per_period;
        let mut naive = Naive::new(problem);
        (0..steps).for_each(|_| naive.step());
        mean_projections(&naive.orientations)[0]
    };
    let difference = |replica| x1(paper(replica), change) - x1(paper(replica), |_| ());
    (0..replicas).into_par_iter().map(difference).collect()
}
