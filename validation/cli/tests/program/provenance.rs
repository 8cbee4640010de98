//! Which build made a result.

use crate::common::bounded::Bounded;
use crate::common::{FREE, empty_folder, folder, shearbed};
use serde_json::Value;
use std::fs;
use std::path::Path;
use std::process::Command;

/// What git prints in a folder, or nothing.
fn git(dir: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").arg("-C").arg(dir).args(arguments).ended();
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

#[test]
fn every_record_names_the_commit_of_the_build() {
    let dir = folder();
    // Not that of the folder where the program is started.
    for arguments in [
        &["init", "-q"][..],
        &["-c", "user.name=a", "-c", "user.email=a", "commit", "-q", "--allow-empty", "-m", "other"],
    ] {
        git(dir.path(), arguments);
    }
    dir.write("free.toml", FREE);
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let of_project = git(here, &["ls-files", "Cargo.toml"]).is_some_and(|found| !found.is_empty());
    let commit = git(here, &["rev-parse", "--short=12", "HEAD"]).filter(|_| of_project);
    let commit = commit.unwrap_or_else(|| "unknown".to_owned());
    for (arguments, record, within) in [
        ("run small.toml --out a", "a/run.json", ""),
        ("sweep small.toml --over interaction.alpha=1,2 --out b", "b/sweep.json", ""),
        ("converge extension --out c", "c/converge.json", ""),
        ("converge free.toml --out c", "c/converge.json", ""),
        ("converge small.toml --replicas 2 --out d", "d/converge.json", ""),
        ("validate --case jeffery-period --out e", "e/report.json", "/origin"),
    ] {
        let run = shearbed(dir.path(), arguments);
        let Ok(text) = fs::read_to_string(dir.path().join(record)) else {
            assert_eq!(run.code, Some(2), "{arguments}: {}", run.stderr);
            continue;
        };
        let record: Value = serde_json::from_str(&text).unwrap();
        let record = record.pointer(within).unwrap();
        let found = record["commit"].as_str().unwrap();
        assert_eq!(found.trim_end_matches("-dirty"), commit, "{arguments}");
        assert_eq!(record["version"], env!("CARGO_PKG_VERSION"));
        assert!(record["rustc"].as_str().unwrap().starts_with("rustc "), "{arguments}");
        assert!(["release", "development"].contains(&record["build"].as_str().unwrap()));
    }
}

/// The build script by itself, in folders of its own.
#[test]
fn the_build_script_knows_its_own_checkout_alone() {
    let dir = empty_folder();
    let script = dir.at("script");
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("../build.rs");
    let rustc = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let built = Command::new(rustc).args(["--edition", "2024", "-o"]).arg(&script).arg(source).ended();
    assert!(built.status.success());
    let commit = |root: &Path| {
        let output = Command::new(&script)
            .env("CARGO_MANIFEST_DIR", root.join("validation"))
            // As in a hook of git.
            .env("GIT_DIR", env!("CARGO_MANIFEST_DIR"))
            .ended();
        let text = String::from_utf8(output.stdout).unwrap();
        let line = text.lines().find_map(|line| line.strip_prefix("cargo::rustc-env=SHEARBED_COMMIT="));
        line.unwrap().to_owned()
    };
    let project = |root: &Path| {
        fs::create_dir_all(root.join("validation/src")).unwrap();
        fs::create_dir_all(root.join("src")).unwrap();
        fs::write(root.join("validation/build.rs"), "").unwrap();
        fs::write(root.join("src/lib.rs"), "").unwrap();
    };
    let committed = |root: &Path| {
        let author = ["-c", "user.name=a", "-c", "user.email=a"];
        git(root, &["init", "-q"]);
        git(root, &["add", "."]);
        git(root, &[&author[..], &["commit", "-q", "-m", "all"]].concat());
        git(root, &["rev-parse", "--short=12", "HEAD"]).unwrap()
    };

    let package = dir.at("package");
    project(&package);
    assert_eq!(commit(&package), "unknown");

    let own = dir.at("own");
    project(&own);
    let hash = committed(&own);
    assert_eq!(commit(&own), hash);
    fs::write(own.join("notes.txt"), "no source").unwrap();
    assert_eq!(commit(&own), hash);
    fs::write(own.join("src/new.rs"), "").unwrap();
    assert_eq!(commit(&own), format!("{hash}-dirty"));
    fs::remove_file(own.join("src/new.rs")).unwrap();
    fs::write(own.join("src/lib.rs"), "changed").unwrap();
    assert_eq!(commit(&own), format!("{hash}-dirty"));

    // Inside somebody else's repository, tracked or not.
    let other = dir.at("other");
    project(&other.join("vendor/shearbed"));
    committed(&other);
    assert_eq!(commit(&other.join("vendor/shearbed")), "unknown");
    project(&other.join("untracked"));
    assert_eq!(commit(&other.join("untracked")), "unknown");
}
