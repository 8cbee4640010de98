//! The grader on codes for orientation tensors and for rods that are right, or wrong in one part: no right one may
//! fail, every wrong one must be caught, and named.
//!
//!     cargo run --example graded_tensors [-- TEXT]
//!
//! grades all of them, or those with TEXT in their name, on formulas and curves and prints the table; as a test it
//! does the same.

mod catalogue;
mod rods;

use catalogue::{WRONG, WRONG_INSIDE, WRONG_MODELS, Wrong};
use rayon::prelude::*;
use shearbed_validation::methods::tensors::Model;
use shearbed_validation::methods::tensors::fourth::PAIRS;
use shearbed_validation::methods::textbook::tensors::{self as code, Code, M};
use shearbed_validation::methods::textbook::tensors::{along, delta, hybrid, iard, ibof, linear, quadratic};
use shearbed_validation::serve::grade::{self, Graded, Options, Verdict};
use shearbed_validation::serve::problems::{self, Formula, LoadedProblem};
use std::array::from_fn;
use std::fs;

const RIGHT: [(&str, code::Closure); 8] = [
    ("ore", code::ore),
    ("ibof", ibof),
    ("linear", linear),
    ("quadratic", quadratic),
    ("hybrid", hybrid),
    ("rsc-ibof", ibof),
    ("iard-ibof", ibof),
    ("pard-ibof", ibof),
];

/// Closures that are asked for in formulas alone.
const FORMULAS_ALONE: [&str; 2] = ["ore", "ibof"];

/// The right code of a closure, or of a model with a closure.
fn right(name: &str, closure: code::Closure) -> Code {
    let anisotropic: Option<code::Diffusivity> = match name {
        "iard-ibof" => Some(|_, d, _, speed, c_m| iard(d, speed, c_m, 4.0)),
        "pard-ibof" => Some(|a, _, _, _, omega| along(a, [1.0, omega, 1.0 - omega])),
        _ => None,
    };
    Code { anisotropic, ..Code::right(closure) }
}

/// The problems of a code with this closure: its rate, its curves, and what it should miss by no more than its closure.
fn problems_of(closure: &str) -> Vec<LoadedProblem> {
    if closure.contains('-') {
        return vec![problems::named(&format!("dadt-{closure}")).expect("a problem").loaded(closure.into())];
    }
    let c_i = if closure == "linear" { "0.1" } else { "0.01" };
    let names = [format!("closure-{closure}"), format!("dadt-ft-{closure}"), format!("closed-ft-{closure}-{c_i}")];
    let further = match closure {
        "hybrid" => &["closed-ft-hybrid-mixed", "closed-ft-hybrid-extension", "folgar-tucker-shear-0.01"][..],
        "quadratic" => &["closed-ft-quadratic-mixed"],
        _ => &[],
    };
    let own = if FORMULAS_ALONE.contains(&closure) { &names[..2] } else { &names[..] };
    let all = own.iter().map(String::as_str).chain(further.iter().copied());
    all.map(|name| problems::named(name).expect("a problem").loaded(name.into())).collect()
}

/// The rows of a code's answer: the components, without times and numbers.
type Rows = Vec<Vec<f64>>;

fn apart(a: &Rows, b: &Rows) -> f64 {
    shearbed_validation::oracle::worst(a.iter().zip(b).map(|(a, b)| shearbed_validation::oracle::apart(a, b)))
}

fn values(code: &Code, loaded: &LoadedProblem, strain: f64) -> Rows {
    let six = |a: &M| (code.written)(PAIRS.map(|(i, j)| a[i][j])).to_vec();
    let matrix = |x: &[f64]| -> M { [[x[0], x[3], x[4]], [x[3], x[1], x[5]], [x[4], x[5], x[2]]] };
    let problem = &loaded.problem;
    let parameters = |model: Model| match model.parameters()[..] {
        [c_i, other] => [c_i, other],
        ref all => [all[0], f64::NAN],
    };
    match (&problem.formula, &loaded.inputs) {
        (Some(Formula::Closure { .. }), Some(inputs)) => {
            inputs.rows.iter().map(|row| code.fourth(&matrix(&row[1..]), PAIRS)).collect()
        }
        (Some(Formula::Dadt { model, .. }), Some(inputs)) => {
            let of = |row: &Vec<f64>| {
                let l: M = from_fn(|i| from_fn(|j| row[7 + 3 * i + j]));
                six(&code.rate(&matrix(&row[1..]), &l, row[16], parameters(*model)))
            };
            inputs.rows.iter().map(of).collect()
        }
        _ => {
            let random: M = from_fn(|i| from_fn(|j| delta(i, j) / 3.0));
            let (start, c_i) = problem
                .closed
                .map_or((random, problem.c_i), |closed| (closed.start, Some(parameters(closed.model)[0])));
            let (l, r, times) = (&problem.gradient_per_s, problem.aspect_ratio, &problem.times_s);
            code.path(&start, l, r, c_i.unwrap_or(f64::NAN), times, strain).iter().map(six).collect()
        }
    }
}

