use super::*;

#[test]
fn another_format_is_refused() {
    let report = serde_json::json!({
        "format": 99, "summary": { "full": false, "seed": 1 }, "cases": [],
        "origin": { "commit": "a", "processor": "b" },
    });
    let other = parse(&report.to_string()).map(|report| report.format).unwrap_err();
    assert!(other.starts_with("format = 99 is not allowed: expected 3"), "{other}");
}

#[test]
fn other_evidence_tolerances_and_controls_are_listed() {
    let report = |what: &str, tolerance: f64, caught: bool| {
        let line = |what: &str| {
            serde_json::json!({ "what": what, "error": 0.0, "tolerance": tolerance,
            "judged_by": { "rule": "within" } })
        };
        let report = serde_json::json!({
            "format": FORMAT, "summary": { "full": false, "seed": 1 },
            "cases": [{ "name": "case", "verdict": "pass", "seconds": 0.1, "evidence": [line("both"), line(what)],
                "controls": [{ "mistake": "sign", "caught": caught }] }],
            "origin": { "commit": "a", "processor": "b" },
        });
        parse(&report.to_string()).unwrap()
    };
    let before = report("one", 1e-3, true);
    assert_eq!(judged_otherwise(&before, &report("one", 1e-3, true)), "");
    assert_eq!(
        judged_otherwise(&before, &report("two", 1.0, false)),
        "Judged otherwise:\n  case: one: in A alone\n  case: two: in B alone\n  case: both: tolerance 1.000e-3 → \
         1.000e0\n  case: sign: caught → not caught\n"
    );
}

fn line(json: serde_json::Value) -> Line {
    serde_json::from_value(json).unwrap()
}

#[test]
fn only_what_is_beyond_noise_has_moved() {
    let mean = |mean: f64| {
        line(serde_json::json!({
            "what": "synthetic", "error": 0.1, "tolerance": 1.0,
            "judged_by": { "rule": "mean", "mean": mean, "se": 0.1 },
        }))
    };
    // A standard error of the difference is √2 · 0.1.
    assert_eq!(by(&mean(1.0), &mean(1.5)), None);
    assert_eq!(by(&mean(1.0), &mean(1.6)).as_deref(), Some("+4.2 standard errors"));
    let within = |error: Option<f64>| {
        line(serde_json::json!({
            "what": "synthetic", "error": error, "tolerance": 1e-12, "judged_by": { "rule": "within" },
        }))
    };
    assert_eq!(by(&within(Some(1e-14)), &within(Some(1.5e-14))), None);
    assert_eq!(by(&within(Some(1e-14)), &within(Some(4e-14))).as_deref(), Some("× 4.000"));
    assert!(by(&within(Some(0.0)), &within(None)).is_some());
}
