//! Effects of known mistakes on the means |p_i| of rods that were isotropic at t = 0: for unequal rods and for
//! suspensions.

use super::answer::Answer;
use super::compare::standard_errors;
use super::mistakes::{self, Mistake, Setting, right_map};
use super::nearness::{Near, largest_within};
use crate::methods::projections::projections;
use crate::serve::problems::{LoadedProblem, Problem};
use nalgebra::Vector3;
use rayon::prelude::*;

/// Nodes in r_e from −6 to 6 standard deviations: the trapezoid rule for a Gaussian times an analytic function
/// converges geometrically, and this number leaves an error of 10⁻⁹ after three periods.
const NODES: usize = 401;
const REACH: f64 = 6.0;

/// The mean of `of(r_e)` over the aspect ratios of a problem (eq. 11).
fn over_shapes(problem: &Problem, of: impl Fn(f64) -> Option<Vector3<f64>>) -> Option<Vector3<f64>> {
    let sd = 0.01 * problem.aspect_ratio_sd_percent;
    if sd == 0.0 {
        return of(problem.aspect_ratio);
    }
    let mut sum = Vector3::zeros();
    let mut weights = 0.0;
    for node in 0..NODES {
        let z = REACH * (2.0 * node as f64 / (NODES - 1) as f64 - 1.0);
        let weight = (-0.5 * z * z).exp();
        sum += weight * of(problem.aspect_ratio * (1.0 + sd * z))?;
        weights += weight;
    }
    Some(sum / weights)
}

fn setting(problem: &Problem, aspect_ratio: f64) -> Setting {
    Setting { aspect_ratio, ..Setting::from(problem) }
}

/// ⟨|p_i|⟩ of free rods in a program with this mistake.
fn by_mistake(problem: &Problem, mistake: &Mistake, time_s: f64) -> Option<Vector3<f64>> {
    over_shapes(problem, |r| {
        let map = mistake.map(&setting(problem, r), time_s)?;
        // With its length: ⟨|m·p(0)|⟩ = |m|/2 for each row m.
        if mistake.has_length { Some(Vector3::from_fn(|i, _| 0.5 * map.row(i).norm())) } else { projections(&map) }
    })
}

fn free(problem: &Problem, time_s: f64) -> Option<Vector3<f64>> {
    over_shapes(problem, |r| projections(&right_map(&setting(problem, r), time_s)?))
}

/// The same problem with rods of one r_e, the mean.
fn of_one_shape(problem: &Problem) -> Problem {
    Problem { aspect_ratio_sd_percent: 0.0, ..problem.clone() }
}

/// The mistakes about free unequal rods whose answers are nearer than `nearer_than`, each with its distance.
pub(super) fn unequal(loaded: &LoadedProblem, answer: &Answer, nearer_than: f64) -> Vec<Near> {
    let problem = &loaded.problem;
    let distance = |of: &dyn Fn(f64) -> Option<Vector3<f64>>| {
        let off = |(values, time_s): (&Vec<f64>, &f64)| Some((Vector3::from_row_slice(values) - of(*time_s)?).amax());
        largest_within(nearer_than, answer.rows.iter().zip(&problem.times_s).map(off))
    };
    let mut near: Vec<_> = (mistakes::all().into_par_iter())
        .filter_map(|mistake| Some(Near::new(distance(&|time| by_mistake(problem, &mistake, time))?, &mistake.name)))
        .collect();
    let one_shape = of_one_shape(problem);
    near.extend(
        distance(&|time| free(&one_shape, time)).map(|distance| Near::new(distance, "rods of one r_e, the mean")),
    );
    near
}

/// Means with other interpretations of the paper and with mistakes, written by `examples/certify.rs`.
const INTERPRETATIONS: &str = include_str!("../problems/data/interpretations.csv");

