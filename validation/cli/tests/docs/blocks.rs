//! Shell blocks of README and user guide, run in order, each page in an empty folder. A block is marked `sh`;
//! `sh,slow`, which runs where DOCS_SLOW is set, as in `.ci/run`; or `sh,no-run`, for what needs a network or another
//! machine. A block that begins with `cargo` builds and is not run. A block `text` right after a block is what it
//! prints; `…` stands for anything. With DOCS_PAGE=faq.md the blocks of this page alone are run.

use crate::bounded::{Bounded, bash};
use crate::pages::{Page, blocks, readmes, under};
use rayon::prelude::*;
use std::path::Path;

/// Commands, and what they are said to print.
struct Step {
    info: String,
    commands: String,
    shown: Option<String>,
}

fn steps(page: &str) -> Vec<Step> {
    let mut found: Vec<Step> = Vec::new();
    let mut after_shell = false;
    for (info, text) in blocks(page) {
        let shell = info == "sh" || info.starts_with("sh,");
        match (shell, info == "text" && after_shell) {
            (true, _) => found.push(Step { info, commands: text, shown: None }),
            (_, true) => found.last_mut().unwrap().shown = Some(text),
            _ => {}
        }
        after_shell = shell;
    }
    found
}

/// Runs the blocks of a page; what was wrong first.
fn run(page: &str, slow: bool) -> Result<usize, String> {
    let dir = tempfile::tempdir().unwrap();
    let mut number = 0;
    for step in steps(page) {
        match step.info.as_str() {
            "sh" if step.commands.starts_with("cargo ") => continue,
            "sh" => {}
            "sh,slow" if slow => {}
            "sh,slow" | "sh,no-run" => continue,
            other => return Err(format!("```{other} is not one of sh, sh,slow and sh,no-run")),
        }
        if let Some(tool) = missing_tool(&step.commands) {
            println!("skipped: {tool} is not here, and the rest of the page may need it");
            break;
        }
        let (ended_well, printed) = shell(&step.commands, dir.path());
        if !ended_well {
            return Err(format!("failed:\n{}\nprinted:\n{printed}", step.commands));
        }
        if let Some(line) = step.shown.and_then(|shown| not_printed(&shown, &printed)) {
            return Err(format!("{}\ndoes not print\n{line}\nbut\n{printed}", step.commands));
        }
        number += 1;
    }
    Ok(number)
}

/// Whether the commands ended with 0, and what they printed: standard output, then standard error.
fn shell(commands: &str, dir: &Path) -> (bool, String) {
    let ended = bash(dir, &format!("set -euo pipefail\n{commands}")).ended();
    let printed = [ended.stdout, ended.stderr].concat();
    (ended.status.success(), String::from_utf8_lossy(&printed).into_owned())
}

/// A tool that the commands start and this machine does not have.
fn missing_tool(commands: &str) -> Option<&'static str> {
    let starts = |tool: &str| commands.split_whitespace().any(|word| word.trim_matches('"') == tool);
    ["python3", "cc", "c++", "gfortran"]
        .into_iter()
        .find(|tool| starts(tool) && !shell(&format!("command -v {tool}"), Path::new("/")).0)
}

/// The first line of `shown` that is not printed after those before it.
fn not_printed(shown: &str, printed: &str) -> Option<String> {
    let mut lines = printed.lines();
    for line in shown.lines().filter(|line| line.trim() != "…" && !line.trim().is_empty()) {
        let words: Vec<_> = line.split_whitespace().collect();
        if !lines.any(|found| same(&words, &found.split_whitespace().collect::<Vec<_>>())) {
            return Some(line.to_owned());
        }
    }
    None
}

/// Whether the words are the same: `…` stands for any words or part of one, and a time differs from run to run.
fn same(shown: &[&str], found: &[&str]) -> bool {
    let Some((first, rest)) = shown.split_first() else {
        return found.is_empty();
    };
    if *first == "…" {
        return (0..=found.len()).any(|skipped| same(rest, &found[skipped..]));
    }
    let Some((word, others)) = found.split_first() else {
        return false;
    };
    let number = |word: &str| word.parse::<f64>().is_ok();
    let time = rest.first().is_some_and(|unit| ["s", "ms", "min"].contains(unit)) && number(first) && number(word);
    let part = first.split_once('…').is_some_and(|(start, end)| {
        word.len() >= start.len() + end.len() && word.starts_with(start) && word.ends_with(end)
    });
    (first == word || time || part) && same(rest, others)
}

#[test]
fn the_shell_blocks_of_readme_and_user_guide_run() {
    let slow = std::env::var_os("DOCS_SLOW").is_some();
    let mut pages = under("docs/src/user");
    pages.push(readmes().swap_remove(0));
    let only = std::env::var("DOCS_PAGE").unwrap_or_default();
    pages.retain(|page| page.path.ends_with(&only));
    let of = |page: &Page| run(&page.text, slow).unwrap_or_else(|wrong| panic!("{}: {wrong}", page.path));
    let number: usize = pages.par_iter().map(of).sum();
    let least = if only.is_empty() { (6, 21) } else { (1, 0) };
    assert!(pages.len() >= least.0 && number >= least.1, "{number} blocks of {} pages", pages.len());
}

#[test]
fn a_block_that_fails_or_prints_something_else_is_seen() {
    let page = |commands: &str, shown: &str| format!("# A\n\n```sh\n{commands}\n```\n\nSo:\n\n```text\n{shown}\n```\n");
    let version = format!("shearbed {}", env!("CARGO_PKG_VERSION"));
    assert_eq!(run(&page("shearbed --version", &version), false), Ok(1));
    assert_eq!(run(&page("echo 'a 1.5 b 3.2 s c'; echo d", "a … b 7.9 s c\n…\nd"), false), Ok(1));
    for (commands, shown) in [
        ("shearbed no-such-command", ""),
        ("shearbed no-such-command | head -1", ""),
        ("shearbed --version", "shearbed 0.0.9"),
        ("echo 'a 1.5 b'", "a 1.6 b"),
        ("echo b; echo a", "a\nb"),
        ("echo 'a b'", "a"),
    ] {
        assert!(run(&page(commands, shown), false).is_err(), "{commands}");
    }
    let skipped = "```sh,slow\nfalse\n```\n\n```sh,no-run\nfalse\n```\n\n```sh\ncargo no-such-command\n```\n";
    assert_eq!(run(skipped, false), Ok(0));
    assert!(run("```sh,slow\nfalse\n```\n", true).is_err());
    assert!(run("```sh,skip\ntrue\n```\n", true).is_err());
}