/// The smallest difference that a mistake makes: what steps of 0.04 are off is more.
const DIFFERENCE: f64 = 1e-9;

fn certified(loaded: &LoadedProblem) -> Rows {
    let keys = loaded.problem.kind.keys().len();
    loaded.certified.rows.iter().map(|row| row[keys..].to_vec()).collect()
}

/// The grader on answers in files.
fn graded(problems: &[LoadedProblem], answers: &[Rows]) -> (Vec<Graded>, Vec<String>) {
    let dir = tempfile::tempdir().expect("a folder");
    for (loaded, answer) in problems.iter().zip(answers) {
        let keys = loaded.certified.rows.iter().map(|row| &row[..loaded.problem.kind.keys().len()]);
        let numbers = keys.zip(answer).map(|(keys, row)| [keys, row].concat().iter().map(f64::to_string).collect());
        let lines = numbers.map(|words: Vec<_>| words.join(","));
        let text: Vec<_> = std::iter::once(loaded.problem.columns.join(",")).chain(lines).collect();
        let folder = dir.path().join(&loaded.problem.name);
        fs::create_dir(&folder).expect("a folder");
        fs::write(folder.join("answer.csv"), text.join("\n") + "\n").expect("a file");
    }
    let mut graded = grade::grade(problems, dir.path(), &Options::default());
    let overall = grade::overall(problems, &mut graded);
    (graded, overall)
}

/// Answers with steps of this strain: short ones for a code that is to pass.
fn answers(code: &Code, problems: &[LoadedProblem], strain: f64) -> Vec<Rows> {
    problems.iter().map(|loaded| values(code, loaded, strain)).collect()
}

/// The end of what is said of a code whose mistake is named in several problems and not over all.
const VETOED: &str = "is said over all";

/// One wrong code, of tensors on one closure: how many of its problems are wrong, named right and named wrong, and what
/// was said.
struct Row {
    name: &'static str,
    on: &'static str,
    wrong: usize,
    named: usize,
    said: Vec<String>,
}

/// A closure with its code, its problems, and what the right code answers to them.
struct Setting {
    closure: &'static str,
    right: Code,
    problems: Vec<LoadedProblem>,
    answers: Vec<Rows>,
}

fn settings() -> Vec<Setting> {
    let of = |(closure, fourth): &(&'static str, code::Closure)| {
        let (right, problems) = (right(closure, *fourth), problems_of(closure));
        Setting { closure, answers: answers(&right, &problems, 0.04), right, problems }
    };
    RIGHT.par_iter().map(of).collect()
}

