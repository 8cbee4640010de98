//! Means of suspensions that a program may give for the right ones, and what is said of them.

use crate::bounded::Bounded;
use crate::grading::{answers, problem, text, write};
use std::process::Command;

const ENSEMBLES: [&str; 2] = ["lee-springer", "lee-springer-unequal"];

/// x1, x2, x3 of free rods at t/T, as `shearbed reference` prints them.
fn free(turns: f64, sd_percent: &str) -> Vec<String> {
    let output = Command::new(env!("CARGO_BIN_EXE_shearbed"))
        .args(["reference", "--aspect-ratio", "11.6", "--shear-rate-per-s", "0.5"])
        .args(["--times", &format!("{turns}:{turns}:1")])
        .args((sd_percent != "0").then_some(["--aspect-ratio-sd-percent", sd_percent]).into_iter().flatten())
        .ended();
    let table = String::from_utf8(output.stdout).unwrap();
    let row = table.lines().nth(1).unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)));
    row.split(',').skip(3).take(3).map(str::to_owned).collect()
}

/// The certified rows with other means, and standard errors of a thousand replicas.
fn spoilt(name: &str, means: impl Fn(&[String]) -> [String; 3]) -> String {
    let (_, mut rows) = problem(name);
    for row in rows.iter_mut().skip(1) {
        let means = means(row);
        for (i, mean) in means.into_iter().enumerate() {
            row[1 + 2 * i] = mean;
            row[2 + 2 * i] = "1e-3".into();
        }
    }
    text(&rows)
}

#[test]
fn ensembles_of_free_rods_and_with_columns_exchanged_are_named_and_others_not() {
    let turns_of = |row: &[String]| {
        let time_s: f64 = row[0].parse().unwrap();
        let turns = time_s * 0.5 / (std::f64::consts::TAU * (11.6 + 1.0 / 11.6));
        (turns * 1e6).round() / 1e6
    };
    for (name, sd_percent) in ENSEMBLES.into_iter().zip(["0", "3.6"]) {
        let with = |means: &dyn Fn(&[String]) -> [String; 3]| {
            let dir = tempfile::tempdir().unwrap();
            write(dir.path(), name, "answer.csv", spoilt(name, means));
            answers(dir.path(), &[])
        };
        let of_free = |sd: &str| with(&|row| free(turns_of(row), sd).try_into().unwrap());
        let exchanged = with(&|row| [row[3].clone(), row[1].clone(), row[5].clone()]);
        let none = with(&|_| ["0", "0", "0"].map(String::from));
        for (found, expected) in [
            (of_free(sd_percent), "these are the means of free rods, without collisions, to 0."),
            (exchanged, "these are the means of x1 and x2 exchanged, to "),
            (none, "these are the means of p_i without its modulus"),
        ] {
            assert_eq!(found.verdict(name), "FAIL");
            assert!(found.diagnosis(name).starts_with(expected), "{}", found.words);
        }
        if sd_percent != "0" {
            let found = of_free("0");
            let expected = "these are the means of free rods of one r_e, without collisions";
            assert!(found.diagnosis(name).starts_with(expected), "{}", found.words);
        }
        // Means of nothing that is known.
        let found = with(&|_| ["0.3", "0.3", "0.3"].map(String::from));
        assert_eq!((found.verdict(name), found.diagnosis(name)), ("FAIL", ""), "{}", found.words);
        // The right ones.
        let found = with(&|row| [row[1].clone(), row[3].clone(), row[5].clone()]);
        assert_eq!((found.verdict(name), found.diagnosis(name)), ("PASS", ""), "{}", found.words);
    }
}
