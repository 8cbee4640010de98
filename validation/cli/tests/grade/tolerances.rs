//! `--tolerance X` and `--tolerance NAME=X`.

use crate::grading::{answers, files, off_by, problem, some, text, write};

#[test]
fn a_users_tolerance_passes_a_code_of_that_accuracy_and_no_worse_one() {
    let dir = tempfile::tempdir().unwrap();
    let own = problem("mid-flip-2").0["tolerance"].as_f64().unwrap();
    write(dir.path(), "mid-flip-2", "answer.csv", text(&off_by("mid-flip-2", 5e-7 / own)));
    write(dir.path(), "mid-flip-100", "answer.csv", text(&off_by("mid-flip-100", 0.5)));
    for (more, verdict, tolerance) in [
        (&[][..], "FAIL", own),
        (&["--tolerance", "1e-6"], "PASS", 1e-6),
        (&["--tolerance", "1e-7"], "FAIL", 1e-7),
        (&["--tolerance", "mid-flip-2=1e-6"], "PASS", 1e-6),
        (&["--tolerance", "mid-flip-100=1e-6"], "FAIL", own),
        (&["--tolerance", "1e-7", "--tolerance", "mid-flip-2=1e-6"], "PASS", 1e-6),
    ] {
        let graded = answers(dir.path(), more);
        assert_eq!(graded.verdict("mid-flip-2"), verdict, "{more:?}: {}", graded.words);
        assert_eq!(graded.of("mid-flip-2")["tolerance"], tolerance, "{more:?}");
    }
    // A smaller one of all problems is none: the problem's own stays, and with it what its answer is worth.
    let graded = answers(dir.path(), &["--tolerance", "1e-15", "--problem", "mid-flip-100"]);
    assert_eq!((graded.code, graded.verdict("mid-flip-100")), (Some(0), "PASS"));
    assert!(graded.of("mid-flip-100")["because"].as_str().unwrap().starts_with("A right code"));
}

#[test]
fn tolerances_that_are_none_are_refused() {
    let dir = tempfile::tempdir().unwrap();
    // One of each kind.
    let kinds = ["mid-flip-2", "isotropic-3", "contact-rule", "lee-springer"];
    let reference = some(&dir.path().join("ref"), &kinds);
    for (given, reason) in [
        ("0", "a number above 0, at most 10, or NAME=NUMBER, is allowed"),
        ("mid-flip-2", "a number above 0"),
        ("mid-flip-3=1e-6", "no problem of this name is graded"),
        ("mid-flip-2=1e-12", "its own tolerance is 6e-11"),
        ("1", "0.1 at most is allowed"),
        ("nan", "a number above 0"),
        ("-1e-6", "a number above 0"),
    ] {
        let ended = files(&reference, dir.path(), &["--tolerance", given]);
        assert!(ended.code == Some(2) && ended.words.contains(reason), "{given}: {}", ended.words);
    }
}
