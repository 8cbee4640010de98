//! A case: one claim, the check that tests it, and the controls that the same check must fail.

use crate::accept::{Design, MISS, Rule, Text, Verdict, judge};
use serde::{Deserialize, Serialize};
use std::path::PathBuf;
use std::time::Instant;

/// What a case judges. Verification asks whether the equations are solved right; validation, whether they are the right
/// equations, by measurements. What tests our own choices or the paper's sentences is neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Judges {
    /// Verification of the simulator's core: closed forms, orders, invariants.
    Core,
    /// Verification of whole runs and of the program: files, errors, statistics, refusals.
    Program,
    /// Verification of an integrator, or of a claim about integrators.
    Integrator,
    /// Verification of an oracle, or of a misprint that it corrects.
    Oracle,
    /// A modelling choice where the paper is open: what the alternatives change.
    Interpretation,
    /// A sentence of the paper about its model's results.
    Statement,
    /// Validation: the model against measured points.
    Measurement,
}

impl Judges {
    /// All, in the order in which they are counted.
    pub const ALL: [Self; 7] = [
        Self::Core,
        Self::Program,
        Self::Integrator,
        Self::Oracle,
        Self::Interpretation,
        Self::Statement,
        Self::Measurement,
    ];

    /// In one word, as `validate --tag` takes it.
    pub fn tag(self) -> &'static str {
        match self {
            Self::Core => "core",
            Self::Program => "program",
            Self::Integrator => "integrator",
            Self::Oracle => "oracle",
            Self::Interpretation => "interpretation",
            Self::Statement => "statement",
            Self::Measurement => "measurement",
        }
    }

    /// In words, as the headline counts them.
    pub fn name(self) -> &'static str {
        match self {
            Self::Core => "core",
            Self::Program => "program",
            Self::Integrator => "integrators",
            Self::Oracle => "oracles",
            Self::Interpretation => "interpretations",
            Self::Statement => "paper's statements",
            Self::Measurement => "measured points",
        }
    }
}

/// One number and the rule it is judged by.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Evidence {
    /// What was measured, in a few words.
    pub what: String,
    /// How it is judged.
    pub rule: Rule,
}

impl Evidence {
    /// `rule` applied to what `what` says.
    pub fn new(what: impl Into<String>, rule: Rule) -> Self {
        Self {
            what: what.into(),
            rule,
        }
    }
}

/// How hard a case works, and from which random streams.
#[derive(Clone, Debug)]
pub struct Effort {
    /// More replicas and samples, the same cases.
    pub full: bool,
    /// The seed from which every case takes its seeds.
    pub seed: u64,
    /// A folder with measured points, where the user has them.
    pub data: Option<PathBuf>,
}

/// The seed of the gate.
pub const GATE_SEED: u64 = 1;

impl Effort {
    /// That of `cargo test`.
    pub fn gate() -> Self {
        Self {
            full: false,
            seed: GATE_SEED,
            data: None,
        }
    }

    /// `quick` for the gate, `full` for `--full`.
    pub fn pick<T>(&self, quick: T, full: T) -> T {
        if self.full { full } else { quick }
    }

    /// The values that a sample needs; four times as many in a full run.
    pub fn samples(&self, design: Design) -> u64 {
        self.pick(1, 4) * design.samples()
    }

    /// The seed of one of a case's streams: another for every `stream` and every seed of the run.
    pub fn seed(&self, stream: u64) -> u64 {
        // SplitMix64's output function on both; 63 bits, as scenes allow.
        let mix = |z: u64| {
            let z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
            let z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
            z ^ (z >> 31)
        };
        const STEP: u64 = 0x9E37_79B9_7F4A_7C15;
        mix(mix(self.seed.wrapping_add(STEP)) ^ stream.wrapping_add(STEP)) >> 1
    }
}

type Check = Box<dyn Fn(&Effort) -> Vec<Evidence> + Send + Sync>;

/// What a case says of itself.
#[derive(Clone, Copy, Debug, PartialEq, Serialize)]
pub struct About {
    /// Its name, in words joined by `-`.
    pub name: &'static str,
    /// What it judges.
    pub judges: Judges,
    /// The claim, in one sentence.
    pub claim: &'static str,
    /// Equations, figures or sections of the paper, in words.
    pub source: &'static str,
    /// The equations it tests, by their numbers: the traceability table is made from these.
    pub equations: &'static [&'static str],
}

impl About {
    /// What it can be chosen by: what it judges, and its equations as `eq-15`.
    pub fn tags(&self) -> Vec<String> {
        let equations = self.equations.iter().map(|number| format!("eq-{number}"));
        std::iter::once(self.judges.tag().to_owned())
            .chain(equations)
            .collect()
    }
}

/// One claim with its check and its controls.
pub struct Case {
    /// What it says of itself.
    pub about: About,
    check: Check,
    controls: Vec<(&'static str, Check)>,
    /// What a control that was not caught makes of a case whose evidence passes.
    uncaught: Verdict,
}

impl Case {
    /// A case whose `check` judges `subject`; the very same `check` must fail on each of `broken`.
    pub fn new<S: Send + Sync + 'static>(
        about: About,
        subject: S,
        broken: Vec<(&'static str, S)>,
        check: fn(&S, &Effort) -> Vec<Evidence>,
    ) -> Self {
        let bind = |subject: S| -> Check { Box::new(move |effort| check(&subject, effort)) };
        Self {
            about,
            check: bind(subject),
            controls: broken
                .into_iter()
                .map(|(name, subject)| (name, bind(subject)))
                .collect(),
            uncaught: Verdict::Fail,
        }
    }

