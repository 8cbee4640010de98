//! Tests the HTML report of made-up outcomes.

use super::*;

#[test]
fn html_stands_alone() {
    let report = synthetic();
    let html = report.html().unwrap();
    assert!(is_well_formed(&html), "{html}");
    // One script, embedded in the page.
    assert_eq!(html.matches("<script").count(), 1);
    for load in ["<script ", "<link", "<img", "<iframe", "src=", "@import", "url(", "href=\"http"] {
        assert!(!html.contains(load), "{load}");
    }
    assert!(html.contains(&report.alarms()));
    for name in report.cases.iter().map(|row| &row.name) {
        assert_eq!(html.matches(&format!("id=\"case-{name}\"")).count(), 1, "{name}");
        let command = format!("validate <span>--case</span> <span>{name}</span></code>");
        assert!(html.contains(&command), "{name}");
    }
    for text in [
        "✓ pass",
        "✗ fail",
        "△ under-powered",
        "○ no data",
        "&lt;b&gt;|p₁|&lt;/b&gt; &amp; more.",
        "not caught: factor &lt; 2",
        "a&lt;b",
        "p = 0.31",
        "p ≥ 2·10⁻⁶",
        "mean 0.5012 ± 0.02 (standard error of 400)",
        "id=\"figure-synthetic\"",
        "a wave &amp; nothing else",
        "href=\"#figure-synthetic\"",
        "href=\"curves/synthetic.csv\"",
        "href=\"tables/synthetic.csv\"",
        // A table is folded.
        "id=\"table-synthetic\" data-numbers",
        "Is it synthetic?",
        "1 &lt; 2 &amp; so on",
        "&lt;2.5&gt;",
        "0 of 2, no data for 1",
        "<summary>2</summary><ul class=\"controls\"><li>sign of the spin</li>",
    ] {
        assert!(html.contains(text), "{text}");
    }
}

#[test]
fn hostile_texts_are_harmless_in_every_writing() {
    let hostile =
        "\u{1b}]0;x\u{7}\u{9b}2J\u{fffe}\u{202e}</title></svg><script>x</script> `|` ```` [a](javascript:b) *c*";
    let mut report = synthetic();
    let case = &mut report.cases[0];
    let line = &mut case.evidence[0];
    for text in [
        &mut report.origin.command,
        &mut report.origin.processor,
        &mut case.claim,
        &mut case.command,
        &mut line.what,
        &mut line.because,
    ] {
        *text = hostile.into();
    }
    let study = &mut report.sections.studies[0];
    let table = study.exhibits[0].table.as_mut().unwrap();
    table.caption = hostile.into();
    table.rows[0][1] = hostile.into();
    table.data[0][1] = hostile.into();
    study.answer = hostile.into();
    let figure = study.exhibits[0].figure.as_mut().unwrap();
    figure.caption = hostile.into();
    figure.figure.title = hostile.into();
    figure.figure.x_name = hostile.into();
    figure.figure.curves[0].label = format!("=cmd|{hostile}");
    let control = |text: &str| {
        let bad = |c: char| (c.is_control() && c != '\n') || matches!(c, '\u{fffe}' | '\u{202e}');
        text.contains(bad)
    };
    let html = report.html().unwrap();
    assert!(is_well_formed(&html), "{html}");
    assert!(html.matches("<script").count() == 1 && !control(&html));
    let markdown = report.markdown();
    assert!(!control(&markdown), "{markdown}");
    let made = markdown.lines().last().unwrap();
    assert!(made.contains("by ````` \\u{1b}]0;x") && made.contains("*c* ````` (shearbed"), "{made}");
    // There is no markup outside code.
    let outside: String = markdown.lines().filter(|line| !line.starts_with("Made ")).collect();
    for part in outside.split('`').step_by(2) {
        // An escaped bracket does not begin a link.
        let links = part.replace("\\[", "").contains('[');
        assert!(!part.contains("<script") && !links, "{part}");
    }
    for (name, csv) in report.data().unwrap() {
        assert!(!control(&csv), "{csv}");
        assert!(csv.contains("'=cmd|") || name.starts_with("tables/"), "{csv}");
    }
    let junit = report.junit();
    assert!(is_well_formed(&junit) && !control(&junit), "{junit}");
}

#[test]
fn every_link_leads_somewhere() {
    let html = synthetic().html().unwrap();
    for link in html.split("href=\"#").skip(1) {
        let anchor = link.split('"').next().unwrap();
        assert!(html.contains(&format!("id=\"{anchor}\"")), "{anchor}");
    }
}

#[test]
fn the_first_screen_says_where_to_look() {
    let report = synthetic();
    let html = report.html().unwrap();
    let first = html.split("<section").next().unwrap();
    for name in ["synthetic-fail", "synthetic-blind", "synthetic-empty", "synthetic-underpowered"] {
        assert!(first.contains(&format!("href=\"#case-{name}\"")), "{name}");
    }
    // Of the passing cases, the one that uses most of its tolerance comes first: 0.25, and the p-value 2·10⁻⁶/0.31.
    let (pass, p_value) = (first.find("#case-synthetic-pass"), first.find("#case-synthetic-p-value"));
    assert!(pass.unwrap() < p_value.unwrap());
    // Passing cases are folded, failed ones are open.
    assert!(html.contains("id=\"case-synthetic-pass\" data-tags=\"core eq-A.4 pass\">"), "{html}");
    assert!(html.contains("id=\"case-synthetic-fail\" data-tags=\"core fail\" open=\"\">"), "{html}");
}
