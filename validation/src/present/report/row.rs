//! A case as a row of the report: every number with the bound it was judged by.

use super::formats::{bounds, detail};
use crate::files::text;
use crate::judge::accept::{Rule, Verdict};
use crate::judge::case::{Control, Effort, GATE_SEED, Judged, Judges, Outcome};
use serde::Serialize;

/// The result of one rule.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Line {
    /// The measured quantity.
    pub what: String,
    /// The unit of error and tolerance; `–` for a number without one.
    pub unit: String,
    /// The verdict of the rule.
    pub verdict: Verdict,
    /// The error; for a goodness-of-fit test, its p-value.
    pub error: f64,
    /// The largest error allowed; for a p-value, the smallest allowed.
    pub tolerance: f64,
    /// The used share of the tolerance; above 1 the rule fails.
    pub used: f64,
    /// The reason for the tolerance; for missing data, how to supply them.
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
            // The mean must exceed the bound: a mean that is not above 0 has used up the whole tolerance.
            Rule::Above { .. } if error <= 0.0 => f64::INFINITY,
            Rule::Above { .. } => tolerance.max(0.0) / error,
            _ => error / tolerance,
        };
        Self {
            what: judged.evidence.what.clone(),
            unit: judged.evidence.unit.to_string(),
            verdict: judged.verdict,
            error,
            tolerance,
            used,
            because: rule.because().into(),
            judged_by: rule.clone(),
        }
    }

    /// The error against its bound, with the numbers behind them, in words.
    pub fn numbers(&self) -> String {
        let (error, tolerance) = bounds(self);
        let unit = self.spaced_unit();
        match detail(&self.judged_by) {
            detail if detail.is_empty() => format!("{error}, allowed {tolerance}{unit}"),
            detail => format!("{error}, allowed {tolerance}{unit} ({detail})"),
        }
    }

    /// The error beside its bound, for a row of the report.
    pub(super) fn size(&self) -> String {
        let (error, tolerance) = bounds(self);
        let unit = self.spaced_unit();
        match self.judged_by {
            Rule::PValue { .. } | Rule::Above { .. } => format!("{error} ({tolerance}){unit}"),
            // A count or a difference of bits: "0 of 0" would say nothing.
            _ if self.tolerance == 0.0 => format!("{error}{unit} (must be 0)"),
            _ => format!("{error} of {tolerance}{unit}"),
        }
    }

    /// The unit behind a space; nothing for a number without one.
    fn spaced_unit(&self) -> String {
        if self.unit == "–" { String::new() } else { format!(" {}", self.unit) }
    }

    /// Sorts worse verdicts first, then cases nearer to their bounds; NaN is worst.
    fn badness(&self) -> (Option<usize>, f64) {
        // A line without data says nothing beside one with data.
        const FROM_BEST: [Verdict; 4] = [Verdict::NoData, Verdict::Pass, Verdict::Underpowered, Verdict::Fail];
        let used = if self.used.is_nan() { f64::INFINITY } else { self.used };
        (FROM_BEST.iter().position(|verdict| *verdict == self.verdict), used)
    }
}

/// One case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct CaseRow {
    /// Name of the case.
    pub name: String,
    /// The kind of implementation that it judges.
    pub judges: Judges,
    /// The claim, in one sentence.
    pub claim: String,
    /// Equations, figures or sections of the paper.
    pub source: String,
    /// The verdict of the case.
    pub verdict: Verdict,
    /// Index of the worst line of evidence; `None` without evidence.
    pub worst: Option<usize>,
    /// All evidence.
    pub evidence: Vec<Line>,
    /// The deliberate mistakes, and the result of the check on each.
    pub controls: Vec<Control>,
    /// Number of mistakes that were caught.
    pub caught: usize,
    /// Wall time of check and controls in s.
    pub seconds: f64,
    /// The largest probability that correct code fails the case.
    pub false_alarm: f64,
    /// The command that repeats the case.
    pub command: String,
}

impl CaseRow {
    /// The row for the outcome of a case that was run with `effort`.
    pub(super) fn new(outcome: Outcome, effort: &Effort) -> Self {
        let evidence: Vec<_> = (outcome.evidence.iter()).map(Line::new).collect();
        // Of several equally bad lines, the first.
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

    /// Why the case is not passed: rules that do not hold with their numbers, controls that were not caught, and the
    /// command; empty for a passing case.
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
            text += &format!("  not caught: the same check passes or breaks on this mistake: {}\n", control.mistake);
        }
        if text.is_empty() && !bad(self.verdict) {
            text
        } else {
            format!("{}: {}\n{text}  repeat: {}\n", self.name, self.claim, self.command)
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