/// Wrong means of a suspension with collisions.
type Known = (&'static str, Option<Vec<Vec<f64>>>);

/// The other interpretations that a table has for a problem.
fn interpretations(problem: &Problem) -> Vec<Known> {
    let rows: Vec<Vec<_>> = INTERPRETATIONS.lines().skip(1).map(|line| line.split(',').collect()).collect();
    let own: Vec<_> = rows.into_iter().filter(|row| row[1] == problem.name).collect();
    let values = |row: &Vec<&str>| row[3..].iter().map(|field| field.parse().ok()).collect::<Option<Vec<f64>>>();
    own.chunk_by(|a, b| a[0] == b[0]).map(|rows| (rows[0][0], rows.iter().map(values).collect())).collect()
}

/// A diagnosis of a suspension: the wrong means with which the answer agrees as well as a right answer may with the
/// right ones.
pub(super) fn ensemble(loaded: &LoadedProblem, answer: &Answer) -> Option<String> {
    let problem = &loaded.problem;
    let names = &problem.columns[1..];
    let column = |name: &str| names.iter().position(|found| found == name);
    let mean = [column("x1")?, column("x2")?, column("x3")?];
    let exact = |of: &dyn Fn(&Problem, f64) -> Option<Vector3<f64>>| {
        let row = |time: &f64| {
            let means = of(problem, *time)?;
            let mut row = vec![0.0; names.len()];
            (0..3).for_each(|i| row[mean[i]] = means[i]);
            Some(row)
        };
        problem.times_s.iter().map(row).collect::<Option<Vec<_>>>()
    };
    // A mean and its error are exchanged together.
    let exchanged = |order: [usize; 3]| {
        let row = |certified: &Vec<f64>| {
            let mut row = certified[1..].to_vec();
            for (i, of) in order.into_iter().enumerate() {
                for offset in 0..2 {
                    row[mean[i] + offset] = certified[1 + mean[of] + offset];
                }
            }
            row
        };
        Some(loaded.certified.rows.iter().map(row).collect::<Vec<_>>())
    };
    let mut known: Vec<Known> = vec![
        ("free rods, without collisions", exact(&free)),
        ("p_i without its modulus, whose mean is 0", exact(&|_, _| Some(Vector3::zeros()))),
        ("x1 and x2 exchanged", exchanged([1, 0, 2])),
        ("x1 and x3 exchanged", exchanged([2, 1, 0])),
        ("x2 and x3 exchanged", exchanged([0, 2, 1])),
        ("x2, x3, x1 in place of x1, x2, x3", exchanged([1, 2, 0])),
        ("x3, x1, x2 in place of x1, x2, x3", exchanged([2, 0, 1])),
    ];
    known.extend(interpretations(problem));
    if problem.aspect_ratio_sd_percent > 0.0 {
        let one_shape = of_one_shape(problem);
        known.push(("free rods of one r_e, without collisions", exact(&|_, time_s| free(&one_shape, time_s))));
    }
    let off = |rows: Vec<Vec<f64>>| {
        let off = answer.rows.iter().zip(&rows).map(|(found, due)| Some(standard_errors(names, found, due)));
        largest_within(problem.tolerance, off)
    };
    let near: Vec<_> = known.into_iter().filter_map(|(name, rows)| Some((name, off(rows?)?))).collect();
    let (_, nearest) = near.iter().min_by(|a, b| a.1.total_cmp(&b.1))?;
    let names: Vec<_> = near.iter().map(|(name, _)| *name).collect();
    Some(format!("these are the means of {}, to {nearest:.1} standard errors", names.join(" or of ")))
}

#[cfg(test)]
mod tests {
    use super::super::compare::compare;
    use super::*;
    use crate::oracle::isotropic::{mean_projections, mean_projections_polydisperse};
    use crate::serve::problems;

    fn problem() -> Problem {
        problems::named("unequal-rods").unwrap().problem.clone()
    }

    /// The order of collisions and exchanged arms are not among them: their means are the right ones within the errors.
    #[test]
    fn each_other_interpretation_fails_and_is_named_alone() {
        for name in ["lee-springer", "lee-springer-unequal"] {
            let loaded = problems::loaded(name);
            let all = interpretations(&loaded.problem);
            assert_eq!(all.len(), 6, "{name}");
            for (words, rows) in all {
                let answer = Answer { rows: rows.unwrap(), ..Answer::certified(&loaded) };
                assert!(compare(&loaded, &answer).error > loaded.problem.tolerance, "{name}, {words}");
                let said = ensemble(&loaded, &answer).unwrap();
                assert!(said.starts_with(&format!("these are the means of {words}, to ")), "{name}: {said}");
            }
        }
    }

    /// Isotropic rods have ⟨|p_i|⟩ = ½, for mistakes with and without a length.
    #[test]
    fn every_mistake_starts_from_isotropic_rods() {
        let problem = problem();
        let mistakes = crate::serve::grade::mistakes::all();
        assert!(mistakes.iter().any(|mistake| mistake.has_length));
        for mistake in &mistakes {
            if let Some(means) = by_mistake(&problem, mistake, 0.0) {
                let off = crate::oracle::worst(means.iter().map(|mean| (mean - 0.5).abs()));
                assert!(off < 1e-9, "{}: {means}", mistake.name);
            }
        }
    }

    #[test]
    fn means_of_free_rods_are_carlsons_integrals() {
        let mut problem = problem();
        let period_s = std::f64::consts::TAU * (11.6 + 1.0 / 11.6) / problem.gradient_per_s[1][0];
        for turns in [0.0, 0.1, 0.25, 0.5, 3.0] {
            let time_s = turns * period_s;
            let off =
                |found: Option<Vector3<f64>>, expected: [f64; 3]| (found.unwrap() - Vector3::from(expected)).amax();
            problem.aspect_ratio_sd_percent = 0.0;
            assert!(off(free(&problem, time_s), mean_projections(11.6, turns)) < 1e-12);
            problem.aspect_ratio_sd_percent = 3.6;
            // Values beyond six standard deviations are 2·10⁻⁹ of the Gaussian.
            let expected = mean_projections_polydisperse(11.6, 3.6, turns);
            assert!(off(free(&problem, time_s), expected) < 2e-9, "{turns}");
            let wrong = mean_projections_polydisperse(11.6, 3.7, turns);
            assert!(turns < 0.2 || off(free(&problem, time_s), wrong) > 1e-6, "{turns}");
        }
    }
}
