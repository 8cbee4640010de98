//! What a case judges.

use serde::Serialize;

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
