//! The quick starts of `docs/grading.md`.

use crate::programs::{runs, skipped};
use std::fs;
use std::path::Path;
use std::process::Command;

/// The blocks of `docs/grading.md` in a language.
fn blocks(language: &str) -> Vec<String> {
    let page = fs::read_to_string(Path::new(env!("CARGO_MANIFEST_DIR")).join("../docs/grading.md")).unwrap();
    let parts = page.split("```").skip(1).step_by(2);
    parts.filter_map(|block| block.strip_prefix(&format!("{language}\n"))).map(str::to_owned).collect()
}

#[test]
fn the_quick_start_runs_as_it_is_written() {
    let dir = tempfile::tempdir().unwrap();
    fs::write(dir.path().join("my_code.py"), &blocks("python")[0]).unwrap();
    fs::write(dir.path().join("my_code.cpp"), &blocks("cpp")[0]).unwrap();
    let own = Path::new(env!("CARGO_BIN_EXE_shearbed")).parent().unwrap();
    let path = format!("{}:{}", own.display(), std::env::var("PATH").unwrap());
    let commands = blocks("sh");
    assert_eq!(commands.len(), 3);
    for (needs, commands) in ["python3", "c++", "awk"].into_iter().zip(commands) {
        // awk has no --version everywhere.
        let there = if needs == "awk" { runs("awk", &["BEGIN {}"]) } else { runs(needs, &["--version"]) };
        if !there {
            skipped("quick start", &format!("no {needs}"));
            continue;
        }
        let mut shell = Command::new("sh");
        let output =
            shell.args(["-ec", &commands]).env("PATH", &path).current_dir(dir.path()).output().unwrap();
        let words =
            String::from_utf8_lossy(&output.stdout).into_owned() + &String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && words.contains("PASS"), "{needs}: {words}");
    }
}
