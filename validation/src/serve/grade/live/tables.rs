//! Requests for tables, as JSON alone: rows of a formula, and a tensor at the times of a problem.

use crate::methods::integrators::Setting;
use crate::serve::grade::Axes;
use crate::serve::problems::{Kind, LoadedProblem, Problem};
use serde_json::{Value, json};

/// True if a program that runs can be asked about this problem: rods, formulas, and a_ij from an a_ij(0).
pub fn can_be_asked(problem: &Problem) -> bool {
    match problem.kind {
        Kind::Rods | Kind::Formula => true,
        Kind::Tensor => problem.is_diffusive() && !problem.is_steady(),
        Kind::Contact | Kind::Ensemble => false,
    }
}

/// The rows of `inputs.csv` with the names of their columns, and the columns that are asked for.
pub(super) fn of_formula(loaded: &LoadedProblem) -> Value {
    let rows: Vec<_> = loaded.inputs.iter().flat_map(|inputs| inputs.rows.iter().map(|row| &row[1..])).collect();
    let columns = loaded.problem.input_columns().unwrap_or_default();
    json!({
        "formula": loaded.problem.formula,
        "columns": columns.get(1..),
        "rows": rows,
        "answer": loaded.problem.columns[1..],
    })
}

/// The equation, the start and the times, in the program's axes; `tensor` is null where the distribution itself is
/// asked for.
pub(super) fn of_tensor(problem: &Problem, setting: Setting, axes: Axes) -> Value {
    let mut request = json!({
        "tensor": problem.closed.map(|closed| json!({ "closure": closed.closure, "model": closed.model })),
        "c_i": problem.c_i,
        "d_r_per_s": problem.d_r_per_s,
        "gradient_per_s": axes.tensor_to_theirs(problem.gradient_per_s),
        "aspect_ratio": problem.aspect_ratio,
        "start": axes.tensor_to_theirs(problem.start_tensor()),
        "times_s": problem.times_s,
        "answer": problem.columns[1..],
    });
    if let Some(period_s) = problem.oscillation_period_s {
        request["oscillation_period_s"] = period_s.into();
    }
    if let Ok(steps) = setting.steps() {
        request["steps"] = steps.into();
    }
    if let Ok(tolerance) = setting.tolerance() {
        request["tolerance"] = tolerance.into();
    }
    request
}
