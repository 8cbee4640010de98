//! Numbers of the text: `0.326<!--=fig4.x1-->` is the value of `fig4.x1` in docs/numbers.tsv, which has the command
//! that prints it. `docs/numbers.sh` makes the table.

use crate::bounded::{Bounded, bash};
use crate::pages::{Page, places, readmes, root, under};
use pulldown_cmark::Event;
use shearbed_validation::cases;
use shearbed_validation::judge::case::Judges;
use std::collections::{BTreeMap, BTreeSet};
use std::fs;

struct Number {
    value: String,
    /// `test`: its command is run here. `release`: it takes too long, and is run for a release.
    when: String,
    command: String,
}

fn table() -> BTreeMap<String, Number> {
    let text = fs::read_to_string(root().join("docs/numbers.tsv")).unwrap();
    let row = |line: &str| {
        let [id, value, when, command] = line.split('\t').collect::<Vec<_>>()[..] else {
            panic!("docs/numbers.tsv: not four cells: {line}");
        };
        (id.to_owned(), Number { value: value.into(), when: when.into(), command: command.into() })
    };
    text.lines().skip(1).map(row).collect()
}

/// The numbers that a page marks, and what is wrong with them.
fn marked(page: &Page, table: &BTreeMap<String, Number>) -> (BTreeSet<String>, Vec<String>) {
    let (mut found, mut wrong) = (BTreeSet::new(), Vec::new());
    for (event, place) in places(&page.text) {
        let Event::InlineHtml(html) = event else { continue };
        let Some(id) = html.strip_prefix("<!--=").and_then(|html| html.strip_suffix("-->")) else { continue };
        let before = &page.text[..place.start];
        let rest = table.get(id).and_then(|number| before.strip_suffix(number.value.as_str()));
        if rest.is_none_or(|rest| rest.ends_with(|sign: char| sign.is_ascii_digit() || sign == '.')) {
            let value = table.get(id).map_or("not in docs/numbers.tsv", |number| &number.value);
            let said: String = before.chars().rev().take(20).collect::<Vec<_>>().into_iter().rev().collect();
            wrong.push(format!("{}: …{said} is not {id}: {value}", page.path));
        }
        found.insert(id.to_owned());
    }
    (found, wrong)
}