    /// The same case on points that others measured: where they are too few to catch a control, that is no
    /// fault of the code, and the case is under-powered.
    pub fn on_measured_points(mut self) -> Self {
        self.uncaught = Verdict::Underpowered;
        self
    }

    /// Runs the check, then every control. Without data there is nothing that a control could fail on.
    pub fn run(&self, effort: &Effort) -> Outcome {
        let start = Instant::now();
        let evidence: Vec<_> = (self.check)(effort).into_iter().map(Judged::new).collect();
        let no_data = evidence.iter().any(|judged| judged.verdict == Verdict::NoData);
        let controls: Vec<_> = self
            .controls
            .iter()
            .filter(|_| !no_data)
            .map(|(mistake, check)| Control::new(mistake, &check(effort)))
            .collect();
        Outcome {
            about: self.about,
            verdict: overall(&evidence, &controls, self.uncaught),
            evidence,
            controls,
            seconds: start.elapsed().as_secs_f64(),
        }
    }
}

/// A case passes when all its evidence does and every control was caught.
fn overall(evidence: &[Judged], controls: &[Control], uncaught: Verdict) -> Verdict {
    let has = |verdict| evidence.iter().any(|judged| judged.verdict == verdict);
    if has(Verdict::NoData) {
        Verdict::NoData
    } else if evidence.is_empty() || has(Verdict::Fail) || controls.is_empty() {
        Verdict::Fail
    } else if controls.iter().any(|control| !control.caught) {
        uncaught
    } else if has(Verdict::Underpowered) {
        Verdict::Underpowered
    } else {
        Verdict::Pass
    }
}

/// Evidence with its verdict.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Judged {
    /// The evidence.
    pub evidence: Evidence,
    /// How it ended.
    pub verdict: Verdict,
}

impl Judged {
    fn new(evidence: Evidence) -> Self {
        let verdict = judge(&evidence.rule);
        Self { evidence, verdict }
    }
}

/// A deliberate mistake and whether the check failed on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Control {
    /// The mistake in the model.
    pub mistake: Text,
    /// Whether the check failed, as it must, on numbers.
    pub caught: bool,
    /// Whether it was caught by drawn numbers alone, so that it could be missed at another seed.
    pub drawn: bool,
    /// By how many standard deviations the surest of its rules failed ([`Rule::margin`]).
    pub margin: Option<f64>,
}

impl Control {
    /// A check that ends in no numbers has broken, and has caught nothing.
    fn new(mistake: &'static str, evidence: &[Evidence]) -> Self {
        let broke = evidence.iter().any(|e| e.rule.error().is_nan());
        let failed: Vec<_> = (evidence.iter().map(|e| &e.rule))
            .filter(|rule| !broke && judge(rule) == Verdict::Fail)
            .collect();
        let drawn = failed.iter().all(|rule| rule.is_statistical());
        Self {
            mistake: mistake.into(),
            caught: !failed.is_empty(),
            drawn,
            margin: (failed.iter().filter(|_| drawn))
                .filter_map(|rule| rule.margin())
                .reduce(f64::max),
        }
    }
}

/// The outcome of a case.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Outcome {
    /// Which case.
    pub about: About,
    /// How it ended.
    pub verdict: Verdict,
    /// Everything measured.
    pub evidence: Vec<Judged>,
    /// Every control.
    pub controls: Vec<Control>,
    /// Wall time of check and controls.
    pub seconds: f64,
}

impl Outcome {
    /// The probability, at most, that correct code turns this case red: its checks, and a control that is not caught.
    pub fn false_alarm(&self) -> f64 {
        if self.verdict == Verdict::NoData {
            return 0.0;
        }
        let rules = || self.evidence.iter().map(|judged| &judged.evidence.rule);
        let checks: f64 = rules().map(Rule::false_alarm).sum();
        // What is sized for a control misses it with this probability at most.
        checks + MISS * self.controls.iter().filter(|control| control.drawn).count() as f64
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn about() -> About {
        About {
            name: "a",
            judges: Judges::Core,
            claim: "c",
            source: "s",
            equations: &[],
        }
    }

    fn is_three(subject: &f64, _: &Effort) -> Vec<Evidence> {
        vec![Evidence::new("three", Rule::exact(*subject - 3.0))]
    }

    const EFFORT: Effort = Effort {
        full: false,
        seed: GATE_SEED,
        data: None,
    };

    #[test]
    fn a_case_passes_only_with_its_controls_caught() {
        let verdict = |subject, broken| Case::new(about(), subject, broken, is_three).run(&EFFORT).verdict;
        assert_eq!(verdict(3.0, vec![("four", 4.0)]), Verdict::Pass);
        assert_eq!(verdict(4.0, vec![("four", 4.0)]), Verdict::Fail);
        assert_eq!(
            verdict(3.0, vec![("four", 4.0), ("not broken", 3.0)]),
            Verdict::Fail
        );
        assert_eq!(
            verdict(3.0, vec![]),
            Verdict::Fail,
            "a case without a control is no case"
        );
        assert_eq!(verdict(f64::NAN, vec![("four", 4.0)]), Verdict::Fail);
        assert_eq!(
            verdict(3.0, vec![("no number", f64::NAN)]),
            Verdict::Fail,
            "a check that breaks has caught nothing"
        );
    }
}
