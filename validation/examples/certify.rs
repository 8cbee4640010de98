//! Writes the certified answers of problems to standard output: a table is the same on every machine. `unequal-rods`
//! and `interpretations`, the means of suspensions with other interpretations of the paper, take minutes.
//!
//!     cargo run --release -p shearbed-validation --example certify -- folgar-tucker >
//!     validation/src/serve/problems/data/folgar-tucker.csv

use rayon::prelude::*;
use shearbed_validation::judge::statistics::Sample;
use shearbed_validation::oracle::naive::{Lines, Mistake, Naive, NaiveProblem, Who, mean_projections};
use shearbed_validation::oracle::reference::big::digits;
use shearbed_validation::oracle::reference::unequal::means_to_22_digits;
use shearbed_validation::serve::problems::{self, TABLES};

fn main() {
    let name = std::env::args().nth(1).unwrap_or_default();
    let contact = |name: &str| problems::certify_contacts().into_iter().find(|(of, _)| *of == name);
    let table = match TABLES.iter().find(|(of, _)| *of == name) {
        Some((_, certify)) => certify(),
        None if name == "unequal-rods" => Ok(unequal_rods()),
        None if name == "interpretations" => Ok(interpretations()),
        None => contact(&name).map(|(_, table)| table).ok_or_else(|| {
            "brownian, closed, contact-angles, contact-rule, folgar-tucker, formulas, interpretations or unequal-rods \
             is allowed"
                .into()
        }),
    };
    match table {
        Ok(table) => print!("{table}"),
        Err(why) => {
            eprintln!("{why}");
            std::process::exit(1);
        }
    }
}

fn unequal_rods() -> String {
    let problem = &problems::named("unequal-rods").expect("it is there").problem;
    let end_s = problem.times_s.last().copied().unwrap_or_default();
    let mut table = problem.columns.join(",") + "\n";
    for time_s in &problem.times_s {
        // The last time is 3 T: steps of T/(10·2π t) or less.
        let halvings = (20.0 * std::f64::consts::PI * 3.0 * time_s / end_s).log2().ceil() as i32;
        let rate = problem.gradient_per_s[1][0];
        let (r, sd_percent) = (problem.aspect_ratio, problem.aspect_ratio_sd_percent);
        let means = means_to_22_digits(rate, r, sd_percent, *time_s, halvings);
        let finer = means_to_22_digits(rate, r, sd_percent, *time_s, halvings + 1);
        let [means, finer] = [means, finer].map(|means| means.map(|x| digits(&x, 22)));
        assert_eq!(means, finer, "the rule has converged");
        table += &format!("{time_s:?},{}\n", means.join(","));
    }
    table
}

const REPLICAS: u64 = 600;

/// Means and standard errors of suspensions with other interpretations of the paper and with mistakes, by the naive
/// reference, at the times of the problem of the name in the second column.
fn interpretations() -> String {
    type Change = fn(&mut NaiveProblem);
    let changes: [(&str, Change); 6] = [
        ("contact lines cut at the rods' ends", |p| p.reading.lines = Lines::CutAtEnds),
        ("one draw for two rods that are each other's nearest", |p| p.reading.who = Who::PairDraws),
        ("|r| for the signed arm r", |p| p.mistake = Some(Mistake::ArmUnsigned)),
        ("the sum of both velocities for their mean", |p| p.mistake = Some(Mistake::SumInsteadOfMean)),
        ("V_c without ω × r", |p| p.mistake = Some(Mistake::SpinIgnored)),
        ("P_c for 1 − P_c", |p| p.mistake = Some(Mistake::ProbabilityComplement)),
    ];
    let mut table = "interpretation,problem,time_s,x1,x1_se,x2,x2_se,x3,x3_se\n".to_owned();
    for (name, change) in changes {
        for problem in ["lee-springer", "lee-springer-unequal"] {
            let asked = &problems::named(problem).expect("it is there").problem;
            let run = |replica| {
                let mut problem = NaiveProblem::paper(1983, replica);
                problem.aspect_ratio_sd_percent = asked.aspect_ratio_sd_percent;
                change(&mut problem);
                let step_s = problem.time_step_s();
                let (mut naive, mut now) = (Naive::new(problem), 0);
                let at = |time_s: &f64| {
                    let then = (time_s / step_s).round() as usize;
                    (now..then).for_each(|_| naive.step());
                    now = then;
                    mean_projections(&naive.orientations)
                };
                asked.times_s.iter().map(at).collect::<Vec<[f64; 3]>>()
            };
            let all: Vec<_> = (0..REPLICAS).into_par_iter().map(run).collect();
            for (k, time_s) in asked.times_s.iter().enumerate() {
                table += &format!("{name},{problem},{time_s:?}");
                for i in 0..3 {
                    let Sample { mean, se, .. } = Sample::of(all.iter().map(|of| of[k][i]));
                    table += &format!(",{mean:.6},{se:.1e}");
                }
                table += "\n";
            }
        }
    }
    table
}
