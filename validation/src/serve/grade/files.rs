//! Verdicts on answers in files.

use super::answer::{Answer, keys_of};
use super::compare::{compare, worst_entry};
use super::digits;
use super::lammps;
use super::layout::FileOptions;
use super::live::converging;
use super::order;
use super::read::{self, read};
use super::report::joined;
use super::slips;
use super::{Graded, Verdict};
use crate::files::text::Shown;
use crate::files::{FileError, entries};
use crate::serve::problems::{Kind, LoadedProblem, Metric};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Options for reading and judging answers.
#[derive(Clone, Debug, Default)]
pub struct Options {
    /// The form of the answer files.
    pub file: FileOptions,
    /// Information that a LAMMPS dump lacks.
    pub dump: lammps::DumpOptions,
    /// The order with which the user claims that the error falls with the step.
    pub order: Option<f64>,
}

/// Grades the answers in `mine/NAME/` to each problem. A file that cannot be read fails its problem.
pub fn grade(problems: &[LoadedProblem], mine: &Path, options: &Options) -> Vec<Graded> {
    let of = |problem: &LoadedProblem| {
        grade_one(problem, &mine.join(&problem.problem.name), options).unwrap_or_else(|error| {
            let note = Some(error.to_string());
            Graded { verdict: Verdict::Fail, note, ..Graded::without_answer(problem) }
        })
    };
    let mut all: Vec<_> = problems.iter().map(of).collect();
    order::settle(problems, &mut all, options.order);
    all
}

const ENDINGS: [&str; 5] = ["csv", "txt", "dat", "dump", "lammpstrj"];

/// The file of a single answer, and those for each number of steps.
fn find(dir: &Path) -> Result<(Option<PathBuf>, BTreeMap<u64, PathBuf>), FileError> {
    let (mut answer, mut ladder) = (None::<PathBuf>, BTreeMap::new());
    if !dir.exists() {
        return Ok((answer, ladder));
    }
    for path in entries(dir)? {
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let stem = path.file_stem().and_then(|stem| stem.to_str()).unwrap_or_default();
        if !ENDINGS.contains(&ending) {
            continue;
        }
        if stem == "answer" {
            if let Some(other) = &answer {
                let message = format!("there is {} too; one of them is allowed", other.shown());
                return Err(FileError::whole(&path, message));
            }
            answer = Some(path);
        } else if let Some(number) = stem.strip_prefix("steps-") {
            match number.parse() {
                Ok(steps @ 1..) if !ladder.contains_key(&steps) => ladder.insert(steps, path),
                _ => {
                    let message = format!("steps-{number}: a whole number from 1 is allowed, once each");
                    return Err(FileError::whole(&path, message));
                }
            };
        }
    }
    Ok((answer, ladder))
}

/// Grades the answer in the folder `dir` to one problem.
///
/// # Errors
///
/// A file that cannot be read: file, line and column.
pub fn grade_one(loaded: &LoadedProblem, dir: &Path, options: &Options) -> Result<Graded, FileError> {
    let (single, by_steps) = find(dir)?;
    let mut paths = single.iter().chain(by_steps.values());
    // A closed equation has no random answer.
    let may_scatter = loaded.problem.kind == Kind::Tensor && loaded.problem.closed.is_none();
    let scattered = may_scatter && paths.any(|path| read::has_errors(path, &options.file));
    let scattered = scattered.then(|| loaded.with_standard_errors());
    let loaded = scattered.as_ref().unwrap_or(loaded);
    let read = |path: &PathBuf| read(path, loaded, &options.file, &options.dump);
    let answers = by_steps.iter().map(|(steps, path)| Ok((*steps, read(path)?)));
    let answers = answers.collect::<Result<Vec<_>, FileError>>()?;
    let errors: Vec<_> = answers.iter().map(|(steps, answer)| (*steps, compare(loaded, answer).error)).collect();
    let ladder = answers.iter().zip(errors.clone()).map(|((steps, answer), (_, error))| (*steps, error, answer));
    let mut finest = answers.last().map(|(steps, answer)| (Some(*steps), answer.clone()));
    // A file without steps is the answer; the others only give the order.
    if let Some(path) = &single {
        finest = Some((None, read(path)?));
    }
    let mut graded = Graded::without_answer(loaded);
    let Some((steps, answer)) = finest else {
        graded.note = Some(format!("no answer.csv and no steps-N.csv in {}", dir.shown()));
        return Ok(graded);
    };
    graded.set_orders(errors, loaded, options.order);
    graded.steps = steps;
    judge(&mut graded, loaded, &answer, options.order);
    slips::name(&mut graded, loaded, options.order, ladder);
    let refuted = graded.order_off(options.order).is_some();
    let fails = graded.verdict == Verdict::Fail && steps.is_some() && !refuted;
    if let Some(words) = fails.then(|| converging(loaded, &answers)).flatten() {
        (graded.verdict, graded.note) = (Verdict::Pass, Some(words));
    }
    Ok(graded)
}

/// Sets the verdict on `answer` and the reasons in `graded`.
pub(super) fn judge(graded: &mut Graded, loaded: &LoadedProblem, answer: &Answer, claimed: Option<f64>) {
    let compared = compare(loaded, answer);
    let within = compared.error <= loaded.problem.tolerance && !compared.too_little_data;
    // Standard errors scatter.
    let exact = loaded.problem.metric != Metric::StandardErrors;
    // An error that is allowed may be rounding, which grows with the steps.
    let outlier = exact.then(|| order::outlier(&graded.errors, loaded.problem.tolerance)).flatten();
    let off = graded.order_off(claimed).or(outlier);
    graded.verdict = if within && off.is_none() { Verdict::Pass } else { Verdict::Fail };
    graded.set_answer(loaded, answer, &compared, f64::INFINITY);
    let digits = digits::remark(answer, compared.error, graded.steps).filter(|_| !compared.too_little_data);
    graded.note = if within {
        off.map(|off| joined([Some(off), digits]))
    } else {
        let worst = place(loaded, answer, compared.row);
        let place = match compared.remark {
            None => format!("{worst}, in {}", answer.place(compared.row)),
            // An answer with too little data may be wrong beyond doubt all the same.
            Some(remark) if compared.error <= loaded.problem.tolerance || compared.error.is_nan() => remark,
            Some(remark) => format!("{remark}; {worst}"),
        };
        let needed = graded.steps_needed().filter(|_| off.is_none());
        Some(joined([off, needed, Some(place), digits]))
    };
}

/// The place of the largest error, in words, and the component there.
pub(super) fn place(loaded: &LoadedProblem, answer: &Answer, row: usize) -> String {
    let unit = match loaded.problem.metric {
        Metric::Angle => "rad",
        Metric::Absolute => "absolute",
        Metric::Relative => "relative",
        Metric::StandardErrors => "standard errors",
    };
    let entry = worst_entry(loaded, answer, row).map_or(String::new(), |entry| format!(": {entry}"));
    format!("worst ({unit}) at {}{entry}", keys_of(loaded, row))
}
