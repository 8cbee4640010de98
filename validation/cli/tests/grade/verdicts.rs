//! What passes, what fails, and with which numbers.

use crate::grading::{REFERENCE, answers, files, names, off_by, problem, text, write};
use serde_json::Value;

#[test]
fn half_the_tolerance_passes_and_twice_fails_in_every_problem_and_metric() {
    let dir = tempfile::tempdir().unwrap();
    let names = names();
    assert!(names.len() > 15, "{names:?}");
    for (part, verdict, code) in [(0.0, "PASS", 0), (0.5, "PASS", 0), (2.0, "FAIL", 1)] {
        let mine = dir.path().join(verdict);
        for name in &names {
            write(&mine, name, "answer.csv", text(&off_by(name, part)));
        }
        let ended = files(REFERENCE.path(), &mine, &["--all"]);
        let html = ended.html.as_deref().unwrap();
        assert_eq!(html.matches(&format!(">{verdict}</span>")).count(), names.len());
        assert_eq!(ended.code, Some(code), "{part}: {}", ended.words);
        for name in &names {
            let found = ended.of(name);
            assert_eq!(found["verdict"], verdict, "{part}: {found:#}");
            assert_eq!(found["diagnosis"], Value::Null, "{found:#}");
            // Certified directions stay on their own orbits, to the digits of a double at r_e = 10⁴.
            let drift = found["orbit_drift"].as_f64().unwrap_or(0.0);
            assert!(part > 0.0 || drift < 1e-8, "{found:#}");
            let ratio = found["error"].as_f64().unwrap() / found["tolerance"].as_f64().unwrap();
            assert!((ratio - part).abs() < 0.02 + 0.01 * part, "{part} {ratio}: {found:#}");
        }
    }
}

/// The page begins with what fails, has no column that is empty throughout, and says each reason once.
#[test]
fn the_page_begins_with_what_fails() {
    let dir = tempfile::tempdir().unwrap();
    for (name, part) in [("isotropic-3", 0.5), ("mid-flip-2", 0.5), ("isotropic-11.6", 2.0)] {
        write(dir.path(), name, "answer.csv", text(&off_by(name, part)));
    }
    let html = answers(dir.path(), &[]).html.unwrap();
    let place = |name: &str| html.find(&format!("id=\"problem-{name}\"")).unwrap();
    assert!(place("isotropic-11.6") < place("isotropic-3") && place("isotropic-3") < place("mid-flip-2"));
    let titled = |title: &str| html.contains(&format!("data-label=\"{title}\""));
    assert!(titled("error") && titled("C_b drift") && !titled("order") && !titled("reference"), "{html}");
    let reasons = html.split_once("Why these tolerances").unwrap().1;
    let named = |name: &str| reasons.matches(name).count();
    assert_eq!([named("isotropic-3"), named("mid-flip-2"), named("isotropic-11.6")], [1; 3]);
}

#[test]
fn what_is_not_finite_is_an_answer_that_fails() {
    for word in ["nan", "NaN", "inf", "-Infinity", "1e308"] {
        let dir = tempfile::tempdir().unwrap();
        let (_, mut rows) = problem("mid-flip-2");
        rows[2][3] = word.into();
        let file = write(dir.path(), "mid-flip-2", "answer.csv", text(&rows));
        let ended = answers(dir.path(), &[]);
        let found = ended.of("mid-flip-2");
        let expected = format!("{}:3: a value is not finite", file.display());
        assert_eq!((ended.code, &found["verdict"], &found["error"]), (Some(1), &"FAIL".into(), &Value::Null));
        assert_eq!(found["note"], expected);
    }
    // Nothing is said of where an infinite value may come from.
    for name in ["isotropic-3", "closed-ft-hybrid-0.01"] {
        let dir = tempfile::tempdir().unwrap();
        let (_, mut rows) = problem(name);
        *rows.last_mut().unwrap().last_mut().unwrap() = "inf".into();
        write(dir.path(), name, "answer.csv", text(&rows));
        let ended = answers(dir.path(), &[]);
        let found = ended.of(name);
        assert_eq!((&found["verdict"], &found["diagnosis"]), (&"FAIL".into(), &Value::Null));
        assert!(found["note"].as_str().unwrap().ends_with(": a value is not finite"), "{found:#}");
    }
}

