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

/// A report with the checksum of its contents at the end, as `validate` writes it.
fn sealed(report: &Value) -> String {
    let mut report = report.clone();
    report.as_object_mut().unwrap().remove("crc32");
    let text = report.to_string();
    let body = text.strip_suffix('}').unwrap();
    format!("{body},\"crc32\":\"{:08x}\"}}", crc32fast::hash(body.as_bytes()))
}

#[test]
fn two_reports_are_compared() {
    let dir = unequal();
    let case = "validate --case jeffery-period --quiet --out";
    assert_eq!(shearbed(dir.path(), &format!("{case} a")).code, Some(0));
    let text = read(&dir.path().join("a/report.json"));
    let write = |name: &str, text: &str| fs::write(dir.path().join(name), text).unwrap();
    let same = shearbed(dir.path(), "compare a/report.json a/report.json");
    assert_eq!(same.code, Some(0), "{}", same.stderr);
    assert!(same.stdout.contains("Verdicts: none of 1 changed."), "{}", same.stdout);
    assert!(same.stdout.contains("No error moved beyond its noise."), "{}", same.stdout);
    // A spoilt report: another verdict, and an error that is no longer what it was.
    let mut spoilt: Value = serde_json::from_str(&text).unwrap();
    spoilt["cases"][0]["verdict"] = "fail".into();
    spoilt["cases"][0]["evidence"][0]["error"] = 1.0.into();
    write("b.json", &sealed(&spoilt));
    let other = shearbed(dir.path(), "compare a/report.json b.json").stdout;
    assert!(other.contains("jeffery-period: pass → fail"), "{other}");
    assert!(other.contains("Errors that moved"), "{other}");
    let mut strange = spoilt.clone();
    strange["cases"][0]["verdict"] = "PASSED?".into();
    write("c.json", &sealed(&strange));
    let unknown = shearbed(dir.path(), "compare a/report.json c.json");
    assert!(unknown.code == Some(2) && unknown.stderr.contains("PASSED?"), "{}", unknown.stderr);
    let bad = shearbed(dir.path(), "compare a/report.json small.toml");
    assert_eq!(bad.code, Some(2));
    assert!(bad.stderr.contains("small.toml: is no report.json"), "{}", bad.stderr);
    // A report that was changed is no longer what was written, wherever it lies and whatever its name is.
    let edited = text.replacen("\"verdict\": \"pass\"", "\"verdict\": \"fail\"", 1);
    assert_ne!(edited, text);
    fs::create_dir(dir.path().join("copied")).unwrap();
    let edited_names = ["a/report.json", "copied/report.json", "a/renamed.json", "loose.json"];
    edited_names.iter().for_each(|name| write(name, &edited));
    #[cfg(unix)]
    std::os::unix::fs::symlink("a/report.json", dir.path().join("link.json")).unwrap();
    let linked: &[&str] = if cfg!(unix) { &["link.json"] } else { &[] };
    for name in edited_names.iter().chain(linked) {
        let changed = shearbed(dir.path(), &format!("compare b.json {name}"));
        assert_eq!(changed.code, Some(2), "{}", changed.stdout);
        let said = format!("{name}: was changed after it was written");
        assert!(changed.stderr.contains(&said), "{}", changed.stderr);
    }
    write("bare.json", &spoilt.to_string());
    let bare = shearbed(dir.path(), "compare b.json bare.json");
    assert!(bare.code == Some(2) && bare.stderr.contains("bare.json: has no checksum"), "{}", bare.stderr);
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
