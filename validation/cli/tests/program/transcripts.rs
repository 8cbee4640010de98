//! Commands and all that they print: `transcripts/*.md`. Each page has a folder of its own with `small.toml` and
//! `unequal.toml`, in which bash runs its blocks `console`. Below a command stand its standard output, its standard
//! error behind `! `, and its exit code behind `? ` where it is not 0. `[..]` stands for what differs between machines.
//! With `SNAPSHOTS=overwrite` the pages are written as the program prints now.

use crate::common::bounded::{Bounded, bash};
use crate::common::{UNEQUAL, folder};
use rayon::prelude::*;
use snapbox::Data;
use snapbox::assert::Action;
use snapbox::filter::NormalizeToExpected;
use std::fs;
use std::path::{Path, PathBuf};

/// What a command prints and how it ends, as lines of a page.
fn printed(command: &str, dir: &Path) -> String {
    let same = [("COLUMNS", "100"), ("RAYON_NUM_THREADS", "2"), ("LC_ALL", "C.UTF-8")];
    let ended = bash(dir, command).envs(same).ended();
    let [stdout, stderr] = [&ended.stdout, &ended.stderr].map(|bytes| String::from_utf8_lossy(bytes));
    let stdout = stdout.lines().map(|line| format!("{line}\n"));
    let stderr = stderr.lines().map(|line| format!("! {line}\n"));
    let code = ended.status.code().filter(|code| *code != 0).map(|code| format!("? {code}\n"));
    stdout.chain(stderr).chain(code).collect()
}

/// The page with what its commands print now.
fn replayed(page: &str) -> String {
    let dir = folder();
    dir.write("unequal.toml", UNEQUAL.as_str());
    let (mut now, mut inside) = (String::new(), false);
    for line in page.lines() {
        let command = line.strip_prefix("$ ").filter(|_| inside);
        inside = line == "```console" || inside && line != "```";
        if !inside || command.is_some() || line == "```console" {
            now += &format!("{line}\n");
        }
        now.extend(command.map(|command| printed(command, dir.path())));
    }
    now
}

/// The commands that print something else than their page, with both.
fn differences(page: &str, now: &str) -> String {
    let commands = page.split("\n$ ").zip(now.split("\n$ ")).filter(|(shown, printed)| shown != printed);
    commands.map(|(shown, printed)| format!("shown:\n$ {shown}\nprinted:\n$ {printed}\n")).collect()
}

fn normalized(now: String, page: &str) -> String {
    NormalizeToExpected::new().redact().normalize(Data::text(now), &Data::text(page)).to_string()
}

#[test]
fn commands_print_what_their_pages_show() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/transcripts");
    let paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    let wrong = paths.par_iter().map(|path| {
        let page = fs::read_to_string(path).unwrap();
        let now = normalized(replayed(&page), &page);
        if now != page && Action::with_env_var("SNAPSHOTS") == Some(Action::Overwrite) {
            fs::write(path, &now).unwrap();
            return String::new();
        }
        differences(&page, &now)
    });
    let wrong: String = wrong.collect();
    assert!(wrong.is_empty(), "with SNAPSHOTS=overwrite pages are as the program prints, to be read:\n{wrong}");
    assert!(paths.len() > 9);
}

#[test]
fn another_text_stream_or_exit_code_is_seen() {
    let seen = |page: &str| {
        let page = format!("Prose.\n\n```console\n{page}\n```\n");
        !differences(&page, &normalized(replayed(&page), &page)).is_empty()
    };
    for right in [
        "$ echo a; echo b >&2; exit 3\na\n! b\n? 3",
        "$ true",
        "$ echo 1.5 s\n[..] s",
        "$ ls\nsmall.toml\nunequal.toml",
    ] {
        assert!(!seen(right), "{right}");
    }
    for wrong in
        ["$ echo a", "$ echo a\nab", "$ true\na", "$ echo a >&2\na", "$ echo a\n! a", "$ false", "$ false\n? 2"]
    {
        assert!(seen(wrong), "{wrong}");
    }
}