fn judged((name, expected, spoil): &Wrong, setting: &Setting) -> Row {
    let mut code = setting.right.clone();
    spoil(&mut code);
    let mut answers = answers(&code, &setting.problems, 0.04);
    // Where a mistake makes no difference, the answer passes.
    for (loaded, (own, spoilt)) in setting.problems.iter().zip(setting.answers.iter().zip(&mut answers)) {
        if apart(own, spoilt) <= DIFFERENCE {
            *spoilt = certified(loaded);
        }
    }
    let (graded, overall) = graded(&setting.problems, &answers);
    // A mistake that makes no difference, as of Λ where Λ = 1, is none; a value that is not finite has no name.
    let differs = |(found, loaded, spoilt): &(&Graded, &LoadedProblem, &Rows)| {
        found.error.is_some() && apart(&certified(loaded), spoilt) > DIFFERENCE
    };
    let all =
        graded.iter().zip(&setting.problems).zip(&answers).map(|((found, loaded), spoilt)| (found, loaded, spoilt));
    let wrong: Vec<_> = all.filter(differs).map(|(found, ..)| found).collect();
    let names = [expected, "nothing has moved"];
    let is_named =
        |found: &&&Graded| found.diagnosis.as_ref().is_some_and(|said| names.iter().any(|name| said.contains(*name)));
    let missed =
        wrong.iter().filter(|found| found.verdict == Verdict::Pass).map(|found| format!("{} passes", found.name));
    let other = wrong.iter().filter(|found| !is_named(found));
    let other = other.map(|found| format!("{}: {:?}", found.name, found.diagnosis));
    let named = wrong.iter().filter(is_named).count();
    // Passed problems on which the mistake makes no difference speak for no other one.
    let of_one = |found: &&&Graded| found.suspects.iter().any(|name| name.contains(expected));
    let is_vetoed = wrong.iter().filter(of_one).count() > 1 && !overall.iter().any(|said| said.contains(expected));
    Row {
        name,
        on: setting.closure,
        wrong: wrong.len(),
        named,
        said: missed.chain(other).chain(is_vetoed.then(|| format!("{overall:?} {VETOED}"))).collect(),
    }
}

fn all(only: &str, settings: &[Setting]) -> Vec<Row> {
    let of_one = WRONG_MODELS.iter().chain(WRONG_INSIDE).filter_map(|(model, wrong)| {
        settings.iter().find(|setting| setting.closure == *model).map(|setting| (wrong, setting))
    });
    // Saves time: these closures are slow in a code that is not optimised, and have mistakes of their own.
    let others = || settings.iter().filter(|setting| !FORMULAS_ALONE.contains(&setting.closure));
    let each = WRONG.iter().flat_map(|wrong| others().map(move |setting| (wrong, setting))).chain(of_one);
    let each: Vec<_> = each.filter(|((name, ..), _)| name.contains(only)).collect();
    each.into_par_iter().map(|(wrong, setting)| judged(wrong, setting)).collect()
}

fn sum(rows: &[Row], of: fn(&Row) -> usize) -> usize {
    rows.iter().map(of).sum()
}

fn main() {
    let only = std::env::args().nth(1).unwrap_or_default();
    let rows: Vec<_> = rods::all(&only).into_iter().chain(all(&only, &settings())).collect();
    for row in &rows {
        println!("{} ({}): {} of {} named", row.name, row.on, row.named, row.wrong);
        row.said.iter().for_each(|said| println!("    {said}"));
    }
    println!("{} wrong answers, {} named", sum(&rows, |row| row.wrong), sum(&rows, |row| row.named));
}

#[test]
fn right_codes_pass_and_wrong_ones_are_caught_and_named() {
    let settings = settings();
    for Setting { closure, problems, right, .. } in &settings {
        let own = |loaded: &&LoadedProblem| loaded.problem.c_i.is_none();
        let problems: Vec<_> = problems.iter().filter(own).cloned().collect();
        let (graded, overall) = graded(&problems, &answers(right, &problems, 0.005));
        for graded in &graded {
            assert!(graded.verdict == Verdict::Pass && graded.diagnosis.is_none(), "{closure} {graded:?}");
        }
        assert_eq!(overall, [""; 0]);
    }
    let rows = all("", &settings);
    let (wrong, named) = (sum(&rows, |row| row.wrong), sum(&rows, |row| row.named));
    let said: Vec<_> =
        rows.iter().flat_map(|row| row.said.iter().map(|said| format!("{} ({}): {said}", row.name, row.on))).collect();
    assert!(said.iter().all(|said| !said.ends_with("passes") && !said.ends_with(VETOED)), "{said:#?}");
    assert!(wrong > 750 && named as f64 >= 0.99 * wrong as f64, "{named} of {wrong}: {said:#?}");
    let mistakes = WRONG.iter().chain(WRONG_MODELS.iter().chain(WRONG_INSIDE).map(|(_, wrong)| wrong));
    for (mistake, ..) in mistakes {
        let of = rows.iter().filter(|row| row.name == *mistake);
        assert!(of.map(|row| row.named).sum::<usize>() > 0, "{mistake} is named nowhere: {said:#?}");
    }
}
