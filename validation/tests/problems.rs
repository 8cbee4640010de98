//! Reference problems as files, and what certified answers are worth.

mod common;

use rayon::prelude::*;
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use std::sync::LazyLock;
use validation::oracle::naive::{self, Mistake, Naive, Reading, Start, Update};
use validation::problems::{self, Kind, LoadedProblem, Metric};

/// The files of every problem, by `NAME/FILE`: built once.
static FILES: LazyLock<BTreeMap<String, String>> = LazyLock::new(|| {
    let built: Vec<_> = problems::all()
        .par_iter()
        .map(|def| (def.name, def.build()))
        .collect();
    let files = built.iter().flat_map(|(name, built)| {
        let files = problems::files(built).into_iter();
        files.map(move |(file, text)| (format!("{name}/{file}"), text))
    });
    files.collect()
});

fn write(dir: &Path) {
    for (name, text) in FILES.iter() {
        let path = dir.join(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, text).unwrap();
    }
}

fn loaded() -> Vec<LoadedProblem> {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path());
    problems::read(dir.path()).unwrap()
}

#[test]
fn an_export_is_what_is_read_and_is_not_written_over_foreign_files() {
    let dir = tempfile::tempdir().unwrap();
    let reference = dir.path().join("a/ref");
    let names = problems::export(&reference, false).unwrap();
    for name in ["mid-flip-2", "mid-flip-11.6", "mid-flip-100", "mid-flip-10000"] {
        assert!(names.contains(&name));
    }
    let expected: BTreeMap<_, _> = FILES
        .iter()
        .map(|(name, text)| (name.clone(), text.clone().into_bytes()))
        .collect();
    assert_eq!(common::files(&reference), expected);
    assert_eq!(problems::read(&reference).unwrap().len(), names.len());
    // Over its own export: the same again.
    problems::export(&reference, false).unwrap();
    for foreign in ["sphere/answer.csv", "notes.txt"] {
        fs::write(reference.join(foreign), "mine").unwrap();
        fs::write(reference.join("poles/start.csv"), "changed").unwrap();
        let error = problems::export(&reference, false).unwrap_err().to_string();
        assert!(error.contains(foreign) && error.contains("--force"), "{error}");
        assert_eq!(
            fs::read_to_string(reference.join("poles/start.csv")).unwrap(),
            "changed"
        );
        problems::export(&reference, true).unwrap();
        assert_eq!(fs::read_to_string(reference.join(foreign)).unwrap(), "mine");
        assert_eq!(
            fs::read_to_string(reference.join("poles/start.csv")).unwrap(),
            FILES["poles/start.csv"]
        );
        fs::remove_file(reference.join(foreign)).unwrap();
    }
}

#[test]
fn every_problem_holds_to_the_schema_and_spoilt_ones_do_not() {
    let schema: Value = serde_json::from_str(problems::SCHEMA).unwrap();
    let schema = jsonschema::validator_for(&schema).unwrap();
    let mut count = 0;
    for (name, text) in FILES.iter().filter(|(name, _)| name.ends_with("problem.json")) {
        let problem: Value = serde_json::from_str(text).unwrap();
        assert!(
            schema.is_valid(&problem),
            "{name}: {:?}",
            schema.iter_errors(&problem).next()
        );
        count += 1;
        let spoilt: [(&str, Value); 7] = [
            ("format", 2.into()),
            ("kind", "rod".into()),
            ("tolerance", 0.into()),
            ("aspect_ratio", (-1).into()),
            ("extra", 1.into()),
            ("gradient_per_s", vec![vec![0.0; 3]; 2].into()),
            ("ensemble", 1.into()),
        ];
        for (key, value) in spoilt {
            let mut wrong = problem.clone();
            wrong[key] = value;
            assert!(!schema.is_valid(&wrong), "{name}: {key}");
        }
        for key in ["because", "times_s", "columns"] {
            let mut wrong = problem.clone();
            wrong.as_object_mut().unwrap().remove(key);
            assert!(!schema.is_valid(&wrong), "{name}: without {key}");
        }
    }
    assert_eq!(count, problems::all().len());
}

