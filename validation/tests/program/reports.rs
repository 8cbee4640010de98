//! Cases chosen by name, two reports compared, and how a build is cited.

use crate::common::{names, read, shearbed, unequal};
use serde_json::Value;
use std::fs;
use std::path::Path;

#[test]
fn chosen_cases_are_run_and_reported() {
    let dir = unequal();
    let ended = shearbed(dir.path(), "validate --case jeffery-period --data . --threads 2 --out report");
    assert_eq!((ended.code, ended.stderr.as_str()), (Some(0), ""));
    let lines: Vec<_> = ended.stdout.lines().collect();
    assert!(lines[0].starts_with("pass            jeffery-period "), "{lines:?}");
    assert!(lines[2].starts_with("Passed: core 1 of 1. 0 fail, "), "{lines:?}");
    assert_eq!(lines[3], format!("report: {}", Path::new("report/report.html").display()));
    let report = dir.path().join("report");
    assert_eq!(names(&report), ["junit.xml", "report.html", "report.json", "report.md", "shearbed.json"]);
    let json: Value = serde_json::from_str(&read(&report.join("report.json"))).unwrap();
    assert_eq!(json["cases"].as_array().map(Vec::len), Some(1));

    let quiet = shearbed(dir.path(), "validate --case jeffery-period --quiet");
    assert_eq!((quiet.code, quiet.stdout + &quiet.stderr), (Some(0), String::new()));
    assert!(dir.path().join("out/report/report.html").is_file());
}

#[test]
fn two_reports_are_compared() {
    let dir = unequal();
    let case = "validate --case jeffery-period --quiet --out";
    assert_eq!(shearbed(dir.path(), &format!("{case} a")).code, Some(0));
    let text = read(&dir.path().join("a/report.json"));
    let same = shearbed(dir.path(), "compare a/report.json a/report.json");
    assert_eq!(same.code, Some(0), "{}", same.stderr);
    assert!(same.stdout.contains("Verdicts: none of 1 changed."), "{}", same.stdout);
    assert!(same.stdout.contains("No error moved beyond its noise."), "{}", same.stdout);
    // A spoilt report: another verdict, and an error that is no longer what it was.
    let mut spoilt: Value = serde_json::from_str(&text).unwrap();
    spoilt["cases"][0]["verdict"] = "fail".into();
    spoilt["cases"][0]["evidence"][0]["error"] = 1.0.into();
    fs::write(dir.path().join("b.json"), spoilt.to_string()).unwrap();
    let other = shearbed(dir.path(), "compare a/report.json b.json").stdout;
    assert!(other.contains("jeffery-period: pass → fail"), "{other}");
    assert!(other.contains("Errors that moved"), "{other}");
    let mut strange = spoilt.clone();
    strange["cases"][0]["verdict"] = "PASSED?".into();
    fs::write(dir.path().join("c.json"), strange.to_string()).unwrap();
    let unknown = shearbed(dir.path(), "compare a/report.json c.json");
    assert!(unknown.code == Some(2) && unknown.stderr.contains("PASSED?"), "{}", unknown.stderr);
    let bad = shearbed(dir.path(), "compare a/report.json small.toml");
    assert_eq!(bad.code, Some(2));
    assert!(bad.stderr.contains("small.toml: is no report.json"), "{}", bad.stderr);
    // A report that was changed in its folder is no longer what was written there.
    fs::write(dir.path().join("a/report.json"), spoilt.to_string()).unwrap();
    let changed = shearbed(dir.path(), "compare b.json a/report.json");
    assert_eq!(changed.code, Some(2), "{}", changed.stdout);
    assert!(changed.stderr.contains("a/report.json: was changed after it was written"), "{}", changed.stderr);
    assert!(read(&dir.path().join("a/junit.xml")).contains("name=\"jeffery-period\""));
}

#[test]
fn a_build_says_how_it_is_cited() {
    let text = shearbed(unequal().path(), "cite").stdout;
    let version = format!("version = {{{}}}", env!("CARGO_PKG_VERSION"));
    for words in ["@software{shearbed,", &version, "note    = {commit ", "@article{lee-springer-1982,"] {
        assert!(text.contains(words), "{text}");
    }
    assert_eq!(text.matches('{').count(), text.matches('}').count());
}
