//! `--tolerance X` and `--tolerance NAME=X`.

use crate::{Failure, refuse};
use shearbed_validation::serve::problems::{Kind, LoadedProblem, tolerances};
use std::str::FromStr;

/// A tolerance given by the user.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tolerance {
    /// The problem; none for all problems.
    name: Option<String>,
    value: f64,
}

impl FromStr for Tolerance {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        let (name, number) = match text.split_once('=') {
            Some((name, number)) => (Some(name.trim().to_owned()), number),
            None => (None, text),
        };
        let allowed = |value| value > 0.0 && value <= 10.0;
        let value = crate::number(number, allowed, "a number above 0, at most 10, or NAME=NUMBER,")?;
        Ok(Self { name, value })
    }
}

/// The problems with the user's tolerances; one for a named problem has priority over one for all. A tolerance for all
/// does not apply to ensembles, which count standard errors, and never lowers a problem's own.
pub(super) fn with(given: &[Tolerance], problems: Vec<LoadedProblem>) -> Result<Vec<LoadedProblem>, Failure> {
    let known = |name: &String| problems.iter().any(|loaded| loaded.problem.name == *name);
    refuse(given.iter().filter_map(|tolerance| tolerance.name.as_ref()).find(|name| !known(name)), |name| {
        format!("--tolerance {name}=...: no problem of this name is graded")
    })?;
    problems.into_iter().map(|loaded| one(given, loaded)).collect()
}

fn one(given: &[Tolerance], loaded: LoadedProblem) -> Result<LoadedProblem, Failure> {
    let (name, kind, own) = (&loaded.problem.name, loaded.problem.kind, loaded.own_tolerance);
    let of = |name: Option<&String>| given.iter().rev().find(|tolerance| tolerance.name.as_ref() == name);
    let all = of(None).filter(|_| kind != Kind::Ensemble);
    let Some(Tolerance { name: named, value }) = of(Some(name)).or(all) else {
        return Ok(loaded);
    };
    let value = *value;
    let [_, most] = tolerances(kind);
    let allowed = match named {
        Some(_) if value < own => format!(
            "its own tolerance is {own:e}, which a right code in double precision reaches; at least that is allowed"
        ),
        _ if value > most => format!("{most} at most is allowed: with more, wrong answers would pass"),
        _ => return Ok(loaded.with_tolerance(value, "--tolerance")),
    };
    Err(Failure::Input(format!("--tolerance {value:e} for {name}: {allowed}")))
}