#[test]
fn spoilt_folders_are_refused_with_their_place() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path());
    let (start, certified) = (&FILES["poles/start.csv"], &FILES["poles/certified.csv"]);
    let json = &FILES["poles/problem.json"];
    let row = certified.lines().nth(2).unwrap();
    for (file, spoilt, place, words) in [
        (
            "problem.json",
            json.replace("\"format\": 1", "\"format\": 2"),
            ":2:",
            "reads 1",
        ),
        (
            "problem.json",
            json.replace("\"title\"", "\"titel\""),
            ":4:",
            "titel",
        ),
        ("problem.json", json[..json.len() / 2].into(), ":", "EOF"),
        (
            "problem.json",
            json.replace("\"tolerance\": ", "\"tolerance\": -"),
            "",
            "tolerance",
        ),
        ("start.csv", start.replace("rod,p1", "rod,p"), ":1:", "header"),
        (
            "start.csv",
            start.replace("\n1,", "\n2,"),
            ":3:1:",
            "rod 1 is next",
        ),
        ("start.csv", start.replacen("1.0", "1.1", 1), ":2:2:", "|p|"),
        ("start.csv", start.replacen("1.0", "1e400", 1), ":2:4:", "1e400"),
        (
            "certified.csv",
            certified.replace(&format!("{row}\n"), ""),
            ":3:2:",
            "rod",
        ),
        (
            "certified.csv",
            certified.replace(row, &format!("{row},1")),
            ":3:",
            "fields",
        ),
        ("certified.csv", format!("{certified}{row}\n"), "", "rows"),
        (
            "certified.csv",
            certified.replacen("e-1", "x", 1),
            ":",
            "no finite number",
        ),
        ("certified.csv", String::new(), ":1:", "header"),
    ] {
        let path = dir.path().join("poles").join(file);
        fs::write(&path, &spoilt).unwrap();
        let error = problems::read(dir.path()).unwrap_err().to_string();
        let expected = format!("{}{place}", path.display());
        assert!(
            error.starts_with(&expected) && error.contains(words),
            "{error} | {expected} | {words}"
        );
        fs::write(&path, &FILES[&format!("poles/{file}")]).unwrap();
    }
    problems::read(dir.path()).unwrap();
    let empty = tempfile::tempdir().unwrap();
    let error = problems::read(empty.path()).unwrap_err().to_string();
    assert!(error.contains("no problems here"));
}

#[test]
fn exact_answers_have_more_digits_than_a_double() {
    for def in problems::all() {
        let table = &FILES[&format!("{}/certified.csv", def.name)];
        let digits = table
            .lines()
            .skip(1)
            .flat_map(|row| row.split(',').skip(1))
            .map(|field| {
                let mantissa = field.split('e').next().unwrap_or_default();
                mantissa.chars().filter(char::is_ascii_digit).count()
            });
        let most = digits.max().unwrap();
        match def.name {
            "log-rolling" => assert_eq!(most, 1),
            "unequal-rods" => assert_eq!(most, 12),
            name if name.starts_with("lee-springer") => assert!(most >= 15),
            name => assert!(most >= 20, "{name}: {most}"),
        }
    }
}

type Vector = [f64; 3];

/// ṗ of A.1 in doubles, as a program would write it down.
fn rate(l: &[Vector; 3], r: f64, p: Vector) -> Vector {
    let shape = (r * r - 1.0) / (r * r + 1.0);
    let a = |i: usize, j: usize| 0.5 * (l[i][j] - l[j][i]) + shape * 0.5 * (l[i][j] + l[j][i]);
    let pull = [0, 1, 2].map(|i| a(i, 0) * p[0] + a(i, 1) * p[1] + a(i, 2) * p[2]);
    let along = (0..3).map(|i| p[i] * pull[i]).sum::<f64>();
    [0, 1, 2].map(|i| pull[i] - p[i] * along)
}

fn euler(l: &[Vector; 3], r: f64, p: Vector, h: f64) -> Vector {
    let k = rate(l, r, p);
    [0, 1, 2].map(|i| p[i] + h * k[i])
}

fn rk4(l: &[Vector; 3], r: f64, p: Vector, h: f64) -> Vector {
    let ahead = |k: Vector, h: f64| [0, 1, 2].map(|i| p[i] + h * k[i]);
    let first = rate(l, r, p);
    let second = rate(l, r, ahead(first, 0.5 * h));
    let third = rate(l, r, ahead(second, 0.5 * h));
    let fourth = rate(l, r, ahead(third, h));
    [0, 1, 2].map(|i| p[i] + h / 6.0 * (first[i] + 2.0 * (second[i] + third[i]) + fourth[i]))
}

type Step = fn(&[Vector; 3], f64, Vector, f64) -> Vector;

