//! The examples in CONTRIBUTING.md: a case that passes and whose mistake is caught, a study that finds something, an observable
//! that fits the code.

use super::example_case::cases;
use super::example_study::STUDY;
use std::fs;
use std::path::Path;
use validation::judge::accept::Verdict;
use validation::judge::case::Effort;
use validation::present::plot;
use validation::present::study::Extent;
use validation::present::table::Datum;

#[test]
fn the_example_of_a_case_is_one() {
    let page = include_str!("../../../CONTRIBUTING.md");
    assert!(page.contains(include_str!("example_case.rs")));
    let outcome = cases()[0].run(&Effort::gate());
    assert_eq!(outcome.verdict, Verdict::Pass, "{outcome:#?}");
    assert_eq!(outcome.controls.len(), 1);
}

#[test]
fn the_example_of_a_study_is_one() {
    let page = include_str!("../../../CONTRIBUTING.md");
    assert!(page.contains(include_str!("example_study.rs")));
    let extent = Extent { effort: &Effort::gate(), wanted: &|name| name == STUDY.name, finished: &|| () };
    let found = (STUDY.run)(&extent).unwrap().unwrap();
    let table = found.exhibits[0].table.as_ref().unwrap();
    assert_eq!(table.rows.len(), 3);
    // X̄₁ of isotropic rods has a variance of 1/12: 0.289; 400 replicas know a standard deviation to 3.5 %, and correct code is
    // outside six of these at one seed in 10⁹.
    for row in &table.data {
        let Datum::Number(scaled) = row[2] else { panic!("{row:?}") };
        assert!((scaled * 12f64.sqrt() - 1.0).abs() < 0.21, "{row:?}");
    }
    plot::svg(&found.exhibits[0].figure.as_ref().unwrap().figure).unwrap();
    let others = Extent { wanted: &|name| name != STUDY.name, ..extent };
    assert_eq!((STUDY.run)(&others), Ok(None));
}

/// Every line that the example of an observable leaves as it is, or takes away, stands in the file that it names.
#[test]
fn the_example_of_an_observable_fits_the_code() {
    let page = include_str!("../../../CONTRIBUTING.md");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let (mut file, mut lines, mut added) = (String::new(), 0, 0);
    let diff = page.split("```diff\n").nth(1).unwrap().split("```").next().unwrap();
    for line in diff.lines() {
        if let Some(name) = line.strip_prefix("+++ ") {
            file = fs::read_to_string(root.join(name)).unwrap();
        } else if let Some(old) = line.strip_prefix(['-', ' ']) {
            assert!(file.lines().any(|own| own == old), "{line}");
            lines += 1;
        } else {
            added += usize::from(line.starts_with('+'));
        }
    }
    assert!(lines > 5 && (5..=30).contains(&added), "{lines} {added}");
}
