//! A case as a row of the report: every number with the bound it was judged by.

use super::formats::{bounds, detail};
use crate::files::text;
use crate::judge::accept::{Rule, Verdict};
use crate::judge::case::{Control, Effort, GATE_SEED, Judged, Judges, Outcome};
use serde::Serialize;

/// What one rule said.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// What was measured.
    pub what: String,
    /// How it ended.
    pub verdict: Verdict,
    /// The error; for a goodness-of-fit test, its p-value.
    pub error: f64,
    /// The largest error allowed; for a p-value, the smallest allowed.
    pub tolerance: f64,
    /// The share of the tolerance that is used up: above 1 fails.
    pub used: f64,
    /// Why that tolerance; for missing data, how to supply them.
    pub because: String,
    /// The rule with the numbers behind it.
    pub judged_by: Rule,
}

impl Line {
    fn new(judged: &Judged) -> Self {
        let rule = &judged.evidence.rule;
        let (error, tolerance) = (rule.error(), rule.tolerance());
        let used = match rule {
            _ if error == 0.0 && tolerance == 0.0 => 0.0,
            Rule::PValue { .. } => tolerance / error,
            // The mean must exceed the bound: what is not above 0 has used up all of it.
            Rule::Above { .. } if error <= 0.0 => f64::INFINITY,
            Rule::Above { .. } => tolerance.max(0.0) / error,
            _ => error / tolerance,
        };
        Self {
            what: judged.evidence.what.clone(),
            verdict: judged.verdict,
            error,
            tolerance,
            used,
            because: rule.because().into(),
            judged_by: rule.clone(),
        }
    }

    /// The error against its bound, with what is behind them, in words.
    pub fn numbers(&self) -> String {
        let (error, tolerance) = bounds(self);
        match detail(&self.judged_by) {
            detail if detail.is_empty() => format!("{error}, allowed {tolerance}"),
            detail => format!("{error}, allowed {tolerance} ({detail})"),
        }
    }

    /// Worse verdicts first, then what is nearest to its bound; what cannot be compared is worst.
    fn badness(&self) -> (u8, f64) {
        let used = if self.used.is_nan() { f64::INFINITY } else { self.used };
        (severity(self.verdict), used)
    }
}

fn severity(verdict: Verdict) -> u8 {
    match verdict {
        Verdict::Fail => 3,
        Verdict::NoData => 2,
        Verdict::Underpowered => 1,
        Verdict::Pass => 0,
    }
}

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseRow {
    /// Its name.
    pub name: String,
    /// What it judges.
    pub judges: Judges,
    /// The claim, in one sentence.
    pub claim: String,
    /// Equations, figures or sections of the paper.
    pub source: String,
    /// How it ended.
    pub verdict: Verdict,
    /// Which line of the evidence is the worst; none where there is no evidence.
    pub worst: Option<usize>,
    /// Everything measured.
    pub evidence: Vec<Line>,
    /// The deliberate mistakes, and whether the check failed on each.
    pub controls: Vec<Control>,
    /// How many were caught.
    pub caught: usize,
    /// Wall time of check and controls.
    pub seconds: f64,
    /// The probability, at most, that correct code turns it red.
    pub false_alarm: f64,
    /// The command that repeats it.
    pub command: String,
}

impl CaseRow {
    /// The outcome of a case that was run with this effort.
    pub(super) fn new(outcome: Outcome, effort: &Effort) -> Self {
        let evidence: Vec<_> = (outcome.evidence.iter()).map(Line::new).collect();
        // The first of equals.
        let worst = (0..evidence.len()).rev().max_by(|a, b| {
            let (a, b) = (evidence[*a].badness(), evidence[*b].badness());
            a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))
        });
        Self {
            name: outcome.about.name.into(),
            judges: outcome.about.judges,
            false_alarm: outcome.false_alarm(),
            claim: outcome.about.claim.into(),
            source: outcome.about.source.into(),
            verdict: outcome.verdict,
            worst,
            evidence,
            caught: outcome.controls.iter().filter(|control| control.caught).count(),
            controls: outcome.controls,
            seconds: outcome.seconds,
            command: command(outcome.about.name, effort),
        }
    }

    /// The worst line of the evidence.
    pub fn worst(&self) -> Option<&Line> {
        self.worst.and_then(|index| self.evidence.get(index))
    }

    /// Why it is red: each rule that did not hold with its numbers, each control that was not caught, and the command.
    /// Nothing where it is not.
    pub fn reasons(&self) -> String {
        let bad = |verdict| matches!(verdict, Verdict::Fail | Verdict::Underpowered);
        let mut text = String::new();
        for line in self.evidence.iter().filter(|line| bad(line.verdict)) {
            let how = match line.verdict {
                Verdict::Fail => "failed",
                _ => "too little data",
            };
            text += &format!("  {how}: {}: {}\n    because: {}\n", line.what, line.numbers(), line.because);
        }
        for control in self.controls.iter().filter(|control| !control.caught) {
            text += &format!(
                "  not caught: the same check passes or breaks on this mistake: {}\n",
                control.mistake
            );
        }
        match text.is_empty() && !bad(self.verdict) {
            true => text,
            false => format!("{}: {}\n{text}  repeat: {}\n", self.name, self.claim, self.command),
        }
    }
}

fn command(name: &str, effort: &Effort) -> String {
    let mut command = format!("cargo run --release -- validate --case {name}");
    if effort.full {
        command += " --full";
    }
    if effort.seed != GATE_SEED {
        command += &format!(" --seed {}", effort.seed);
    }
    if let Some(data) = &effort.data {
        command += &format!(" --data {}", text::command([data]));
    }
    command
}
