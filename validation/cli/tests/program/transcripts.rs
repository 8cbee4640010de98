//! Commands and all that they print: `transcripts/*.md`. Each page has a folder of its own with `small.toml` and
//! `unequal.toml`, in which bash runs its blocks `console`, with the functions of `functions.sh` and this repository at
//! `$ROOT`. A command begins behind `$ ` and goes on behind `> `. Below it stand its standard output, its standard
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

fn pages() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/program/transcripts")
}

/// What a command prints and how it ends, as lines of a page.
fn printed(command: &str, dir: &Path) -> String {
    let same = [("COLUMNS", "100"), ("RAYON_NUM_THREADS", "2"), ("LC_ALL", "C.UTF-8")];
    let places = [("BASH_ENV", pages().join("functions.sh")), ("ROOT", pages().join("../../../../.."))];
    let ended = bash(dir, command).envs(same).envs(places).ended();
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
    let mut lines = page.lines().peekable();
    while let Some(line) = lines.next() {
        let first = line.strip_prefix("$ ").filter(|_| inside);
        inside = line == "```console" || inside && line != "```";
        if !inside || first.is_some() || line == "```console" {
            now += &format!("{line}\n");
        }
        let Some(first) = first else { continue };
        let mut command = first.to_owned();
        while let Some(line) = lines.next_if(|line| line.starts_with("> ")) {
            now += &format!("{line}\n");
            command += &format!("\n{}", &line[2..]);
        }
        now += &printed(&command, dir.path());
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
    let mut paths: Vec<PathBuf> = fs::read_dir(pages()).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "md"));
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
        "$ cat <<END\n> a\n> END\na",
    ] {
        assert!(!seen(right), "{right}");
    }
    for wrong in
        ["$ echo a", "$ echo a\nab", "$ true\na", "$ echo a >&2\na", "$ echo a\n! a", "$ false", "$ false\n? 2"]
    {
        assert!(seen(wrong), "{wrong}");
    }
}
