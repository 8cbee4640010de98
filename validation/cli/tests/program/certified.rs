//! What certified answers and tolerances are worth: right codes pass, wrong ones fail.

use rayon::prelude::*;
use shearbed::nalgebra::{Matrix3, Vector3};
use shearbed_validation::methods::textbook::{jeffery_rate, rk4_in_p};
use shearbed_validation::oracle::naive::{self, Mistake, Naive};
use shearbed_validation::serve::problems::{self, Kind, LoadedProblem, Metric};
use std::sync::LazyLock;

/// Every problem, as a program that has only the files sees it.
static PROBLEMS: LazyLock<Vec<LoadedProblem>> = LazyLock::new(|| {
    let dir = tempfile::tempdir().unwrap();
    problems::export(dir.path(), false).unwrap();
    problems::read(dir.path()).unwrap()
});

fn of_kind(kind: Kind) -> impl Iterator<Item = &'static LoadedProblem> {
    PROBLEMS.iter().filter(move |loaded| loaded.problem.kind == kind)
}

type Step = fn(&Matrix3<f64>, Vector3<f64>, f64) -> Vector3<f64>;
const EULER: Step = |a, p, h| (p + h * jeffery_rate(a, p)).normalize();
const RK4: Step = |a, p, h| rk4_in_p(a, p, h, 1).normalize();

/// The largest angle of a fixed-step method from the certified axes.
fn error(loaded: &LoadedProblem, l: Matrix3<f64>, step: Step, steps_per_strain: f64) -> f64 {
    let (problem, rods) = (&loaded.problem, loaded.start.len());
    let square = problem.aspect_ratio.powi(2);
    let a = (square * l - l.transpose()) / (square + 1.0);
    let of_rod = |rod: usize| {
        let (mut p, mut now, mut worst) = (Vector3::from(loaded.start[rod]), 0.0, 0.0_f64);
        for (at, time) in problem.times_s.iter().enumerate() {
            let steps = ((time - now) * l.norm() * steps_per_strain).ceil().max(1.0);
            p = (0..steps as u64).fold(p, |p, _| step(&a, p, (time - now) / steps));
            now = *time;
            let row = &loaded.certified.rows[at * rods + rod];
            let sine = p.cross(&Vector3::new(row[2], row[3], row[4])).norm();
            worst = worst.max(if sine.is_nan() { f64::INFINITY } else { sine.min(1.0).asin() });
        }
        worst
    };
    (0..rods).into_par_iter().map(of_rod).reduce(|| 0.0, f64::max)
}

#[test]
fn a_right_code_in_doubles_passes_and_wrong_ones_fail() {
    // `grade_live` has codes for flows that turn.
    let steady = |loaded: &&LoadedProblem| loaded.problem.rotation_rad_per_s.is_none();
    let loaded: Vec<_> = of_kind(Kind::Rods).filter(steady).collect();
    loaded.into_par_iter().for_each(|loaded| {
        let problem = &loaded.problem;
        let (name, tolerance) = (problem.name.as_str(), problem.tolerance);
        let l = Matrix3::from_fn(|i, j| problem.gradient_per_s[i][j]);
        assert_eq!(problem.metric, Metric::Angle);
        // RK4 errs by (ωh)⁴/120 of the phase, times what a flip stretches; where the tolerance is loose, fewer steps
        // do.
        let steps_per_strain = match name {
            "mid-flip-10000" => 50.0,
            "ten-thousand-periods" => 80.0,
            _ => 300.0,
        };
        let right = error(loaded, l, RK4, steps_per_strain);
        assert!(right <= tolerance, "{name}: {right:e} > {tolerance:e}");
        if name == "ten-thousand-periods" {
            return;
        }
        // Euler's method comes to 2e-3 as well where its steps are short enough; the others are as wrong with few.
        let coarse = if name == "mid-flip-10000" { 10.0 } else { steps_per_strain };
        let wrong = [
            ("Euler", error(loaded, l, EULER, coarse)),
            ("transposed", error(loaded, l.transpose(), RK4, coarse)),
            ("half the rate", error(loaded, 0.5 * l, RK4, coarse)),
        ];
        for (mistake, error) in wrong {
            // On the vorticity axis nothing moves; a symmetric gradient is its own transpose.
            let blind = name == "log-rolling" || (mistake == "transposed" && name.ends_with("extension"));
            assert_eq!(error > 2.0 * tolerance, !blind, "{name}: {mistake}: {error:e}");
        }
    });
}

