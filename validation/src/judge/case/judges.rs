//! The kinds of implementations that cases judge.

use serde::Serialize;

/// The kind of implementation that a case judges. Verification asks if the equations are solved right; validation asks,
/// by measurements, if they are the right equations. Tests of our own choices or of the paper's sentences are neither.
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
    /// Validation: the model against measured points. If these are too few to catch a control, it is not the code's
    /// fault, and the case is underpowered.
    Measurement,
}

impl Judges {
    /// All kinds, in the order of the report's counts.
    pub const ALL: [Self; 7] = [
        Self::Core,
        Self::Program,
        Self::Integrator,
        Self::Oracle,
        Self::Interpretation,
        Self::Statement,
        Self::Measurement,
    ];

    /// One word for `validate --tag`.
    pub fn tag(self) -> &'static str {
        self.words()[0]
    }

    /// The plural for the report's headline.
    pub fn name(self) -> &'static str {
        self.words()[1]
    }

    /// The heading of its cases.
    pub(crate) fn title(self) -> &'static str {
        self.words()[2]
    }

    fn words(self) -> [&'static str; 3] {
        match self {
            Self::Core => ["core", "core", "Verification of the core"],
            Self::Program => ["program", "program", "Verification of the program"],
            Self::Integrator => ["integrator", "integrators", "Integrators"],
            Self::Oracle => ["oracle", "oracles", "Oracles and the paper’s formulas"],
            Self::Interpretation => ["interpretation", "interpretations", "Open choices of the model"],
            Self::Statement => ["statement", "paper's statements", "The paper’s statements"],
            Self::Measurement => ["measurement", "measured points", "Measured points"],
        }
    }
}
