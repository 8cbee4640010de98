//! Two reports compared.

use crate::common::folder;
use serde_json::Value;

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
    let dir = folder();
    dir.runs("validate --case jeffery-period --quiet --out a");
    let report = dir.json("a/report.json");
    // A spoilt report: another verdict, and an error that is no longer what it was.
    let mut spoilt = report.clone();
    spoilt["cases"][0]["verdict"] = "fail".into();
    spoilt["cases"][0]["evidence"][0]["error"] = 1.0.into();
    dir.write("b.json", sealed(&spoilt));
    let other = dir.runs("compare a/report.json b.json").stdout;
    assert!(other.contains("jeffery-period: pass → fail") && other.contains("Errors that moved"), "{other}");
    let mut strange = spoilt.clone();
    strange["cases"][0]["verdict"] = "PASSED?".into();
    dir.write("c.json", sealed(&strange));
    dir.refuses("compare a/report.json c.json", "PASSED?");
    dir.write("bare.json", spoilt.to_string());
    dir.refuses("compare b.json bare.json", "bare.json: has no checksum");
    assert!(dir.read("a/junit.xml").contains("name=\"jeffery-period\""));
    assert_eq!(report["cases"].as_array().map(Vec::len), Some(1));
}
