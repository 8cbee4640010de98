//! The numbers beside a verdict, and where a diagnosis ends, on answers whose error is known.

use crate::grading::{Graded, REFERENCE, answers, problem, text, write};
use std::f64::consts::TAU;
use std::fs;

const NAME: &str = "mid-flip-2";

/// The answer of a program whose rods turn `factor` times as fast, otherwise exact (A.4, A.5): q₁ = p₁ cos ωt −
/// (p₂/r_e) sin ωt, q₂ = r_e p₁ sin ωt + p₂ cos ωt, q₃ = p₃.
fn turning(factor: f64) -> Vec<Vec<String>> {
    turning_of(NAME, factor)
}

fn turning_of(name: &str, factor: f64) -> Vec<Vec<String>> {
    let (told, mut rows) = problem(name);
    let number = |text: &str| text.parse::<f64>().unwrap();
    let r = told["aspect_ratio"].as_f64().unwrap();
    let rate = told["gradient_per_s"][1][0].as_f64().unwrap() / (r + 1.0 / r);
    let start = fs::read_to_string(REFERENCE.path().join(name).join("start.csv")).unwrap();
    let start: Vec<Vec<f64>> = (start.lines().skip(1)).map(|line| line.split(',').map(number).collect()).collect();
    for row in rows.iter_mut().skip(1) {
        let p = &start[row[1].parse::<usize>().unwrap()];
        let (s, c) = (factor * rate * number(&row[0])).sin_cos();
        let q = [p[1] * c - p[2] / r * s, r * p[1] * s + p[2] * c, p[3]];
        let length = q.iter().map(|x| x * x).sum::<f64>().sqrt();
        for i in 0..3 {
            row[2 + i] = format!("{:e}", q[i] / length);
        }
    }
    rows
}

fn graded(name: &str, rows: &[Vec<String>]) -> Graded {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), name, "answer.csv", text(rows));
    answers(dir.path(), &["--problem", name])
}

#[test]
fn phase_orbit_and_length_are_what_was_lost() {
    let number = |found: &Graded, key: &str| found.of(NAME)[key].as_f64().unwrap();
    for behind in [1e-4, -1e-4] {
        let found = graded(NAME, &turning(1.0 - behind));
        assert_eq!(found.verdict(NAME), "FAIL");
        let lost = number(&found, "phase_lost_per_period");
        // Of each period that part is lost; the doubles' phase is good to 1e-12.
        assert!((lost / behind - 1.0).abs() < 1e-6, "{lost}");
        assert!(number(&found, "orbit_drift") < 1e-13 && number(&found, "length_drift") < 1e-15);
        assert_eq!(found.diagnosis(NAME), "");
    }
    let right = graded(NAME, &turning(1.0));
    assert_eq!(right.verdict(NAME), "PASS", "{}", right.words);
    // Only the length of one direction, which is no first one.
    let mut long = turning(1.0);
    let last = long.last_mut().unwrap();
    for value in &mut last[2..] {
        *value = format!("{:e}", 1.001 * value.parse::<f64>().unwrap());
    }
    let found = graded(NAME, &long);
    assert_eq!(found.verdict(NAME), "FAIL");
    for key in ["length_drift", "error"] {
        assert!((number(&found, key) - 1e-3).abs() < 1e-12, "{key}");
    }
}

#[test]
fn a_diagnosis_is_given_on_a_curve_and_not_near_it() {
    for (factor, expected) in
        [(0.5, "half the shear rate"), (2.0, "twice the shear rate"), (0.51, ""), (1.98, ""), (0.9, "")]
    {
        let found = graded(NAME, &turning(factor));
        let said = found.diagnosis(NAME);
        assert!(said.contains(expected) && said.is_empty() == expected.is_empty(), "{factor}: {said}");
    }
    // Of a tensor one column alone lies on the curve of half the shear rate, a₁₁ at half the time; the others are
    // right.
    let (told, mut rows) = problem("isotropic-3");
    let r = told["aspect_ratio"].as_f64().unwrap();
    let period_s = TAU * (r + 1.0 / r) / told["gradient_per_s"][1][0].as_f64().unwrap();
    for row in rows.iter_mut().skip(1) {
        let turns = 0.5 * row[0].parse::<f64>().unwrap() / period_s;
        row[1] = a11(r, turns).to_string();
    }
    let found = graded("isotropic-3", &rows);
    assert_eq!((found.verdict("isotropic-3"), found.diagnosis("isotropic-3")), ("FAIL", ""));
}

