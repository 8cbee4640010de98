use super::*;
use crate::files::build::json;
use crate::present::xml::is_well_formed;
use crate::serve::problems::loaded;

fn report() -> Report {
    let sphere = loaded("sphere");
    let graded = |name: &str, verdict, error| Graded {
        name: name.to_owned(),
        verdict,
        error,
        ..Graded::without_answer(&sphere)
    };
    let mut bad = graded("b", Verdict::Fail, Some(0.5));
    bad.diagnosis = Some("this is the curve of \"x\" & <y>\u{1}, to 1e-9".into());
    Report {
        format: 1,
        shearbed: "0".into(),
        reference: "ref".into(),
        answers: "mine".into(),
        problems: vec![
            graded("a", Verdict::Pass, Some(1e-10)),
            bad,
            graded("c", Verdict::Missing, None),
            Graded { reference: Origin::Foreign, ..graded("d", Verdict::NotReached, Some(1e-3)) },
        ],
        live: None,
        diagnosis: vec!["one mistake explains both".into()],
        remarks: vec!["a remark".into()],
        all: false,
    }
}

#[test]
fn every_writer_has_every_problem_and_its_verdict() {
    let report = report();
    let xml = junit(&report);
    assert!(is_well_formed(xml.split_once("?>\n").unwrap().1), "{xml}");
    assert!(xml.contains("tests=\"4\" failures=\"2\"") && xml.contains("<skipped"));
    let wanted = Report { all: true, ..report.clone() };
    assert!(junit(&wanted).contains("failures=\"3\" errors=\"0\" skipped=\"0\""));
    assert!(wanted.headline().contains("1 MISSING (no answer: not passed)"));
    assert!(xml.contains("&quot;x&quot; &amp; &lt;y&gt;\\u{1}"));
    let json: serde_json::Value = serde_json::from_str(&json(&report).unwrap()).unwrap();
    assert_eq!(json["problems"][1]["verdict"], "FAIL");
    assert_eq!(json["problems"][2]["error"], serde_json::Value::Null);
    assert_eq!(json["problems"][3]["verdict"], "NOT REACHED");
    let origins = [2, 3].map(|k| json["problems"][k]["reference"].clone());
    assert_eq!(origins, ["built-in", "foreign"]);
    for text in [terminal(&report), markdown(&report)] {
        for word in [
            "PASS",
            "FAIL",
            "MISSING",
            "curve of",
            "a remark",
            "one mistake explains both",
            "1 of 4 problems pass",
            "1 NOT REACHED",
            "FOREIGN",
        ] {
            assert!(text.contains(word), "{word}: {text}");
        }
    }
}

#[test]
fn what_a_program_says_is_no_markup_and_commands_no_terminal() {
    let mut report = report();
    let hostile = "\u{1b}]0;x\u{7}\u{9b}2J\u{202e}<img src=x> [a](javascript:b) `` ` <b>\n# c";
    report.problems[1].note = Some(hostile.into());
    report.answers = hostile.into();
    report.remarks = vec![hostile.into()];
    let (page, json) = (markdown(&report), json(&report).unwrap());
    let commands = |text: &str| text.chars().any(|c| c != '\n' && (c.is_control() || c == '\u{202e}'));
    assert!(!commands(&page) && !commands(&json), "{page}{json}");
    for markup in ["<img", "<b>", " [a]", "\n# c", " `"] {
        assert!(!page.contains(markup), "{markup}: {page}");
    }
    assert_eq!(page.matches(r"\[a](javascript:b)").count(), 3, "{page}");
    let read: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(read["remarks"][0], hostile);
}

#[test]
fn the_terminal_has_80_columns_and_one_line_for_all_that_is_missing() {
    let mut report = report();
    report.answers = "python3 my_code.py ".repeat(20);
    report.remarks = vec!["words and words ".repeat(30).trim().to_owned()];
    for k in 0..20 {
        report.problems.push(Graded { name: format!("missing-{k}"), ..report.problems[2].clone() });
    }
    let text = terminal(&report);
    let longest = text.lines().map(|line| line.chars().count()).max().unwrap();
    assert!(longest <= 80, "{longest}: {text}");
    assert_eq!(text.matches("MISSING").count(), 2, "the headline and one line: {text}");
    assert!(text.contains("21 MISSING, no answer: c, missing-0, missing-1"), "{text}");
    let short =
        Report { problems: vec![report.problems[0].clone()], diagnosis: vec![], remarks: vec![], ..report.clone() };
    for text in [&text, &terminal(&short)] {
        assert!(!text.contains("\n\n\n") && text.ends_with('\n') && !text.ends_with("\n\n"), "{text:?}");
    }
    let whole = text.split_whitespace().collect::<Vec<_>>().join(" ");
    assert!(whole.contains(&report.remarks[0]) && whole.contains("missing-10 and 9 more"), "{text}");
    assert_eq!(wrapped("a  b\n"), "a  b\n");
}

#[test]
fn a_report_passes_where_one_passes_and_none_fails() {
    let mut report = report();
    assert!(!report.passes());
    report.problems.remove(1);
    assert!(!report.passes(), "one is not reached");
    report.problems.pop();
    assert!(report.passes() && !Report { all: true, ..report.clone() }.passes(), "one is missing");
    report.problems.remove(0);
    assert!(!report.passes(), "none passes");
    report.problems.clear();
    assert!(!report.passes());
}

/// A program that crashes has the same remark on every problem.
#[test]
fn what_several_problems_say_alike_stands_once() {
    let mut report = report();
    for name in ["e", "f"] {
        report.problems.push(Graded { name: name.into(), ..report.problems[1].clone() });
    }
    report.problems.push(Graded { name: "g".into(), verdict: Verdict::NotReached, ..report.problems[1].clone() });
    let said: Vec<_> = lines(&report).into_iter().filter(|line| line.contains("curve of")).collect();
    assert!(
        said.len() == 2 && said[0].starts_with("FAIL b, e, f: ") && said[1].starts_with("NOT REACHED g: "),
        "{said:?}"
    );
}

#[test]
fn a_fault_of_the_program_has_no_second_line() {
    let mut report = report();
    report.problems[1].diagnosis = None;
    report.problems[1].note = Some("asked for 32 steps: the program ended: exit status: 3".into());
    let said = |report: &Report| lines(report).iter().filter(|line| line.contains("exit status: 3")).count();
    assert_eq!(said(&report), 1, "no remark has it");
    report.remarks.push("b: the program ended: exit status: 3 (2 times)".into());
    assert_eq!(said(&report), 1);
    report.remarks[1] = "c: the program ended: exit status: 4".into();
    assert_eq!(said(&report), 1, "another fault");
}
