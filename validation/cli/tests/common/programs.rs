//! Programs in other languages, where a machine has them.

use crate::bounded::{Bounded, end};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

/// The folder of programs to be graded.
pub fn peers() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../peers")
}

/// A Python that can import a module: of `.ci/run`'s virtual environment, or the machine's.
pub fn python(module: &str) -> Option<String> {
    let own = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../target/peers-venv/bin/python");
    let candidates = [own.to_string_lossy().into_owned(), "python3".to_owned()];
    let can = |python: &String| runs(python, &["-c", &format!("import {module}")]);
    candidates.into_iter().find(can)
}

/// Whether a program can be run, and ends well.
pub fn runs(program: &str, arguments: &[&str]) -> bool {
    let quiet =
        Command::new(program).args(arguments).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null()).spawn();
    quiet.is_ok_and(|child| end(program, child).status.success())
}

/// For NumPy, whose threads spin while they wait.
pub const ONE_THREAD: [(&str, &str); 1] = [("OPENBLAS_NUM_THREADS", "1")];

/// Runs a program that must end well.
pub fn run(program: &str, arguments: &[&Path]) {
    let output = Command::new(program).args(arguments).envs(ONE_THREAD).ended();
    assert!(output.status.success(), "{program} {arguments:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// Says in one line what was not run, and why. Fails if that names a tool of `SHEARBED_TOOLS`, which CI sets to those
/// that it has.
pub fn skipped(name: &str, reason: &str) {
    let tools = std::env::var("SHEARBED_TOOLS").unwrap_or_default();
    let found = tools.split_whitespace().find(|tool| reason.split([' ', ',', ':']).any(|word| word == *tool));
    assert_eq!(found, None, "{name} was skipped, {reason}, which is here");
    // Not by println!, which is shown of a test that fails alone.
    let _ = writeln!(std::io::stderr(), "skipped: {name}, {reason}");
}
