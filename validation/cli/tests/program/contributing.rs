//! The examples in CONTRIBUTING.md: a case that passes and whose mistake is caught, a study that finds something, an
//! observable of the core.

use super::example_case::cases;
use super::example_study::STUDY;
use super::order::sources;
use shearbed_validation::judge::accept::Verdict;
use shearbed_validation::judge::case::Effort;
use shearbed_validation::present::plot;
use shearbed_validation::present::study::Request;
use shearbed_validation::present::table::Datum;
use std::fs;
use std::path::Path;

#[test]
fn the_example_of_a_case_is_one() {
    let page = include_str!("../../../../CONTRIBUTING.md");
    assert!(page.contains(include_str!("example_case.rs")));
    let outcome = cases()[0].run(&Effort::gate());
    assert_eq!(outcome.verdict, Verdict::Pass, "{outcome:#?}");
    assert_eq!(outcome.controls.len(), 1);
}

#[test]
fn the_example_of_a_study_is_one() {
    assert!(include_str!("../../../../CONTRIBUTING.md").contains("(validation/cli/tests/program/example_study.rs)"));
    let request = Request { effort: &Effort::gate(), wanted: &|name| name == STUDY.name, finished: &|| () };
    let found = STUDY.found(&request).unwrap().unwrap();
    let table = found.exhibits[0].table.as_ref().unwrap();
    assert_eq!(table.rows.len(), 3);
    assert!(found.files[0].1.starts_with("rods,sd\n10,0."), "{:?}", found.files);
    // X̄₁ of isotropic rods has a variance of 1/12: 0.289; 400 replicas know a standard deviation to 3.5 %, and correct
    // code is outside six of these at one seed in 10⁹.
    for row in &table.data {
        let Datum::Number(scaled) = row[2] else { panic!("{row:?}") };
        assert!((scaled * 12f64.sqrt() - 1.0).abs() < 0.21, "{row:?}");
    }
    plot::svg(&found.exhibits[0].figure.as_ref().unwrap().figure).unwrap();
    let others = Request { wanted: &|name| name != STUDY.name, ..request };
    assert_eq!(STUDY.found(&others), Ok(None));
}

#[test]
fn the_example_of_an_observable_is_one() {
    assert!(include_str!("../../../../CONTRIBUTING.md").contains("(src/observable/cos_2phi.rs)"));
    assert!(include_str!("../../../../src/observable/mod.rs").contains("\nmod cos_2phi;\n"));
    assert!(include_str!("../../../../src/observable/registry.rs").contains("    Cos2Phi: cos_2phi,\n"));
}

/// A pattern whose file or function is gone explains nothing.
#[test]
fn explained_mutants_are_of_functions_that_exist() {
    let root = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");
    let folders = ["src", "validation/src", "validation/methods/src", "validation/oracle/src"];
    let paths = folders.iter().flat_map(|folder| sources(&Path::new(root).join(folder)));
    let texts: Vec<_> = paths.map(|path| (fs::read_to_string(&path).unwrap(), path)).collect();
    let is_there = |file: &str, function: Option<&str>| {
        let mut of_file = texts.iter().filter(|(_, path)| path.ends_with(file));
        of_file.any(|(text, _)| function.is_none_or(|name| text.contains(&format!("fn {name}"))))
    };
    let patterns =
        include_str!("../../../../.cargo/mutants.toml").lines().filter_map(|line| line.trim().strip_prefix('\''));
    let gone: Vec<_> = patterns
        .clone()
        .filter(|pattern| {
            let (file, rest) = pattern.split_once(r"\.rs:").unwrap();
            let function = rest.split_once(" in ").map(|(_, name)| name.split('$').next().unwrap());
            let function = function.map(|name| name.rsplit("::").next().unwrap());
            !is_there(&format!("{file}.rs"), function)
        })
        .collect();
    assert!(patterns.count() > 80 && gone.is_empty(), "{gone:#?}");
    assert!(!is_there("grid.rs", Some("no_such_function")) && !is_there("no_such_file.rs", None));
}