/// Answers of these numbers of steps that are off by these parts of the tolerance.
fn ladder(mine: &std::path::Path, name: &str, answers: &[(u32, f64)]) {
    for (steps, part) in answers {
        write(mine, name, &format!("steps-{steps}.csv"), text(&off_by(name, *part)));
    }
}

#[test]
fn orders_are_read_from_steps_and_judged_against_a_claim() {
    let dir = tempfile::tempdir().unwrap();
    // Errors of 4096, 256, 16 tolerances, and one below it.
    ladder(dir.path(), "mid-flip-100", &[(100, 4096.0), (200, 256.0), (400, 16.0), (800, 0.9)]);
    let ended = answers(dir.path(), &["--order", "4"]);
    let found = ended.of("mid-flip-100");
    assert_eq!((&found["verdict"], &found["steps"]), (&"PASS".into(), &800.into()), "{found:#}");
    assert!((found["observed_order"].as_f64().unwrap() - 4.0).abs() < 1e-3);
    // Without the last: 16 tolerances with 400 steps are one with twice as many.
    let other = tempfile::tempdir().unwrap();
    ladder(other.path(), "mid-flip-100", &[(100, 4096.0), (200, 256.0), (400, 16.0)]);
    let short = answers(other.path(), &[]);
    let note = short.of("mid-flip-100")["note"].as_str().unwrap();
    assert!(note.starts_with("at this order about 8e2 steps would be within the tolerance"), "{note}");
    // The picture has the program's curve in bold black, and ours in grey.
    let html = ended.html.as_deref().unwrap();
    let picture = html.split_once("<svg").unwrap().1.split_once("</svg>").unwrap().0;
    assert!(picture.contains("Error against steps, mid-flip-100") && picture.contains("RK4 in p"));
    assert!(picture.contains("error (rad) against steps: the graded program, "), "first, and so bold");
    let line = |stroke: &str| picture.match_indices(stroke).map(|(at, _)| at).collect::<Vec<_>>();
    let (bold, grey) = (line("stroke=\"#000000\" stroke-width=\"24\""), line("#9A9A9A"));
    assert!(!bold.is_empty() && grey.len() >= 4, "{} {}", bold.len(), grey.len());
    let ended = answers(dir.path(), &["--order", "3"]);
    assert_eq!(ended.of("mid-flip-100")["note"], "observed order +4.00 where 3 is claimed");
    assert_eq!(ended.code, Some(1));
    // It diverges.
    ladder(dir.path(), "mid-flip-2", &[(100, 16.0), (200, 256.0), (400, 4096.0)]);
    let ended = answers(dir.path(), &[]);
    let order = ended.of("mid-flip-2")["observed_order"].as_f64().unwrap();
    assert!((order + 4.0).abs() < 1e-3, "{order}");
}

#[test]
fn one_wild_answer_between_right_ones_fails() {
    let dir = tempfile::tempdir().unwrap();
    ladder(dir.path(), "mid-flip-100", &[(100, 4096.0), (200, 256.0), (400, 1e6), (800, 0.9)]);
    let ended = answers(dir.path(), &[]);
    let (found, note) = (ended.of("mid-flip-100"), ended.of("mid-flip-100")["note"].as_str().unwrap_or_default());
    assert_eq!((ended.code, &found["verdict"]), (Some(1), &"FAIL".into()));
    assert!(note.starts_with("off by ") && note.contains(" with 400 steps, by "), "{note}");
}

/// Errors that fall by an order from a thousand tolerances to below one, in steps-N.csv.
fn falling(mine: &std::path::Path, name: &str, order: f64) {
    let mut part = 1000.0;
    for k in 0..20 {
        write(mine, name, &format!("steps-{}.csv", 100 << k), text(&off_by(name, part)));
        if part < 1.0 {
            return;
        }
        part /= 2f64.powf(order);
    }
}