/// a₁₁ of isotropic rods at t/T.
fn a11(r: f64, turns: f64) -> f64 {
    use shearbed_validation::oracle::reference::big::{Bits, double};
    use shearbed_validation::oracle::reference::isotropic::Covariance;
    use shearbed_validation::oracle::reference::motion::{Motion, Unit};
    let motion = Motion { gradient_per_s: [[0.0; 3], [1.0, 0.0, 0.0], [0.0; 3]], aspect_ratio: r };
    let covariance = Covariance::at(&motion, &Bits(64).of(turns), Unit::Period).unwrap();
    double(&covariance.second()[0])
}

#[test]
fn directions_of_another_length_are_named() {
    let with = |length: f64| {
        let mut rows = problem("mid-flip-11.6").1;
        for row in rows.iter_mut().skip(1) {
            for value in &mut row[2..] {
                *value = (length * value.parse::<f64>().unwrap()).to_string();
            }
        }
        graded("mid-flip-11.6", &rows)
    };
    let found = with(1.01);
    assert_eq!(found.verdict("mid-flip-11.6"), "FAIL");
    let said = "only the directions' length is wrong: |p| is 1.010000 to 1.010000, where 1 is due";
    assert_eq!(found.diagnosis("mid-flip-11.6"), said);
    assert_eq!(with(1.0).diagnosis("mid-flip-11.6"), "");
}

#[test]
fn several_problems_say_together_what_is_wrong_and_none_at_rest_says_anything() {
    let names = ["mid-flip-2", "mid-flip-11.6", "disc-0.1", "poles"];
    let said = |factor: f64, more: &[(&str, Vec<Vec<String>>)]| {
        let dir = tempfile::tempdir().unwrap();
        names.iter().for_each(|name| drop(write(dir.path(), name, "answer.csv", text(&turning_of(name, factor)))));
        more.iter().for_each(|(name, rows)| drop(write(dir.path(), name, "answer.csv", text(rows))));
        let found = answers(dir.path(), &[]);
        let said = found.grade.as_ref().unwrap()["diagnosis"].as_array().unwrap().clone();
        (said.iter().map(|said| said.as_str().unwrap().to_owned()).collect::<Vec<_>>(), found)
    };
    let (half, found) = said(0.5, &[]);
    assert_eq!(half.len(), 1, "{}", found.words);
    assert!(
        half[0].starts_with("one mistake explains all 4 that do not pass: half the shear rate; its curve fits "),
        "{half:?}"
    );
    let (slow, found) = said(0.8333, &[]);
    assert_eq!(slow.len(), 1, "{}", found.words);
    assert!(slow[0].starts_with("your time runs at 0.833 of the true one, on "), "{slow:?}");
    // A flow that passes contradicts a wrong shear rate.
    let (contradicted, found) = said(0.5, &[("sphere", problem("sphere").1)]);
    assert_eq!(contradicted, [""; 0], "{}", found.words);
    // Nothing moves: many mistakes do that to a rod, and none is named.
    let (rest, found) = said(0.0, &[]);
    assert_eq!(rest, [""; 0], "{}", found.words);
    for name in names {
        assert_eq!(found.diagnosis(name), "every rod is where it started: nothing has moved", "{}", found.words);
    }
    assert_eq!(said(1.0, &[]).0, [""; 0]);
}

#[test]
fn both_rods_of_a_contact_are_judged() {
    for rod in ["a_", "b_"] {
        let (told, mut rows) = problem("contact-rule");
        let tolerance = told["tolerance"].as_f64().unwrap();
        let of_rod: Vec<_> = (0..rows[0].len()).filter(|k| rows[0][*k].starts_with(rod)).collect();
        let row = &mut rows[500];
        let number = |row: &[String], k: usize| row[k].parse::<f64>().unwrap();
        let length = of_rod.iter().map(|k| number(row, *k).powi(2)).sum::<f64>().sqrt();
        row[of_rod[1]] = format!("{:e}", number(row, of_rod[1]) + 2.0 * tolerance * length);
        let found = graded("contact-rule", &rows);
        assert_eq!(found.verdict("contact-rule"), "FAIL", "{rod}");
        assert!(found.words.contains("answer.csv:501"), "{}", found.words);
    }
}
