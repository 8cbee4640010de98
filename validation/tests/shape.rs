//! `shearbed shape` as a user meets it.

mod common;

use common::ended;
use std::path::Path;

#[test]
fn every_formula_is_listed_with_its_value_and_source_the_spread_first() {
    let done = ended(Path::new("."), "shape --physical 20");
    assert_eq!(done.code, Some(0), "{}", done.stderr);
    let first = done.stdout.lines().next().unwrap();
    assert_eq!(
        first,
        "a cylinder of r = 20: r_e from 14.096 to 14.328, a spread of 1.6 %"
    );
    for text in [
        "14.160  Goldsmith",
        "14.328  Cox",
        "Harris & Pittman",
        "UNCHECKED",
        "14.096  Zhang",
        "J. Fluid Mech. 45",
    ] {
        assert!(done.stdout.contains(text), "no {text} in {}", done.stdout);
    }
}

#[test]
fn a_formula_without_a_meaning_gives_no_number() {
    let done = ended(Path::new("."), "shape --physical 500");
    assert_eq!(done.code, Some(0));
    assert!(
        done.stdout.contains("none  Goldsmith") && done.stdout.contains("none  Zhang"),
        "{}",
        done.stdout
    );
}

#[test]
fn bad_input_says_what_is_allowed() {
    for bad in [
        "--physical 1",
        "--physical -3",
        "--physical nan",
        "--physical inf",
        "--physical 1001",
        "--physical x",
        "",
    ] {
        let done = ended(Path::new("."), &format!("shape {bad}"));
        assert_eq!(done.code, Some(2), "{bad}");
        let named = if bad.is_empty() {
            "--physical"
        } else {
            "a number from 2 to 1000 is allowed"
        };
        assert!(done.stderr.contains(named), "{bad}: {}", done.stderr);
        assert!(done.stdout.is_empty());
    }
}