#[test]
fn an_order_fails_where_whole_orders_are_lost_and_not_where_it_has_not_settled() {
    let judged = |orders: &[(&str, f64)], claim: &str| {
        let dir = tempfile::tempdir().unwrap();
        orders.iter().for_each(|(name, order)| falling(dir.path(), name, *order));
        answers(dir.path(), &["--order", claim])
    };
    for (order, verdict, found) in [
        (4.0, "PASS", "seen"),
        (4.15, "PASS", "seen"),
        (3.53, "PASS", "unclear"),
        (3.0, "FAIL", "lower"),
        (2.0, "FAIL", "lower"),
        (5.0, "FAIL", "higher"),
    ] {
        let ended = judged(&[("mid-flip-100", order)], "4");
        let of = ended.of("mid-flip-100");
        assert_eq!((&of["verdict"], &of["order_found"]), (&verdict.into(), &found.into()), "{order}: {of:#}");
    }
    // Another problem has the claimed order: this one lacks the error term. Rods in the shear plane may always lack it.
    for orders in [&[("mid-flip-100", 5.0), ("disc-0.1", 4.0)][..], &[("shear-plane", 5.0)]] {
        let ended = judged(orders, "4");
        assert_eq!(ended.code, Some(0), "{}", ended.words);
        let note = ended.of(orders[0].0)["note"].as_str().unwrap_or_default();
        assert!(note.contains("no error of order 4"), "{}", ended.words);
    }
}

#[test]
fn what_is_missing_has_one_line_and_the_table_80_columns() {
    let dir = tempfile::tempdir().unwrap();
    write(dir.path(), "mid-flip-2", "answer.csv", text(&off_by("mid-flip-2", 0.5)));
    write(dir.path(), "sphere", "answer.csv", text(&off_by("sphere", 2.0)));
    let ended = files(REFERENCE.path(), dir.path(), &[]);
    assert_eq!(ended.words.matches("MISSING").count(), 2 + usize::from(ended.code == Some(1)), "{}", ended.words);
    assert!(ended.words.contains(&format!("{} MISSING, no answer: ", names().len() - 2)), "{}", ended.words);
    let table = ended.words.split("\nreport:").next().unwrap();
    let longest = table.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(longest <= 80, "{longest}: {}", ended.words);
}

/// The certified means, with a standard error of an answer, and one mean off by so much.
fn off_in_a_mean(standard_error: f64, off: f64) -> Vec<Vec<String>> {
    let (_, mut rows) = problem("lee-springer");
    for row in rows.iter_mut().skip(1) {
        for k in [2, 4, 6] {
            row[k] = standard_error.to_string();
        }
    }
    let mean: f64 = rows[3][1].parse().unwrap();
    rows[3][1] = (mean + off).to_string();
    rows
}

#[test]
fn too_little_data_and_errors_that_are_none_do_not_pass() {
    let dir = tempfile::tempdir().unwrap();
    let (problem, _) = problem("lee-springer");
    let allowed = problem["ensemble"]["largest_standard_error"].as_f64().unwrap();
    for (se, words) in [
        (0.9 * allowed, ""),
        (1.1 * allowed, "too little data"),
        (-0.5 * allowed, "a standard error above 0"),
        (0.0, "a standard error above 0"),
    ] {
        write(dir.path(), "lee-springer", "answer.csv", text(&off_in_a_mean(se, 0.0)));
        let ended = answers(dir.path(), &[]);
        let found = ended.of("lee-springer");
        let verdict = if words.is_empty() { "PASS" } else { "FAIL" };
        assert_eq!(found["verdict"], verdict, "{found:#}");
        let note = found["note"].as_str().unwrap_or_default();
        assert!(note.contains(words), "{found:#}");
    }
}

#[test]
fn a_mean_that_is_off_by_four_of_its_errors_fails() {
    let dir = tempfile::tempdir().unwrap();
    let (problem, _) = problem("lee-springer");
    let allowed = problem["ensemble"]["largest_standard_error"].as_f64().unwrap();
    // Of the certified means the errors are up to 2.3e-4.
    let sigma = |parts: f64| parts * (0.9 * allowed).hypot(2.3e-4);
    for (se, off, verdict) in
        [(0.002, 0.008, "FAIL"), (0.9 * allowed, sigma(4.0), "FAIL"), (0.9 * allowed, sigma(3.0), "PASS")]
    {
        write(dir.path(), "lee-springer", "answer.csv", text(&off_in_a_mean(se, off)));
        let ended = answers(dir.path(), &[]);
        assert_eq!(ended.verdict("lee-springer"), verdict, "{se} {off}: {}", ended.words);
    }
}