/// The suspension of an ensemble problem, for the naive reference, which shares no code with the simulator.
fn suspension(loaded: &LoadedProblem, replica: u64, mistake: Option<Mistake>) -> naive::NaiveProblem {
    let (problem, ensemble) = (&loaded.problem, loaded.problem.ensemble.as_ref().unwrap());
    naive::NaiveProblem {
        count: ensemble.count as usize,
        shear_rate_per_s: problem.gradient_per_s[1][0],
        length_mm: ensemble.length_mm,
        aspect_ratio: problem.aspect_ratio,
        aspect_ratio_sd_percent: problem.aspect_ratio_sd_percent,
        concentration_per_cm3: ensemble.concentration_per_cm3,
        alpha: ensemble.alpha,
        m: ensemble.m,
        steps_per_period: ensemble.steps_per_period as usize,
        mistake,
        ..naive::NaiveProblem::paper(11, replica)
    }
}

/// The largest difference from the certified means in standard errors, and the largest standard error.
fn standard_errors(loaded: &LoadedProblem, replicas: u64, mistake: Option<Mistake>) -> (f64, f64) {
    let times = &loaded.problem.times_s;
    let trace = |replica: u64| -> Vec<[f64; 3]> {
        let mut naive = Naive::new(suspension(loaded, replica, mistake));
        let step_s = suspension(loaded, replica, None).time_step_s();
        let mut done = 0;
        let mean = |time: &f64| {
            let steps = (time / step_s).round() as u64;
            (done..steps).for_each(|_| naive.step());
            done = steps;
            naive::mean_projections(&naive.orientations)
        };
        times.iter().map(mean).collect()
    };
    let traces: Vec<_> = (0..replicas).into_par_iter().map(trace).collect();
    let n = replicas as f64;
    let (mut worst, mut largest) = (0.0_f64, 0.0_f64);
    for (at, row) in loaded.certified.rows.iter().enumerate() {
        for axis in 0..3 {
            let mean = traces.iter().map(|trace| trace[at][axis]).sum::<f64>() / n;
            let squares = traces.iter().map(|trace| (trace[at][axis] - mean).powi(2)).sum::<f64>();
            let se = (squares / (n - 1.0) / n).sqrt();
            worst = worst.max((mean - row[1 + 2 * axis]).abs() / se.hypot(row[2 + 2 * axis]));
            largest = largest.max(se);
        }
    }
    (worst, largest)
}

#[test]
fn the_naive_reference_agrees_with_certified_ensembles_and_wrong_ones_do_not() {
    // The sign of a kick does not show in means, because either sign is as likely; the problem `contact-rule` has it.
    let mistakes = [Mistake::ProbabilityExponent, Mistake::ProbabilityComplement];
    assert_eq!(of_kind(Kind::Ensemble).count(), mistakes.len());
    for (loaded, mistake) in of_kind(Kind::Ensemble).zip(mistakes) {
        let (tolerance, ensemble) = (loaded.problem.tolerance, loaded.problem.ensemble.as_ref().unwrap());
        const REPLICAS: u64 = 160;
        let (error, se) = standard_errors(loaded, REPLICAS, None);
        assert!(error <= tolerance, "{error}");
        // An answer needs 1000 replicas. A standard deviation of 160 values is known to 5.6 %: four of these.
        let of_answer = se * (REPLICAS as f64 / 1000.0).sqrt();
        assert!(of_answer <= 1.22 * ensemble.largest_standard_error, "{se}");
        let (error, _) = standard_errors(loaded, 24, Some(mistake));
        assert!(error > 2.0 * tolerance, "{mistake:?}: {error}");
    }
}
