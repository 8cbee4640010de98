//! The example in CONTRIBUTING.md is a case that passes and whose mistake is caught.

use super::example_case::cases;
use validation::accept::Verdict;
use validation::case::Effort;

#[test]
fn the_example_of_a_case_is_one() {
    let page = include_str!("../../../CONTRIBUTING.md");
    assert!(page.contains(include_str!("example_case.rs")));
    let outcome = cases()[0].run(&Effort::gate());
    assert_eq!(outcome.verdict, Verdict::Pass, "{outcome:#?}");
    assert_eq!(outcome.controls.len(), 1);
}
