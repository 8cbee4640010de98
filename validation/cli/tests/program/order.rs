//! The parts of the core and of the suite need each other one way, in the order of `lib.rs`.

use std::fs;
use std::path::{Path, PathBuf};

/// Modules in the order of their declarations.
fn declared(lib: &str) -> Vec<&str> {
    lib.lines().filter_map(|line| line.strip_prefix("pub mod ")?.strip_suffix(';')).collect()
}

/// Rust files below a folder; of a file, itself.
pub fn all_sources(place: &Path) -> Vec<PathBuf> {
    assert!(place.symlink_metadata().is_ok(), "{}", place.display());
    if place.is_dir() {
        return fs::read_dir(place).unwrap().flat_map(|entry| all_sources(&entry.unwrap().path())).collect();
    }
    let is_rust = place.extension().is_some_and(|ending| ending == "rs");
    is_rust.then(|| place.to_owned()).into_iter().collect()
}

/// Those that are not of tests alone.
pub fn sources(folder: &Path) -> Vec<PathBuf> {
    let mut files = all_sources(folder);
    files.retain(|path| !path.strip_prefix(folder).unwrap().with_extension("").iter().any(|name| name == "tests"));
    files
}

/// The lines of a source out of its tests and comments.
fn code(source: &str) -> impl Iterator<Item = &str> {
    let code = source.split("#[cfg(test)]\nmod tests {").next().unwrap_or_default();
    code.lines().filter(|line| !line.trim_start().starts_with("//"))
}

/// The modules that a source names as `crate::module`.
fn named(source: &str) -> impl Iterator<Item = &str> {
    let word = |rest: &'_ str| rest.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(rest.len());
    code(source).flat_map(move |line| line.split("crate::").skip(1).map(move |rest| &rest[..word(rest)]))
}

/// What a source of a module names that is declared after it.
fn later<'a>(order: &[&str], module: &str, source: &'a str) -> Vec<&'a str> {
    let place = |name: &str| order.iter().position(|known| *known == name);
    let own = place(module).unwrap_or_else(|| panic!("{module} is not declared"));
    named(source).filter(|name| place(name).is_some_and(|place| place > own)).collect()
}

/// `f64::max` leaves out NaN: a difference that is NaN would count as none.
#[test]
fn no_largest_error_leaves_out_nan() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let named = ["validation", "tests"].map(|folder| all_sources(&root.join(folder)));
    for path in named.iter().flatten().filter(|path| !path.ends_with("order.rs")) {
        assert!(!fs::read_to_string(path).unwrap().contains("fold(0.0, f64::max)"), "{}", path.display());
    }
}

#[test]
fn no_wing_needs_one_that_is_declared_after_it() {
    for (folder, wings) in [("../src", 7), ("../../src", 7)] {
        let root = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
        let lib = fs::read_to_string(root.join("lib.rs")).unwrap();
        let order = declared(&lib);
        assert_eq!(order.len(), wings, "{order:?}");
        for wing in &order {
            let sources = sources(&root.join(wing));
            assert!(!sources.is_empty());
            for path in sources {
                let text = fs::read_to_string(&path).unwrap();
                assert_eq!(later(&order, wing, &text), [""; 0], "{}", path.display());
            }
        }
    }
    // One that needs a wing above it is found.
    let wrong = "use crate::files::text;\nuse crate::program::run;\n#[cfg(test)]\nmod tests {}";
    assert_eq!(later(&["files", "judge", "program"], "judge", wrong), ["program"]);
}

/// A process that hangs would keep every other test from its end.
#[test]
fn no_test_waits_for_a_process_without_a_bound() {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests");
    // The bound itself, a program that is graded, and one that is killed first.
    let exempt = ["common/bounded.rs", "common/running.rs", "grade_live/acting.rs", "program/order.rs"];
    for path in sources(&tests).into_iter().filter(|path| !exempt.iter().any(|end| path.ends_with(end))) {
        let text = fs::read_to_string(&path).unwrap();
        for call in [".output()", ".status()", ".wait()", ".wait_with_output()"] {
            let found = text.lines().position(|line| line.contains(call));
            assert_eq!(found, None, "{call} in {}: use `ended` or `end` of common/bounded.rs", path.display());
        }
    }
}

/// rustfmt leaves comments, texts and the arguments of macros as they are.
#[test]
fn no_line_of_a_source_is_longer_than_120_columns() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    let is_long = |line: &&str| line.chars().count() > 120;
    for folder in ["src", "tests", "validation"] {
        for path in all_sources(&root.join(folder)) {
            let text = fs::read_to_string(&path).unwrap();
            assert_eq!(text.lines().find(is_long), None, "{}", path.display());
        }
    }
    assert!(is_long(&"é".repeat(121).as_str()) && !is_long(&"é".repeat(120).as_str()));
}

/// The first line with a flag in a text, or with a crate of the command line.
fn of_the_command_line(source: &str) -> Option<&str> {
    let is_flag = |rest: &str| rest.starts_with(|c: char| c.is_ascii_lowercase());
    // The command that repeats a study is cargo's.
    let mut lines = code(source).filter(|line| !line.contains("cargo run --"));
    lines.find(|line| line.split("--").skip(1).any(is_flag) || line.contains("clap") || line.contains("indicatif"))
}

#[test]
fn only_the_command_line_knows_flags_and_terminals() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..");
    // Each is to be removed: its errors are not yet types of their own, or its text has a command to repeat.
    let not_yet = [
        "cases/catalogue.rs",
        "cases/experiments.rs",
        "checkpoint/mod.rs",
        "checkpoint/saved.rs",
        "cluster/alone.rs",
        "csv/lines.rs",
        "grade/lammps.rs",
        "grade/layout.rs",
        "grade/mod.rs",
        "ladder/climb.rs",
        "output/folder.rs",
        "output/record.rs",
        "output/stage.rs",
        "report/row.rs",
        "studies/speed.rs",
        "sweep/folder.rs",
    ];
    for folder in ["src", "validation/src", "validation/methods/src", "validation/oracle/src"] {
        for path in sources(&root.join(folder)) {
            let text = fs::read_to_string(&path).unwrap();
            let line = of_the_command_line(&text);
            let is_exempt = not_yet.iter().any(|end| path.ends_with(end));
            assert_eq!(line.is_some(), is_exempt, "{}: {line:?}", path.display());
        }
    }
    for wrong in ["Err(\"--over: too many\")", "#[derive(clap::ValueEnum)]", "use indicatif::ProgressBar;"] {
        assert_eq!(of_the_command_line(wrong), Some(wrong));
    }
    assert_eq!(of_the_command_line("// --over\nlet x = a - -b;\n#[cfg(test)]\nmod tests { \"--over\" }"), None);
}
