//! The tests of the copy, and what each says of a mutant.

use crate::tree::Tree;
use rayon::prelude::*;
use std::collections::BTreeSet;
use std::error::Error;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::Instant;

/// Bytes of address space that a test may take, in KiB: a mutant must not take the machine's memory.
const MEMORY_KIB: u32 = 6 << 20;

/// One test of one executable.
pub struct Test {
    /// The executable's target and the test's name.
    pub name: String,
    test: String,
    executable: PathBuf,
    folder: PathBuf,
    /// How long it takes without a mutant, and which places it reaches.
    pub seconds: f64,
    reached: BTreeSet<usize>,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub enum Said {
    Passed,
    Failed,
    TooLong,
}

impl Test {
    pub fn reaches(&self, place: usize) -> bool {
        self.reached.contains(&place)
    }

    /// With a mutant, or with none and a file for the places that it reaches.
    pub fn run(&self, mutant: Result<usize, &Path>) -> Said {
        let most = 20.0 + 5.0 * self.seconds;
        let mut command = Command::new("bash");
        command
            .current_dir(&self.folder)
            .arg("-c")
            .arg(format!(
                "ulimit -v {MEMORY_KIB} -c 0; exec timeout --signal=KILL {most:.0} \"$0\" --exact \"$1\""
            ))
            .arg(&self.executable)
            .arg(&self.test)
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .env_remove("MUTANT")
            .env("INSTA_UPDATE", "no")
            .env("CARGO_MANIFEST_DIR", &self.folder);
        match mutant {
            Ok(id) => command.env("MUTANT", id.to_string()),
            Err(path) => command.env("MUTANTS_REACHED", path),
        };
        match command.status().ok().and_then(|status| status.code()) {
            Some(0) => Said::Passed,
            Some(124 | 137) | None => Said::TooLong,
            Some(_) => Said::Failed,
        }
    }
}

/// All tests of the workspace, or the cases of the gate, that pass without a mutant, with what each reaches: those of the package that
/// has the mutants, and the others, the quickest first.
pub fn tests(tree: &Tree, cases: bool) -> Result<Vec<Test>, Box<dyn Error>> {
    let all = ["test", "--no-run"];
    let gate = [
        "test",
        "--no-run",
        "--package",
        "shearbed-suite",
        "--test",
        "gate",
    ];
    let (messages, failed) = tree.cargo(if cases { &gate } else { &all })?;
    if let Some(why) = failed {
        return Err(why.into());
    }
    let mut tests = Vec::new();
    for message in &messages {
        let (Some(executable), Some(true)) = (
            message["executable"].as_str(),
            message["profile"]["test"].as_bool(),
        ) else {
            continue;
        };
        let manifest = Path::new(message["manifest_path"].as_str().ok_or("no manifest")?);
        let folder = manifest.parent().ok_or("a manifest in no folder")?;
        let target = message["target"]["name"].as_str().ok_or("no target")?;
        let listed = Command::new(executable)
            .current_dir(folder)
            .args(["--list", "--format", "terse"])
            .output()?;
        for test in String::from_utf8(listed.stdout)?
            .lines()
            .filter_map(|line| line.strip_suffix(": test"))
        {
            tests.push(Test {
                name: format!("{target} {test}"),
                test: test.to_string(),
                executable: executable.into(),
                folder: folder.into(),
                seconds: 60.0,
                reached: BTreeSet::new(),
            });
        }
    }
    tests.par_iter_mut().enumerate().for_each(|(k, test)| {
        let path = tree.root.join(format!("reached-{k}"));
        let start = Instant::now();
        if test.run(Err(&path)) == Said::Passed {
            test.seconds = start.elapsed().as_secs_f64();
            let reached = fs::read_to_string(&path).unwrap_or_default();
            test.reached = reached.lines().flat_map(str::parse).collect();
        } else {
            eprintln!("fails without a mutant, and is left out: {}", test.name);
        }
    });
    tests.retain(|test| !test.reached.is_empty());
    tests.sort_by(|a, b| a.seconds.total_cmp(&b.seconds));
    tests.sort_by_key(|test| !tree.is_package(&test.folder));
    Ok(tests)
}

/// Runs the tests that reach a place until one fails, and says which.
pub fn judge(tests: &[Test], id: usize, place: usize, seconds: f64) -> String {
    let start = Instant::now();
    let mut said = "not reached";
    for test in tests.iter().filter(|test| test.reaches(place)) {
        if start.elapsed().as_secs_f64() > seconds {
            return "unfinished".into();
        }
        match test.run(Ok(id)) {
            Said::Passed => said = "missed",
            Said::Failed => return format!("caught\t{}", test.name),
            Said::TooLong => return format!("too long\t{}", test.name),
        }
    }
    said.into()
}

/// Which of the tests that reach a place fail.
pub fn all(tests: &[Test], id: usize, place: usize) -> String {
    let reaching = tests.iter().filter(|test| test.reaches(place));
    let said: Vec<_> = reaching
        .map(|test| format!("{}={}", test.name, u8::from(test.run(Ok(id)) != Said::Passed)))
        .collect();
    said.join("\t")
}
