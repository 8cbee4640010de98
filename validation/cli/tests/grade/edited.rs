//! Edited problems are refused under the name of a built-in problem, foreign under another, and never a panic.

use crate::grading::{REFERENCE, names, problem, some, text, write};
use serde_json::{Value, json};
use shearbed_validation::serve::grade::{self, Options};
use shearbed_validation::serve::problems::{self, LoadedProblem};
use std::collections::BTreeSet;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

/// Values that a key may be given by mistake or on purpose.
fn values() -> Vec<Value> {
    let texts =
        ["", "rods", "tensor", "contact", "ensemble", "angle", "absolute", "relative", "standard-errors", "../x"];
    let numbers = [0.0, -1.0, 0.5, 1.0, 1e-300, 1e308, -1e308];
    let columns = ["time_s", "rod", "snapshot", "p1", "a11", "x1", "x1_se", "a_pdot1_per_s", "b_phi_rad"];
    let mut all: Vec<Value> = texts.map(Value::from).into();
    all.extend(numbers.map(Value::from));
    all.extend([Value::Null, json!(true), json!([]), json!({}), json!([0.0]), json!([1.0, 0.5]), json!([1.0, 2.0])]);
    all.extend([json!(columns), json!(columns[..2]), json!(["time_s", "p1", "p2", "p3"])]);
    let small = [[1e-300, 0.0, 0.0], [0.0; 3], [0.0; 3]];
    all.extend([[[0.0; 3]; 3], [[1e308; 3]; 3], small].map(|matrix| json!(matrix)));
    all.push(json!({"count": 100, "length_mm": 0.7, "concentration_per_cm3": 50.0, "alpha": 0.5, "m": 3.0,
        "steps_per_period": 200, "certified_replicas": 20000, "largest_standard_error": 1e300}));
    all
}

/// Answers with the problem's own certified rows, and with each of their values moved.
fn judged(loaded: &LoadedProblem, mine: &Path) -> Result<(), String> {
    for moved in [0.0, 0.3] {
        let keys = loaded.problem.kind.keys().len();
        let mut rows = vec![loaded.problem.columns.clone()];
        for row in &loaded.certified.rows {
            let value = |(k, x): (usize, &f64)| {
                if k < keys { x.to_string() } else { (x + moved).to_string() }
            };
            rows.push(row.iter().enumerate().map(value).collect());
        }
        write(mine, &loaded.problem.name, "answer.csv", text(&rows));
        let one = std::slice::from_ref(loaded);
        let graded = catch_unwind(AssertUnwindSafe(|| grade::grade(one, mine, &Options::default())));
        let graded = graded.map_err(|_| "a panic".to_owned())?;
        if let (None, Some(note)) = (graded[0].error, &graded[0].note) {
            return Err(note.clone());
        }
        if moved > 0.0 && graded[0].verdict == grade::Verdict::Pass {
            return Err(format!("a wrong answer passes: {:#?}", graded[0]));
        }
    }
    Ok(())
}

/// Keys that are shown and change no verdict: of one problem of each kind, one value of one of them that is accepted is
/// judged.
const WORDS: [&str; 5] = ["title", "summary", "because", "axes", "equations"];

/// Every key of every problem with each of the values: refused, or the same problem, or, under another name, foreign.
#[test]
fn no_value_of_any_key_panics_or_is_taken_silently() {
    let values = values();
    let hook = std::panic::take_hook();
    std::panic::set_hook(Box::new(|_| {}));
    let mut wrong = Vec::new();
    let (mut refused, mut foreign) = (0, 0);
    let mut kinds_with_words = BTreeSet::new();
    // Problems of a form differ in their numbers alone: one in shear and one in another flow stand for single rods and
    // for isotropic ones, unequal rods for ensembles, mixed flows for diffusing rods, rest and an oscillation for
    // Brownian ones. Of every other form there is one.
    let one_of_a_form = |name: &String| match name.as_str() {
        "mid-flip-2" | "spiral" | "turning-axes-5" | "isotropic-3" | "isotropic-extension" | "lee-springer-unequal" => {
            true
        }
        "pdot-rod" | "closure-hybrid" | "dadt-rsc-ibof" | "brownian-relaxation" | "brownian-oscillation" => true,
        name if ["pdot", "closure", "dadt", "brownian"].iter().any(|kind| name.starts_with(kind)) => false,
        name if ["folgar-tucker", "closed"].iter().any(|kind| name.starts_with(kind)) => name.ends_with("-mixed"),
        name => {
            !["rods", "ensemble"].contains(&problem(name).0["kind"].as_str().unwrap()) && !name.starts_with("isotropic")
        }
    };
    let names: BTreeSet<_> = names().into_iter().collect();
    for name in names.into_iter().filter(one_of_a_form) {
        for own in [false, true] {
            let dir = tempfile::tempdir().unwrap();
            let reference = some(&dir.path().join("ref"), &[&name]);
            let mine = dir.path().join("mine");
            let called = if own { "my-own" } else { &name };
            fs::rename(reference.join(&name), reference.join(called)).unwrap();
            let path = reference.join(called).join("problem.json");
            let mut json: Value = serde_json::from_str(&fs::read_to_string(&path).unwrap()).unwrap();
            json["name"] = json!(called);
            let mut keys: Vec<_> = json.as_object().unwrap().keys().cloned().collect();
            keys.extend(["ensemble", "closed", "formula", "time_step_s", "surplus"].map(String::from));
            for key in keys {
                for value in values.iter().filter(|value| json[&key] != **value) {
                    let mut spoilt = json.clone();
                    spoilt[&key] = value.clone();
                    fs::write(&path, spoilt.to_string()).unwrap();
                    let mut fault = |what: String| wrong.push(format!("{called} ({name}), {key} = {value}: {what}"));
                    match problems::read(&reference) {
                        Err(error) if error.path.starts_with(&reference) && !error.message.is_empty() => refused += 1,
                        Err(error) => fault(error.to_string()),
                        // An optional key that is not there is the default.
                        Ok(_) if !own && value.is_null() && json[&key].is_null() => {}
                        Ok(_) if !own => fault("taken silently".to_owned()),
                        Ok(found) => {
                            foreign += 1;
                            let words = WORDS.contains(&key.as_str());
                            if words && !kinds_with_words.insert(json["kind"].to_string()) {
                                continue;
                            }
                            if let Err(what) = judged(&found[0], &mine) {
                                fault(what);
                            }
                        }
                    }
                }
            }
        }
    }
    std::panic::set_hook(hook);
    assert!(wrong.is_empty(), "{} of them:\n{}", wrong.len(), wrong.join("\n"));
    assert!(refused > 10_000 && foreign > 100, "{refused} refused, {foreign} foreign");
}

#[test]
fn what_is_exported_is_read_as_built_in() {
    let found = problems::read(REFERENCE.path()).unwrap();
    let foreign = found.iter().filter(|loaded| loaded.origin != problems::Origin::BuiltIn);
    assert_eq!(foreign.count(), 0);
    assert_eq!(found.len(), problems::all().len());
}
