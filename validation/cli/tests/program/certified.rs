//! What certified answers and tolerances are worth: right codes pass, wrong ones fail.

use rayon::prelude::*;
use shearbed_validation::oracle::naive::{self, Mistake, Naive, Reading, Start, Update};
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

type Vector = [f64; 3];

/// A = W + ΛD of A.1, in doubles.
fn rates(l: &[Vector; 3], r: f64) -> [Vector; 3] {
    let shape = (r * r - 1.0) / (r * r + 1.0);
    let a = |i: usize, j: usize| 0.5 * (l[i][j] - l[j][i]) + shape * 0.5 * (l[i][j] + l[j][i]);
    [0, 1, 2].map(|i| [0, 1, 2].map(|j| a(i, j)))
}

// Without loops: they cost three times as much where nothing is optimised.
fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn ahead(p: Vector, h: f64, k: Vector) -> Vector {
    [p[0] + h * k[0], p[1] + h * k[1], p[2] + h * k[2]]
}

/// ṗ of A.1, as a program would write it down.
fn rate(a: &[Vector; 3], p: Vector) -> Vector {
    let pull = [dot(a[0], p), dot(a[1], p), dot(a[2], p)];
    ahead(pull, -dot(p, pull), p)
}

fn euler(a: &[Vector; 3], p: Vector, h: f64) -> Vector {
    ahead(p, h, rate(a, p))
}

fn rk4(a: &[Vector; 3], p: Vector, h: f64) -> Vector {
    let first = rate(a, p);
    let second = rate(a, ahead(p, 0.5 * h, first));
    let third = rate(a, ahead(p, 0.5 * h, second));
    let fourth = rate(a, ahead(p, h, third));
    let outer = ahead(first, 1.0, fourth);
    ahead(ahead(p, h / 6.0, outer), h / 3.0, ahead(second, 1.0, third))
}

type Step = fn(&[Vector; 3], Vector, f64) -> Vector;

/// The largest angle of a fixed-step method from the certified axes.
fn error(loaded: &LoadedProblem, gradient: &[Vector; 3], step: Step, steps_per_strain: f64) -> f64 {
    let (problem, rods) = (&loaded.problem, loaded.start.len());
    let a = rates(gradient, problem.aspect_ratio);
    let norm = gradient.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt();
    let of_rod = |rod: usize| {
        let (mut p, mut now, mut worst) = (loaded.start[rod], 0.0, 0.0_f64);
        for (at, time) in problem.times_s.iter().enumerate() {
            let steps = ((time - now) * norm * steps_per_strain).ceil().max(1.0);
            for _ in 0..steps as u64 {
                p = step(&a, p, (time - now) / steps);
                let length = dot(p, p).sqrt();
                p = [p[0] / length, p[1] / length, p[2] / length];
            }
            now = *time;
            let row = &loaded.certified.rows[at * rods + rod];
            let q = [row[2], row[3], row[4]];
            let across = [0, 1, 2].map(|i| p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3]);
            let sine = dot(across, across).sqrt();
            worst = worst.max(if sine.is_nan() { f64::INFINITY } else { sine.min(1.0).asin() });
        }
        worst
    };
    (0..rods).into_par_iter().map(of_rod).reduce(|| 0.0, f64::max)
}

#[test]
fn a_right_code_in_doubles_passes_and_wrong_ones_fail() {
    let loaded: Vec<_> = of_kind(Kind::Rods).collect();
    loaded.into_par_iter().for_each(|loaded| {
        let problem = &loaded.problem;
        let (name, l, tolerance) = (problem.name.as_str(), problem.gradient_per_s, problem.tolerance);
        assert_eq!(problem.metric, Metric::Angle);
        // RK4 errs by (ωh)⁴/120 of the phase, times what a flip stretches; where the tolerance is loose, fewer steps
        // do.
        let steps_per_strain = match name {
            "mid-flip-10000" => 50.0,
            "ten-thousand-periods" => 80.0,
            _ => 300.0,
        };
        let right = error(loaded, &l, rk4, steps_per_strain);
        assert!(right <= tolerance, "{name}: {right:e} > {tolerance:e}");
        if name == "ten-thousand-periods" {
            return;
        }
        let transposed = [0, 1, 2].map(|i| [0, 1, 2].map(|j| l[j][i]));
        let halved = l.map(|row| row.map(|x| 0.5 * x));
        // Euler's method comes to 2e-3 as well where its steps are short enough; the others are as wrong with few.
        let coarse = if name == "mid-flip-10000" { 10.0 } else { steps_per_strain };
        let wrong = [
            ("Euler", error(loaded, &l, euler, coarse)),
            ("transposed", error(loaded, &transposed, rk4, coarse)),
            ("half the rate", error(loaded, &halved, rk4, coarse)),
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
        other_flow: None,
        length_mm: ensemble.length_mm,
        length_sd_percent: 0.0,
        box_mm: None,
        aspect_ratio: problem.aspect_ratio,
        aspect_ratio_sd_percent: problem.aspect_ratio_sd_percent,
        orientation: Start::Isotropic,
        concentration_per_cm3: ensemble.concentration_per_cm3,
        alpha: ensemble.alpha,
        m: ensemble.m,
        min_contact_arm: 0.0,
        update: Update::Rotation,
        reading: Reading::default(),
        steps_per_period: ensemble.steps_per_period as usize,
        seed: 11,
        replica,
        mistake,
    }
}

/// The largest difference from the certified means in standard errors, and the largest standard error.
fn standard_errors(loaded: &LoadedProblem, replicas: u64, mistake: Option<Mistake>) -> (f64, f64) {
    let times = &loaded.problem.times_s;
    let trace = |replica: u64| -> Vec<Vector> {
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