/// The largest angle of a fixed-step method from the certified axes.
fn error(loaded: &LoadedProblem, gradient: &[Vector; 3], step: Step, steps_per_strain: f64) -> f64 {
    let (problem, rods) = (&loaded.problem, loaded.start.len());
    let norm = gradient.as_flattened().iter().map(|x| x * x).sum::<f64>().sqrt();
    let of_rod = |rod: usize| {
        let (mut p, mut now, mut worst) = (loaded.start[rod], 0.0, 0.0_f64);
        for (at, time) in problem.times_s.iter().enumerate() {
            let steps = ((time - now) * norm * steps_per_strain).ceil().max(1.0);
            for _ in 0..steps as u64 {
                p = step(gradient, problem.aspect_ratio, p, (time - now) / steps);
                let length = p.iter().map(|x| x * x).sum::<f64>().sqrt();
                p = p.map(|x| x / length);
            }
            now = *time;
            let row = &loaded.certified.rows[at * rods + rod];
            let q = [row[2], row[3], row[4]];
            let across = [0, 1, 2].map(|i| p[(i + 1) % 3] * q[(i + 2) % 3] - p[(i + 2) % 3] * q[(i + 1) % 3]);
            let sine = across.iter().map(|x| x * x).sum::<f64>().sqrt();
            worst = worst.max(if sine.is_nan() {
                f64::INFINITY
            } else {
                sine.min(1.0).asin()
            });
        }
        worst
    };
    (0..rods).into_par_iter().map(of_rod).reduce(|| 0.0, f64::max)
}

#[test]
fn a_right_code_in_doubles_passes_and_wrong_ones_fail() {
    for loaded in loaded().iter().filter(|loaded| loaded.problem.kind == Kind::Rods) {
        let problem = &loaded.problem;
        let (name, l, tolerance) = (problem.name.as_str(), problem.gradient_per_s, problem.tolerance);
        assert_eq!(problem.metric, Metric::Angle);
        // RK4 needs h⁴/100 or so per strain; where the tolerance is loose, fewer steps do.
        let steps_per_strain = if name == "mid-flip-10000" { 50.0 } else { 300.0 };
        let right = error(loaded, &l, rk4, steps_per_strain);
        assert!(right <= tolerance, "{name}: {right:e} > {tolerance:e}");
        if name == "ten-thousand-periods" {
            continue;
        }
        let transposed = [0, 1, 2].map(|i| [0, 1, 2].map(|j| l[j][i]));
        let halved = l.map(|row| row.map(|x| 0.5 * x));
        let wrong = [
            ("Euler", error(loaded, &l, euler, steps_per_strain)),
            ("transposed", error(loaded, &transposed, rk4, steps_per_strain)),
            ("half the rate", error(loaded, &halved, rk4, steps_per_strain)),
        ];
        for (mistake, error) in wrong {
            // On the vorticity axis nothing moves; a symmetric gradient is its own transpose.
            let blind = name == "log-rolling" || (mistake == "transposed" && name.ends_with("extension"));
            assert_eq!(error > 2.0 * tolerance, !blind, "{name}: {mistake}: {error:e}");
        }
    }
}

/// The suspension of an ensemble problem, for the naive reference, which shares no code with the simulator.
fn suspension(loaded: &LoadedProblem, replica: u64, mistake: Option<Mistake>) -> naive::Problem {
    let (problem, ensemble) = (&loaded.problem, loaded.problem.ensemble.as_ref().unwrap());
    naive::Problem {
        count: ensemble.count as usize,
        shear_rate_per_s: problem.gradient_per_s[1][0],
        length_mm: ensemble.length_mm,
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
            let squares = traces
                .iter()
                .map(|trace| (trace[at][axis] - mean).powi(2))
                .sum::<f64>();
            let se = (squares / (n - 1.0) / n).sqrt();
            worst = worst.max((mean - row[1 + 2 * axis]).abs() / se.hypot(row[2 + 2 * axis]));
            largest = largest.max(se);
        }
    }
    (worst, largest)
}

#[test]
fn the_naive_reference_agrees_with_certified_ensembles_and_wrong_ones_do_not() {
    for loaded in loaded()
        .iter()
        .filter(|loaded| loaded.problem.kind == Kind::Ensemble)
    {
        let (tolerance, ensemble) = (
            loaded.problem.tolerance,
            loaded.problem.ensemble.as_ref().unwrap(),
        );
        let (error, se) = standard_errors(loaded, 200, None);
        assert!(
            error <= tolerance && se <= ensemble.largest_standard_error,
            "{error} {se}"
        );
        for mistake in [Mistake::KickSign, Mistake::ProbabilityComplement] {
            let (error, _) = standard_errors(loaded, 100, Some(mistake));
            assert!(error > 2.0 * tolerance, "{mistake:?}: {error}");
        }
    }
}
