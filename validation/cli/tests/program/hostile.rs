//! Texts from files and names that mean harm: on the terminal, in pictures, in tables.

use crate::common::bounded::Bounded;
use crate::common::{SMALL, command, folder, shearbed};

/// A title that sets a terminal's title, clears it, turns the writing, and would end a tag.
const TITLE: &str = r#"\u001B]0;owned\u0007\u009B2J</text><script>alert(1)</script>\u202E`|*\uFFFE"#;

/// What no terminal may get: controls but for line feeds, turns of the direction of writing, and what is not seen.
fn commands_a_terminal(text: &str) -> bool {
    text.chars().any(|c| (c.is_control() && c != '\n') || ('\u{202a}'..='\u{202e}').contains(&c) || c == '\u{200b}')
}

#[test]
fn titles_and_file_names_command_nothing() {
    let dir = folder();
    let scene = SMALL.replace("A small scene", TITLE);
    let name = "\u{1b}]0;x\u{7}=1.toml";
    dir.write(name, &scene);
    dir.write("\u{1b}[2Jbad.toml", scene.replace("count = 20", "count = 0"));
    let sweep = ["sweep", name, "--over", "interaction.alpha=1,2", "--out", "s"];
    for (arguments, code) in [
        (&["run", name, "--out", "x"][..], 0),
        (&["plan", name][..], 0),
        (&sweep[..], 0),
        (&["run", "\u{1b}[2Jbad.toml"][..], 2),
        (&["run", "\u{1b}[2Jmissing.toml"][..], 2),
        (&["run", "fig5", "--replicas", "\u{1b}[2J"][..], 2),
        (&["run", "fig5", "--\u{1b}[2J"][..], 2),
        (&["scenes", "--show", "\u{1b}[2J"][..], 2),
        (&["validate", "--case", "\u{1b}[2J", "--out", "\u{1b}[2J"][..], 2),
        (&["run", "a\u{200b}\nFAKE: all is well.toml"][..], 2),
        (&["run", name, "--out", "b\u{200b}\nFAKE: all is well"][..], 0),
        (&["plot", "c\u{200b}\nFAKE: all is well"][..], 2),
        (&["compare", "d\u{200b}\nFAKE: a", "e"][..], 2),
    ] {
        let output = command(dir.path(), "").args(arguments).ended();
        let printed = String::from_utf8(output.stdout).unwrap() + &String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(code), "{arguments:?}: {printed:?}");
        assert!(
            !printed.is_empty() && !commands_a_terminal(&printed) && !printed.contains("\nFAKE"),
            "{arguments:?}: {printed:?}"
        );
    }
    for (name, bytes) in dir.files("x") {
        let text = String::from_utf8(bytes).unwrap();
        if name.ends_with(".svg") {
            assert!(!commands_a_terminal(&text) && !text.contains('\u{fffe}'), "{name}: {text}");
            assert!(!text.contains("<script") && text.contains("&lt;script"), "{name}");
        }
    }
}

#[test]
fn no_cell_of_a_table_is_a_formula() {
    let dir = folder();
    let titles = r#"title="=cmd|' /C calc'!A0","@SUM(A1)","+1+2","-3-4","plain\u001b""#;
    let output = command(dir.path(), "sweep small.toml --out x --over").arg(titles).ended();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let text = dir.read("x/sweep.csv");
    let mut reader = csv::Reader::from_reader(text.as_bytes());
    let rows: Vec<_> = reader.records().map(Result::unwrap).collect();
    let titles: Vec<_> = rows.iter().map(|row| &row[0]).collect();
    let expected = ["'=cmd|' /C calc'!A0", "'@SUM(A1)", "'+1+2", "'-3-4", r"plain\u{1b}"];
    assert_eq!(titles, expected);
    // A negative number is a number.
    let over = "--over particles.orientation={phi_deg=-30,theta_deg=60} --over ensemble.seed=1,2";
    dir.runs(&format!("sweep extension {over} --out y"));
}

#[test]
fn a_long_line_is_not_echoed_whole() {
    let dir = folder();
    let long = format!("\"{}\"", "x".repeat(3_000_000));
    for (old, scene) in
        [("count = 20", format!("count = {long}")), ("[flow]", format!("[flow]\n{} = 1", "y".repeat(3_000_000)))]
    {
        dir.write("long.toml", SMALL.replace(old, &scene));
        let run = shearbed(dir.path(), "run long.toml");
        assert_eq!(run.code, Some(2));
        assert!(run.stderr.len() < 4000, "{}", run.stderr.len());
        assert!(run.stderr.starts_with("error: long.toml:"), "{}", &run.stderr[..200]);
        assert!(run.stderr.contains("xxx …") || run.stderr.contains("yyy …"));
    }
}

#[test]
fn threads_of_the_environment_are_used() {
    let dir = folder();
    let output = command(dir.path(), "run small.toml").env("RAYON_NUM_THREADS", "3").ended();
    assert!(output.status.success());
    let record = dir.read("out/small/run.json");
    assert!(record.contains("\"threads\": 3"), "{record}");
}