#[test]
fn numbers_in_the_text_are_those_of_the_table() {
    let table = table();
    let mut found = BTreeSet::new();
    let mut wrong = Vec::new();
    for page in under("docs/src").iter().chain(&readmes()) {
        let (ids, of_page) = marked(page, &table);
        found.extend(ids);
        wrong.extend(of_page);
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
    let unused: Vec<_> = table.keys().filter(|id| !found.contains(*id)).collect();
    assert!(unused.is_empty(), "no page uses {unused:?}");
}

#[test]
fn a_number_that_is_not_the_table_s_is_seen() {
    let number = |value: &str| Number { value: value.into(), when: "test".into(), command: "true".into() };
    let table = BTreeMap::from([("a.b".to_owned(), number("0.326"))]);
    let wrong = |text: &str| marked(&Page { path: "p".into(), text: text.into() }, &table).1.len();
    assert_eq!(wrong("x = 0.326<!--=a.b--> and 0.326<!--=a.b-->, in code `0.327<!--=a.b-->`"), 0);
    for text in ["x = 0.327<!--=a.b-->", "x = 10.326<!--=a.b-->", "x = 0.326<!--=a.c-->", "x = 0.326 <!--=a.b-->"] {
        assert_eq!(wrong(text), 1, "{text}");
    }
}

/// What a command prints now, with the program of this build.
fn printed(command: &str) -> String {
    let dir = tempfile::tempdir().unwrap();
    let ended = bash(dir.path(), &format!("set -euo pipefail\n{command}")).env("ROOT", root()).ended();
    assert!(ended.status.success(), "{command}: {}", String::from_utf8_lossy(&ended.stderr));
    String::from_utf8(ended.stdout).unwrap().trim().to_owned()
}

/// The rows of the table before the line `<!--table:NAME-->`, and the names of all such lines of a page.
fn rows_before(text: &str, name: &str) -> Option<String> {
    let before = text.split_once(&format!("\n<!--table:{name}-->"))?.0;
    let table = before.rsplit_once("--- |\n")?.1;
    table.lines().all(|row| row.starts_with('|')).then(|| table.to_owned())
}

/// Scripts that take long are run for a release; their rows stand in a page too.
#[test]
fn scripts_print_the_rows_of_tables() {
    let pages = under("docs/src");
    let marks = pages.iter().flat_map(|page| page.text.lines());
    let marks = marks.filter_map(|line| line.strip_prefix("<!--table:")?.strip_suffix("-->"));
    let marked: BTreeSet<_> = marks.collect();
    let mut named = BTreeSet::new();
    for script in fs::read_dir(root().join("docs/numbers/tables")).unwrap() {
        let script = script.unwrap().path();
        let [name, when, "sh"] = script.file_name().unwrap().to_str().unwrap().split('.').collect::<Vec<_>>()[..]
        else {
            panic!("{script:?} is not NAME.test.sh or NAME.release.sh");
        };
        let rows = pages.iter().find_map(|page| rows_before(&page.text, name));
        let rows = rows.unwrap_or_else(|| panic!("no table of a page is marked {name}"));
        match when {
            "test" => {
                assert_eq!(printed(&fs::read_to_string(&script).unwrap()), rows, "bash docs/numbers.sh")
            }
            other => assert_eq!(other, "release", "{name}"),
        }
        named.insert(name.to_owned());
    }
    assert!(marked.iter().all(|name| named.contains(*name)) && named.len() == marked.len(), "{marked:?} {named:?}");
    let other = "| a |\n| --- |\n| 1 |\ntext\n<!--table:a-->";
    assert_eq!(
        (rows_before("| a |\n| --- |\n| 1 |\n<!--table:a-->", "a"), rows_before(other, "a")),
        (Some("| 1 |".into()), None)
    );
}

#[test]
fn commands_print_the_numbers_of_the_table() {
    let mut number = 0;
    for (id, row) in table() {
        match row.when.as_str() {
            "test" => {
                assert_eq!(printed(&row.command), row.value, "{id}: bash docs/numbers.sh");
                number += 1;
            }
            "release" => {}
            other => panic!("{id}: {other} is neither test nor release"),
        }
    }
    assert!(number > 5);
}

/// A tolerance as the pages print it: 2·10⁻¹¹, 0.002.
fn tolerance(value: f64) -> String {
    const RAISED: [char; 10] = ['⁰', '¹', '²', '³', '⁴', '⁵', '⁶', '⁷', '⁸', '⁹'];
    if value >= 1e-3 {
        return format!("{value}");
    }
    let text = format!("{value:e}");
    let (first, exponent) = text.split_once("e-").unwrap();
    let raised: String = exponent.chars().map(|digit| RAISED[digit.to_digit(10).unwrap() as usize]).collect();
    if first == "1" { format!("10⁻{raised}") } else { format!("{first}·10⁻{raised}") }
}

/// Each problem is in one row of the page's table, with its tolerance.
#[test]
fn the_table_of_problems_has_each_once_with_its_tolerance() {
    let page = fs::read_to_string(root().join("docs/src/verification/problems.md")).unwrap();
    let table = page.split_once("| problems | asked |").unwrap().1.split("\n\n").next().unwrap();
    let rows: Vec<Vec<&str>> = table.lines().skip(2).map(|row| row.split(" | ").collect()).collect();
    let is_named = |cell: &str, name: &str| {
        let mut patterns = cell.split('`').skip(1).step_by(2);
        patterns.any(|pattern| pattern.split_once('*').map_or(pattern == name, |(begin, _)| name.starts_with(begin)))
    };
    const COMMAND: &str = "shearbed problems export r --quiet; grep -m1 '\"tolerance\"' r/*/problem.json";
    let exported = printed(COMMAND);
    let problem = |line| {
        let (path, tolerance) = str::split_once(line, "/problem.json:")?;
        let value = tolerance.split_once(": ")?.1.trim_end_matches(',');
        Some((path.strip_prefix("r/")?, value.parse::<f64>().ok()?))
    };
    let problems: Vec<_> = exported.lines().map(|line| problem(line).unwrap()).collect();
    for (name, _) in &problems {
        assert_eq!(rows.iter().filter(|row| is_named(row[0], name)).count(), 1, "{name}");
    }
    for row in rows {
        let own = problems.iter().filter(|(name, _)| is_named(row[0], name));
        let mut of_row: Vec<f64> = own.map(|(_, tolerance)| *tolerance).collect();
        of_row.sort_by(f64::total_cmp);
        let [least, most] = [of_row[0], of_row[of_row.len() - 1]].map(tolerance);
        assert_eq!(row[3], if least == most { least } else { format!("{least}–{most}") }, "{}", row[0]);
    }
}

/// What README shows of its first command, which builds and is not run here.
#[test]
fn readme_shows_the_totals_of_all_cases() {
    let all = cases::all();
    let part = |judges: Judges| {
        let count = all.iter().filter(|case| case.about.judges == judges).count();
        let passed = if judges == Judges::Measurement { 0 } else { count };
        let without = if judges == Judges::Measurement { format!(" (no data for {count})") } else { String::new() };
        format!("{} {passed} of {count}{without}", judges.name())
    };
    let line = format!("\nPassed: {}. 0 fail, 0 under-powered. …\n", Judges::ALL.map(part).join("; "));
    assert!(readmes()[0].text.contains(&line), "{line}");
}
