//! Tests the writers on made-up outcomes of every verdict. Nothing here was measured.

mod page;
mod synthetic;

use super::*;
use crate::input::experiment::Stated;
use crate::judge::accept::{LEVEL, Rule, judge};
use crate::judge::case::{About, Control, Evidence, GATE_SEED, Judged, Judges};
use crate::present::plot::{Curve, Figure};
use crate::present::study::Exhibit;
use crate::present::table::{number, words};
use crate::present::xml::is_well_formed;
use synthetic::synthetic;

const EFFORT: Effort = Effort { full: false, seed: GATE_SEED, data: None };

fn outcome(name: &'static str, verdict: Verdict, rules: Vec<Rule>, controls: &[(&'static str, bool)]) -> Outcome {
    let judged = |(k, rule): (usize, Rule)| {
        let unit = if matches!(rule, Rule::PValue { .. } | Rule::NoData { .. }) { "–" } else { "rad" };
        let verdict = judge(&rule);
        Judged { verdict, evidence: Evidence::new(format!("synthetic number {k} with a < b & c"), unit, rule) }
    };
    Outcome {
        about: About {
            name,
            judges: match verdict {
                Verdict::Pass | Verdict::Fail => Judges::Core,
                _ => Judges::Measurement,
            },
            claim: "Synthetic claim: <b>|p₁|</b> & more.",
            source: "eqs A.4, A.5",
            equations: Vec::new(),
        },
        verdict,
        evidence: rules.into_iter().enumerate().map(judged).collect(),
        controls: (controls.iter())
            .map(|&(mistake, caught)| Control { mistake: mistake.into(), caught, drawn: false, margin: None })
            .collect(),
        seconds: 1.25,
    }
}

fn mean(se: f64) -> Rule {
    Rule::Mean {
        mean: 0.5012,
        se,
        samples: 400,
        reference: 0.5,
        allowance: 0.0,
        effect: 0.1,
        because: "synthetic: 2 % of the amplitude".into(),
    }
}

fn p_value(p: f64) -> Rule {
    Rule::PValue {
        p,
        samples: 1000,
        enough: 100,
        level: LEVEL,
        distance: None,
        because: "synthetic: Kolmogorov–Smirnov".into(),
    }
}

#[test]
fn markdown_is_as_before() {
    insta::assert_snapshot!(synthetic().markdown());
}

#[test]
fn counts_and_exit_code() {
    let report = synthetic();
    let summary = &report.summary;
    let counts = (summary.pass, summary.fail, summary.underpowered, summary.nodata);
    assert_eq!(counts, (2, 3, 1, 1));
    assert_eq!(report.exit_code(), 1);
    let only = |verdict| {
        let outcomes = vec![outcome("synthetic", verdict, vec![], &[])];
        build(outcomes, Sections::default(), &EFFORT, String::new()).exit_code()
    };
    let verdicts = [Verdict::Pass, Verdict::Fail, Verdict::Underpowered, Verdict::NoData];
    assert_eq!(verdicts.map(only), [0, 1, 1, 0]);
    assert_eq!(build(vec![], Sections::default(), &EFFORT, String::new()).exit_code(), 0);
}

#[test]
fn a_command_repeats_the_run() {
    let effort = Effort { full: true, seed: GATE_SEED, data: Some("my data".into()) };
    let row = CaseRow::new(outcome("synthetic", Verdict::Pass, vec![], &[]), &effort);
    let command = "cargo run --release -- validate --case synthetic --full --data 'my data'";
    assert_eq!(row.command, command);
}

#[test]
fn the_worst_line_is_the_first_of_the_worst_verdict() {
    let (passes, fails) = (Rule::within(0.9, 1.0, "synthetic"), Rule::within(1.1, 1.0, "synthetic"));
    let none = Rule::NoData { supply: "synthetic".into() };
    for (rules, worst) in [
        (vec![passes.clone(), mean(0.02), mean(0.02)], 1),
        (vec![passes, mean(0.02), none.clone()], 1),
        (vec![none, mean(0.02), fails.clone(), fails], 2),
    ] {
        let row = CaseRow::new(outcome("synthetic", Verdict::Underpowered, rules, &[]), &EFFORT);
        assert_eq!(row.worst, Some(worst));
    }
}

/// Numbers are numbers, NaN is null; the worst line of passing evidence is the one nearest to its bound, of failing
/// evidence the one with NaN.
#[test]
fn json_is_as_before() {
    insta::assert_snapshot!(synthetic().json());
}

#[test]
fn junit_is_as_before() {
    let junit = synthetic().junit();
    assert!(is_well_formed(&junit), "{junit}");
    insta::assert_snapshot!(junit);
}

#[test]
fn a_one_sided_rule_uses_less_of_its_bound_the_farther_it_is() {
    let used = |mean| {
        let rule = Rule::Above { mean, se: 0.0, samples: 100, bound: 0.1, effect: 0.2, because: "synthetic".into() };
        let row = CaseRow::new(outcome("synthetic", Verdict::Pass, vec![rule], &[]), &EFFORT);
        (row.evidence[0].used, row.evidence[0].size())
    };
    assert_eq!(used(0.4).0, 0.25);
    assert_eq!(used(0.05).0, 2.0);
    assert_eq!(used(-0.1).0, f64::INFINITY);
    assert!(used(0.4).1.starts_with("mean 0.4 (> 0.1)"), "{}", used(0.4).1);
}

/// Each difference from what the gate would run counts: other sources, seed, effort or points, or an edited byte.
#[test]
fn only_an_unedited_report_of_these_sources_spares_the_gate_its_passes() {
    let of = |name, verdict, rule| outcome(name, verdict, vec![rule], &[]);
    let made = |effort: &Effort, change: &dyn Fn(&mut Report)| {
        let outcomes = vec![of("good", Verdict::Pass, p_value(0.5)), of("bad", Verdict::Fail, p_value(0.0))];
        let mut report = build(outcomes, Sections::default(), effort, "shearbed validate".into());
        change(&mut report);
        report.json()
    };
    let right = made(&EFFORT, &|_| ());
    assert_eq!(passed(&right), ["good".to_owned()].into());
    for wrong in [
        made(&Effort { seed: 2, ..EFFORT }, &|_| ()),
        made(&Effort { full: true, ..EFFORT }, &|_| ()),
        made(&EFFORT, &|report| report.origin.sources = "0123456789abcdef".into()),
        made(&EFFORT, &|report| report.origin.points.push(Stated::default())),
        right.replace("\"fail\"", "\"pass\""),
        right.replace("\"bad\"", "\"worse\""),
        String::new(),
    ] {
        assert!(passed(&wrong).is_empty(), "{wrong}");
    }
}
