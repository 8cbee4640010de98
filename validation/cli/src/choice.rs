//! The choice of cases for `validate`: by name, by tag, or all.

use super::{Failure, refuse};
use shearbed::plan::counted;
use shearbed_validation::cases;
use shearbed_validation::input::scenes::near;
use shearbed_validation::judge::case::Case;

/// The cases with these names and tags in the order of the registry; all cases if both lists are empty.
pub(super) fn chosen(names: &[String], tags: &[String]) -> Result<Vec<Case>, Failure> {
    let mut all = cases::all();
    let known: Vec<_> = all.iter().map(|case| case.about.name.to_owned()).collect();
    refuse(names.iter().find(|name| !known.contains(name)), |name| {
        unknown("--case", name, "no case has this name", &known, LIST)
    })?;
    let mut known: Vec<String> = all.iter().flat_map(|case| case.about.tags()).collect();
    known.sort();
    known.dedup();
    refuse(tags.iter().find(|tag| !known.contains(tag)), |tag| {
        unknown("--tag", tag, "no case has this tag", &known, LIST)
    })?;
    let tagged = |case: &Case| case.about.tags().iter().any(|tag| tags.contains(tag));
    let named = |case: &Case| names.iter().any(|name| name == case.about.name);
    all.retain(|case| (names.is_empty() && tags.is_empty()) || named(case) || tagged(case));
    Ok(all)
}

/// The command that lists the cases.
const LIST: &str = "shearbed validate --list";

/// Why a word after a flag is refused that is none of the `known` ones, all of which `list` prints.
pub(super) fn unknown(flag: &str, word: &str, what: &str, known: &[String], list: &str) -> String {
    let near = near(word, known.iter().map(String::as_str));
    let suggested = match near.split_first() {
        None => ".".to_owned(),
        Some((nearest, [])) => format!("; did you mean {nearest}?"),
        Some((nearest, rest)) => format!("; did you mean {nearest}? Others that are near: {}.", rest.join(", ")),
    };
    format!("{flag} {word}: {what}{suggested} `{list}` has all")
}

/// The list of cases: name and tags, then the claim on a line of its own.
pub(super) fn list(cases: &[Case]) -> String {
    let line = |case: &Case| {
        let about = &case.about;
        format!("{:<28} [{}]\n    {}\n", about.name, about.tags().join(" "), about.claim)
    };
    let (lines, count) = (cases.iter().map(line).collect::<String>(), counted(cases.len() as u64, "case"));
    format!("{lines}\n{count}. Tags: what a case judges, and the equations that it tests.\n")
}
